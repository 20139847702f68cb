#include "sandbox.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <vector>

namespace hooke::importer {

namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

/// These calls are allowed with any arguments. None takes a name, makes a descriptor or reaches another
/// process.
constexpr std::array kCalls = {
    SYS_brk,        SYS_munmap,        SYS_mremap,       SYS_madvise,        SYS_exit,
    SYS_exit_group, SYS_rt_sigreturn,  SYS_rt_sigaction, SYS_rt_sigprocmask, SYS_sigaltstack,
    SYS_futex,      SYS_clock_gettime, SYS_gettimeofday, SYS_getrandom,      SYS_getpid,
    SYS_gettid,     SYS_sched_yield,
};

constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW;
constexpr std::uint32_t kRefuse = SECCOMP_RET_ERRNO | EPERM;
constexpr std::uint32_t kEnd = SECCOMP_RET_KILL_PROCESS;

/// Builds a program for the kernel's filter, which sees the number of a call and its arguments, in halves.
class Filter {
 public:
  Filter() {
    load(offsetof(seccomp_data, arch));
    unless(kArchitecture, kEnd);  // On another architecture the numbers mean other calls.
    load(offsetof(seccomp_data, nr));
  }

  void allow(long call) { when(call, {returning(kAllow)}); }

  /// Allows `call` to write to the two streams that the parent reads.
  void allow_output(long call) {
    when(call, {loading(low_half(0)), jump(BPF_JEQ, STDOUT_FILENO, 1, 0), jump(BPF_JEQ, STDERR_FILENO, 0, 1),
                returning(kAllow), returning(kRefuse)});
  }

  /// Allows memory that belongs to no file and is not executable. mmap has flags in its fourth argument,
  /// mprotect none.
  void allow_memory(long call, bool has_flags) {
    std::vector<sock_filter> body = {loading(low_half(2)), jump(BPF_JSET, PROT_EXEC, 0, 1),
                                     returning(kRefuse)};
    if (has_flags) {
      body.insert(body.end(),
                  {loading(low_half(3)), jump(BPF_JSET, MAP_ANONYMOUS, 1, 0), returning(kRefuse)});
    }
    body.push_back(returning(kAllow));
    when(call, body);
  }

  /// Allows signals to `process` alone.
  void allow_signal(long call, pid_t process) {
    when(call, {loading(low_half(0)), jump(BPF_JEQ, static_cast<std::uint32_t>(process), 0, 1),
                returning(kAllow), returning(kRefuse)});
  }

  [[nodiscard]] bool install() {
    program_.push_back(returning(kRefuse));
    sock_fprog whole = {.len = static_cast<unsigned short>(program_.size()), .filter = program_.data()};
    return ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &whole) == 0;
  }

 private:
  static sock_filter loading(std::size_t offset) {
    return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
  }
  static sock_filter returning(std::uint32_t verdict) { return BPF_STMT(BPF_RET | BPF_K, verdict); }
  static sock_filter jump(unsigned kind, std::uint32_t value, std::size_t then, std::size_t otherwise) {
    return BPF_JUMP(static_cast<std::uint16_t>(BPF_JMP | kind | BPF_K), value,
                    static_cast<std::uint8_t>(then), static_cast<std::uint8_t>(otherwise));
  }
  /// Returns the offset of the low half of a 64-bit argument; both processors are little-endian.
  static std::size_t low_half(std::size_t argument) {
    return offsetof(seccomp_data, args) + argument * sizeof(std::uint64_t);
  }

  void load(std::size_t offset) { program_.push_back(loading(offset)); }
  void unless(std::uint32_t value, std::uint32_t verdict) {
    program_.push_back(jump(BPF_JEQ, value, 1, 0));
    program_.push_back(returning(verdict));
  }
  /// Runs `body`, which must return, for this call; the number stays loaded for later ones.
  void when(long call, const std::vector<sock_filter>& body) {
    program_.push_back(jump(BPF_JEQ, static_cast<std::uint32_t>(call), 0, body.size()));
    program_.insert(program_.end(), body.begin(), body.end());
  }

  std::vector<sock_filter> program_;
};

}  // namespace

Seal seal_process() {
  if (kArchitecture == 0) return Seal::kUnavailable;
  Filter filter;
  for (const long call : kCalls) filter.allow(call);
  filter.allow_output(SYS_write);
  filter.allow_output(SYS_writev);
  filter.allow_memory(SYS_mmap, true);
  filter.allow_memory(SYS_mprotect, false);
  filter.allow_signal(SYS_tgkill, ::getpid());  // abort() ends the process by this call.
  return filter.install() ? Seal::kDone : Seal::kUnavailable;
}

}  // namespace hooke::importer
