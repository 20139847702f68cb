#include "process/child.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace hooke::process {

namespace {

/// The attributes give the new process a group of its own, and no signal that is blocked or ignored. `error`
/// is an errno, or 0.
struct Attributes {
  posix_spawnattr_t value;
  int error = 0;

  Attributes() : error(posix_spawnattr_init(&value)) {
    if (error != 0) return;
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    error = posix_spawnattr_setsigmask(&value, &none);
    if (error == 0) error = posix_spawnattr_setsigdefault(&value, &all);
    if (error == 0) error = posix_spawnattr_setpgroup(&value, 0);
    if (error == 0) {
      error = posix_spawnattr_setflags(
          &value, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
  }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
  ~Attributes() { posix_spawnattr_destroy(&value); }
};

/// The actions set up the descriptors of the new process. `error` is an errno, or 0.
struct Actions {
  posix_spawn_file_actions_t value;
  int error = 0;

  explicit Actions(const Streams& streams) : error(posix_spawn_file_actions_init(&value)) {
    const std::array<int, 3> given = {streams.input, streams.output, streams.error};
    for (int target = 0; target < 3 && error == 0; ++target) {
      const int source = given[static_cast<std::size_t>(target)];
      error = source < 0 ? posix_spawn_file_actions_addopen(&value, target, "/dev/null", O_RDWR, 0)
                         : posix_spawn_file_actions_adddup2(&value, source, target);
    }
    if (error == 0) error = posix_spawn_file_actions_addclosefrom_np(&value, 3);
  }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;
  ~Actions() { posix_spawn_file_actions_destroy(&value); }
};

/// Returns a copy above the three standard descriptors, so that none is overwritten while they are set up.
Descriptor copy_above_standard(int number) {
  return Descriptor(number < 0 ? -1 : ::fcntl(number, F_DUPFD_CLOEXEC, 3));
}

}  // namespace

std::optional<Pipe> make_pipe() {
  std::array<int, 2> ends = {-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

std::string find_beside(const std::string& name) {
  std::error_code error;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
  return !error && ::access(beside.c_str(), X_OK) == 0 ? beside.string() : std::string();
}

void Descriptor::close() {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

Result<Child> Child::start(std::vector<std::string> words, const Streams& streams) {
  if (words.empty()) return Error{ErrorCode::kUnsupported, "", "no program was named"};
  const Descriptor input = copy_above_standard(streams.input);
  const Descriptor output = copy_above_standard(streams.output);
  const Descriptor error_output = copy_above_standard(streams.error);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const Actions actions({input.number(), output.number(), error_output.number()});
  const Attributes attributes;
  pid_t id = 0;
  int error = actions.error != 0 ? actions.error : attributes.error;
  if (error == 0) {
    error = posix_spawnp(&id, arguments[0], &actions.value, &attributes.value, arguments.data(), environ);
  }
  if (error != 0) {
    return Error{ErrorCode::kUnsupported, words.front(), std::generic_category().message(error)};
  }
  return Child(id);
}

int Child::wait() {
  int status = 0;
  pid_t ended = -1;
  do {
    ended = id_ > 0 ? ::waitpid(id_, &status, 0) : 0;
  } while (ended < 0 && errno == EINTR);
  id_ = 0;
  return ended > 0 ? status : 0;
}

std::optional<int> Child::wait_until(TimePoint deadline) {
  while (id_ > 0) {
    int status = 0;
    const pid_t ended = ::waitpid(id_, &status, WNOHANG);
    if (ended == id_ || (ended < 0 && errno != EINTR)) {
      id_ = 0;
      return ended < 0 ? 0 : status;
    }
    if (std::chrono::steady_clock::now() >= deadline) return std::nullopt;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return 0;
}

void Child::kill() {
  if (id_ <= 0) return;
  ::kill(-id_, SIGKILL);
  ::kill(id_, SIGKILL);
  wait();
}

}  // namespace hooke::process
