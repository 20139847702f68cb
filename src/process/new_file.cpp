#include "process/new_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <pthread.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace hooke::process {

namespace {

namespace fs = std::filesystem;

constexpr mode_t kUsualMode = 0666;  // The umask is subtracted.
constexpr int kMostTries = 100;      // Attempts to find a free preliminary name.

/// Slots hold copies of the names for remove_unfinished_files(), which a signal handler may read at any time.
constexpr std::size_t kSlotCount = 64;
constexpr std::size_t kLongestName = 4096;
std::array<std::array<char, kLongestName>, kSlotCount> slot_names;
enum class Slot : std::uint8_t { kFree, kTaken, kReady };
std::array<std::atomic<Slot>, kSlotCount> slots;

/// Returns the slot of the name, or -1 when there is no room. Only the NewFile itself then removes the file.
int remember(const std::string& name) {
  if (name.size() >= kLongestName) return -1;
  for (std::size_t i = 0; i < kSlotCount; ++i) {
    Slot expected = Slot::kFree;
    if (!slots[i].compare_exchange_strong(expected, Slot::kTaken)) continue;
    std::memcpy(slot_names[i].data(), name.c_str(), name.size() + 1);
    slots[i].store(Slot::kReady);
    return static_cast<int>(i);
  }
  return -1;
}

void forget(int& slot) {
  if (slot >= 0) slots[static_cast<std::size_t>(slot)].store(Slot::kFree);
  slot = -1;
}

Error failure(const std::string& path, const std::string& reason) {
  return {ErrorCode::kFileNotWritable, path, "cannot be written: " + reason};
}

Error failure(const std::string& path, int number) {
  return failure(path, std::generic_category().message(number));
}

std::string own_descriptor(int number) {
  return "/proc/self/fd/" + std::to_string(number);
}

/// Opens a file without a name in the folder of `path`. The descriptor is empty where the file system has no
/// such files, or where /proc is missing, by which they get a name later.
Descriptor open_unnamed(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  Descriptor file(::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kUsualMode));
  if (file.number() >= 0 && ::access(own_descriptor(file.number()).c_str(), F_OK) != 0) file.close();
  return file;
}

std::string preliminary_name(const std::string& path, int attempt) {
  return path + ".part" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
}

/// Opens a file under the first preliminary name that is free. If there is none, errno says why.
Descriptor open_named(const std::string& path, std::string& name) {
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    name = preliminary_name(path, attempt);
    const int number = ::open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kUsualMode);
    if (number >= 0 || errno != EEXIST) return Descriptor(number);
  }
  return Descriptor();
}

/// Blocks all signals that can be blocked in this thread, so that none of them can end the process between
/// naming and renaming.
class SignalPause {
 public:
  SignalPause() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  SignalPause(const SignalPause&) = delete;
  SignalPause& operator=(const SignalPause&) = delete;
  ~SignalPause() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_ = {};
};

void end_cleanly(int signal) {
  remove_unfinished_files();
  ::raise(signal);  // SA_RESETHAND has restored the default action, which now ends the process.
}

}  // namespace

Result<NewFile> NewFile::create(const std::string& path, Start start) {
  std::error_code code;
  const fs::path real = fs::is_symlink(path, code) ? fs::weakly_canonical(path, code) : fs::path(path);
  const fs::file_status status = fs::status(real, code);
  if (path.empty()) return failure(path, ENOENT);
  if (fs::is_directory(status)) return failure(path, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) return failure(path, "it is no regular file");
  std::string name;
  Descriptor file = start == Start::kUnnamed ? open_unnamed(real.string()) : Descriptor();
  if (file.number() < 0) file = open_named(real.string(), name);
  if (file.number() < 0) return failure(path, errno);
  if (fs::exists(status)) ::fchmod(file.number(), static_cast<mode_t>(status.permissions()) & 0777u);
  return NewFile(std::move(file), path, real.string(), std::move(name));
}

NewFile::NewFile(Descriptor file, std::string shown, std::string path, std::string name)
    : file_(std::move(file)),
      shown_(std::move(shown)),
      path_(std::move(path)),
      name_(std::move(name)),
      slot_(name_.empty() ? -1 : remember(name_)) {}

NewFile::NewFile(NewFile&& other) noexcept
    : file_(std::move(other.file_)),
      shown_(std::move(other.shown_)),
      path_(std::move(other.path_)),
      name_(std::exchange(other.name_, {})),
      slot_(std::exchange(other.slot_, -1)) {}

NewFile& NewFile::operator=(NewFile&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(shown_, other.shown_);
  std::swap(path_, other.path_);
  std::swap(name_, other.name_);
  std::swap(slot_, other.slot_);
  return *this;
}

NewFile::~NewFile() {
  if (!name_.empty()) ::unlink(name_.c_str());
  forget(slot_);
}

Result<void> NewFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(number(), bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return failure(shown_, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return {};
}

Result<void> NewFile::write(std::string_view text) {
  return write(std::as_bytes(std::span(text)));
}

Result<void> NewFile::take_name() {
  for (int attempt = 0; name_.empty() && attempt < kMostTries; ++attempt) {
    std::string name = preliminary_name(path_, attempt);
    const std::string own = own_descriptor(number());
    if (::linkat(AT_FDCWD, own.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      name_ = std::move(name);
    } else if (errno != EEXIST) {
      break;
    }
  }
  return name_.empty() ? Result<void>(failure(shown_, errno)) : Result<void>();
}

Result<void> NewFile::finish() {
  if (::fsync(number()) != 0) return failure(shown_, errno);
  const SignalPause pause;
  if (auto named = take_name(); !named) return named;
  if (std::rename(name_.c_str(), path_.c_str()) != 0) return failure(shown_, errno);
  name_.clear();
  forget(slot_);
  file_.close();
  return {};
}

Result<void> write_file(const std::string& path, std::span<const std::byte> bytes) {
  auto file = NewFile::create(path);
  if (!file) return file.error();
  if (auto written = file->write(bytes); !written) return written;
  return file->finish();
}

Result<void> write_file(const std::string& path, std::string_view text) {
  return write_file(path, std::as_bytes(std::span(text)));
}

void remove_unfinished_files() noexcept {
  for (std::size_t i = 0; i < kSlotCount; ++i) {
    if (slots[i].load() == Slot::kReady) ::unlink(slot_names[i].data());
  }
}

void remove_unfinished_files_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU, SIGXFSZ}) {
    struct sigaction now = {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;
    struct sigaction then = {};
    then.sa_handler = end_cleanly;
    then.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
    sigemptyset(&then.sa_mask);
    ::sigaction(signal, &then, nullptr);
  }
}

}  // namespace hooke::process
