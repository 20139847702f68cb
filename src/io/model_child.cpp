#include "io/model_child.h"

#include "io/model_flat.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <poll.h>
#include <spawn.h>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>

namespace hooke::io {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxReason = 400;  // bytes of a refusal that are shown
constexpr std::string_view kProgram = "hooke-import";

/// Closes its file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_ = -1;
};

struct Pipe {
  Descriptor read;
  Descriptor write;
};

/// A pipe above the three standard descriptors, so that none is overwritten while they are set up.
std::optional<Pipe> make_pipe() {
  std::array<int, 2> ends = {-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  const Descriptor low_read(ends[0]);
  const Descriptor low_write(ends[1]);
  Pipe pipe = {Descriptor(::fcntl(ends[0], F_DUPFD_CLOEXEC, 3)),
               Descriptor(::fcntl(ends[1], F_DUPFD_CLOEXEC, 3))};
  if (pipe.read.number() < 0 || pipe.write.number() < 0) return std::nullopt;
  return pipe;
}

/// A running importer, in a process group of its own. Killed and collected when it goes out of scope.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (id_ <= 0) return;
    ::kill(-id_, SIGKILL);
    ::kill(id_, SIGKILL);
    while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  /// The wait status, once it has ended by itself before `deadline`. A program that ignores SIGCHLD learns no
  /// status: then the bytes alone must speak for themselves, as after a good end.
  std::optional<int> wait(Clock::time_point deadline) {
    for (;;) {
      int status = 0;
      const pid_t ended = ::waitpid(id_, &status, WNOHANG);
      if (ended == id_ || (ended < 0 && errno != EINTR)) {
        id_ = 0;
        return ended < 0 ? 0 : status;
      }
      if (Clock::now() >= deadline) return std::nullopt;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  pid_t id_;
};

std::string find_program() {
  if (const char* chosen = std::getenv("HOOKE_IMPORT"); chosen != nullptr && *chosen != '\0') return chosen;
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / kProgram;
  if (!error && ::access(beside.c_str(), X_OK) == 0) return beside.string();
#ifdef HOOKE_IMPORT_FOLDER
  const fs::path installed = fs::path(HOOKE_IMPORT_FOLDER) / kProgram;
  if (::access(installed.c_str(), X_OK) == 0) return installed.string();
#endif
  return {};
}

std::string number_text(double value) {
  std::array<char, 32> buffer = {};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::array<std::string, 5> arguments(const std::string& program, const std::string& path,
                                     const ImportOptions& options) {
  constexpr std::array<const char*, 4> up_words = {"format", "x", "y", "z"};
  return {program, path, up_words[static_cast<std::size_t>(options.up)], number_text(options.scale),
          options.fit ? number_text(*options.fit) : "none"};
}

/// Starts the importer with the two pipes as its output and error; 0 on success, else an errno.
int spawn(pid_t& id, std::array<std::string, 5>& words, const Pipe& output, const Pipe& reason) {
  posix_spawn_file_actions_t actions;
  if (const int error = posix_spawn_file_actions_init(&actions); error != 0) return error;
  posix_spawnattr_t attributes;
  if (const int error = posix_spawnattr_init(&attributes); error != 0) {
    posix_spawn_file_actions_destroy(&actions);
    return error;
  }
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  std::array<char*, 6> argv = {};
  std::transform(words.begin(), words.end(), argv.begin(), [](std::string& word) { return word.data(); });

  int error = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, output.write.number(), 1);
  if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, reason.write.number(), 2);
  if (error == 0) error = posix_spawn_file_actions_addclosefrom_np(&actions, 3);
  if (error == 0) error = posix_spawnattr_setsigmask(&attributes, &none);
  if (error == 0) error = posix_spawnattr_setsigdefault(&attributes, &all);
  if (error == 0) error = posix_spawnattr_setpgroup(&attributes, 0);
  if (error == 0) {
    error = posix_spawnattr_setflags(&attributes,
                                     POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  if (error == 0) error = posix_spawn(&id, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// One pipe's end and what came out of it.
struct Stream {
  Descriptor& end;
  std::vector<std::byte> bytes = {};
  std::size_t limit = 0;
  bool overflowed = false;
};

/// Appends what is there. Closes at the end of the stream, on an error and past the limit.
void drain(Stream& stream) {
  std::array<std::byte, std::size_t{1} << 16> buffer;
  const ssize_t size = ::read(stream.end.number(), buffer.data(), buffer.size());
  if (size < 0 && errno == EINTR) return;
  if (size <= 0) {
    stream.end.close();
    return;
  }
  const std::size_t taken = std::min(static_cast<std::size_t>(size), stream.limit - stream.bytes.size());
  stream.bytes.insert(stream.bytes.end(), buffer.begin(),
                      buffer.begin() + static_cast<std::ptrdiff_t>(taken));
  stream.overflowed = stream.overflowed || taken < static_cast<std::size_t>(size);
  if (stream.overflowed) stream.end.close();
}

/// Reads both streams to their ends. False when the deadline passed first.
bool drain_both(Stream& output, Stream& reason, Clock::time_point deadline) {
  while (output.end.number() >= 0 || reason.end.number() >= 0) {
    std::array<pollfd, 2> waiting = {{{output.end.number(), POLLIN, 0}, {reason.end.number(), POLLIN, 0}}};
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    const int ready = ::poll(waiting.data(), waiting.size(), static_cast<int>(left.count()));
    if (ready < 0 && errno != EINTR) return false;
    if (ready <= 0) continue;
    if (waiting[0].revents != 0) drain(output);
    if (waiting[1].revents != 0) drain(reason);
  }
  return true;
}

/// The last line that was written, made harmless.
std::string last_line(const std::vector<std::byte>& bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  if (const auto line = text.rfind('\n'); line != std::string_view::npos) text.remove_prefix(line + 1);
  return cleaned_text(text);
}

Error ending_error(const std::string& path, int status, const std::vector<std::byte>& reason) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    if (number == SIGXCPU || number == SIGKILL) {
      return {ErrorCode::kLimitExceeded, path, "reading it took too much time or memory"};
    }
    return {
        ErrorCode::kBadSyntax, path,
        "the importer crashed on it (signal " + std::to_string(number) + "): the file is broken or hostile"};
  }
  ErrorCode code = ErrorCode::kBadSyntax;
  switch (static_cast<ImporterExit>(WEXITSTATUS(status))) {
    case ImporterExit::kNotReadable:
      code = ErrorCode::kFileNotReadable;
      break;
    case ImporterExit::kOutOfRange:
      code = ErrorCode::kOutOfRange;
      break;
    case ImporterExit::kLimitExceeded:
      code = ErrorCode::kLimitExceeded;
      break;
    case ImporterExit::kUnsupported:
      code = ErrorCode::kUnsupported;
      break;
    case ImporterExit::kBadSyntax:
      break;
    default:
      return {code, path, "the importer failed on it (exit " + std::to_string(WEXITSTATUS(status)) + ")"};
  }
  const std::string text = last_line(reason);
  return {code, path, text.empty() ? "the importer refused it" : text};
}

}  // namespace

Result<std::vector<std::byte>> run_importer(const std::string& path, const ImportOptions& options,
                                            std::chrono::milliseconds wall_time) {
  const auto deadline = Clock::now() + wall_time;
  const std::string program = find_program();
  if (program.empty()) {
    return Error{ErrorCode::kUnsupported, path,
                 "the program hooke-import is missing: put it beside this one or name it in HOOKE_IMPORT"};
  }
  auto output = make_pipe();
  auto reason = make_pipe();
  if (!output || !reason) return Error{ErrorCode::kLimitExceeded, path, "no pipe for the importer"};
  std::array<std::string, 5> words = arguments(program, path, options);
  pid_t id = 0;
  if (const int error = spawn(id, words, *output, *reason); error != 0) {
    return Error{ErrorCode::kUnsupported, path,
                 "cannot start " + program + ": " + std::generic_category().message(error)};
  }
  Child child(id);
  output->write.close();
  reason->write.close();
  Stream model_stream = {.end = output->read, .limit = kMaxFlatModelSize};
  Stream reason_stream = {.end = reason->read, .limit = kMaxReason};
  const bool in_time = drain_both(model_stream, reason_stream, deadline);
  if (model_stream.overflowed) {
    return Error{ErrorCode::kLimitExceeded, path, "the importer gave more bytes than any model has"};
  }
  const std::optional<int> status = in_time ? child.wait(deadline) : std::nullopt;
  if (!status) return Error{ErrorCode::kLimitExceeded, path, "reading it took too long"};
  if (*status != 0) return ending_error(path, *status, reason_stream.bytes);
  return std::move(model_stream.bytes);
}

}  // namespace hooke::io
