#include "io/model/model_child.h"

#include "io/model/model_flat.h"
#include "process/child.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <poll.h>
#include <sstream>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace hooke::io {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using process::Descriptor;

constexpr std::size_t kMaxReason = 400;  // Bytes of a refusal that are shown.
constexpr const char* kProgram = "hooke-import";

/// Folder set by set_importer_folder; null before.
std::atomic<const char*> importer_folder = nullptr;

/// Returns the importer in a folder; empty if it is not there, or if the folder is empty.
std::string find_in(const std::string& folder) {
  const std::string path = (fs::path(folder) / kProgram).string();
  return !folder.empty() && ::access(path.c_str(), X_OK) == 0 ? path : std::string();
}

std::string find_in_path() {
  const char* folders = std::getenv("PATH");
  std::istringstream list(folders != nullptr ? folders : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    if (std::string found = find_in(folder); !found.empty()) return found;
  }
  return {};
}

std::string find_program() {
  if (const char* chosen = std::getenv("HOOKE_IMPORT"); chosen != nullptr && *chosen != '\0') return chosen;
  if (std::string beside = process::find_beside(kProgram); !beside.empty()) return beside;
  if (const char* folder = importer_folder.load(); folder != nullptr) {
    if (std::string found = find_in(folder); !found.empty()) return found;
  }
#ifdef HOOKE_CONFIGURED_IMPORTER_FOLDER
  if (std::string found = find_in(HOOKE_CONFIGURED_IMPORTER_FOLDER); !found.empty()) return found;
#endif
  return find_in_path();
}

std::string number_text(double value) {
  std::array<char, 32> buffer = {};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::vector<std::string> arguments(const std::string& program, const std::string& path,
                                   const ImportOptions& options) {
  constexpr std::array<const char*, 4> kUpWords = {"format", "x", "y", "z"};
  constexpr std::array<const char*, 3> kOriginWords = {"file", "center", "bottom"};
  return {program,
          path,
          kUpWords[static_cast<std::size_t>(options.up)],
          number_text(options.scale),
          options.fit ? number_text(*options.fit) : "none",
          kOriginWords[static_cast<std::size_t>(options.origin)]};
}

/// A Stream is one pipe's end and the bytes that came out of it.
struct Stream {
  Descriptor& end;
  std::vector<std::byte> bytes = {};
  std::size_t limit = 0;
  bool overflowed = false;
};

/// Appends what is available. Closes the pipe at the end of the stream, on an error and past the limit.
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

/// Reads both streams to their ends; returns false when the deadline passed first.
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

/// Returns the last line that was written, made printable.
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
                 "the program hooke-import is missing: put it beside this one or into PATH, or name it in "
                 "HOOKE_IMPORT"};
  }
  auto output = process::make_pipe();
  auto reason = process::make_pipe();
  if (!output || !reason) return Error{ErrorCode::kUnsupported, path, "no pipe for the importer"};
  auto child = process::Child::start(arguments(program, path, options),
                                     {.output = output->write.number(), .error = reason->write.number()});
  if (!child) {
    return Error{ErrorCode::kUnsupported, path, "cannot start " + program + ": " + child.error().message};
  }
  output->write.close();
  reason->write.close();
  Stream model_stream = {.end = output->read, .limit = kMaxFlatModelSize};
  Stream reason_stream = {.end = reason->read, .limit = kMaxReason};
  const bool in_time = drain_both(model_stream, reason_stream, deadline);
  if (model_stream.overflowed) {
    return Error{ErrorCode::kLimitExceeded, path, "the importer gave more bytes than any model has"};
  }
  const std::optional<int> status = in_time ? child.value().wait_until(deadline) : std::nullopt;
  if (!status) return Error{ErrorCode::kLimitExceeded, path, "reading it took too long"};
  if (*status != 0) return ending_error(path, *status, reason_stream.bytes);
  return std::move(model_stream.bytes);
}

}  // namespace hooke::io

namespace hooke {

bool set_importer_folder(const char* folder) noexcept {
  const char* none = nullptr;
  io::importer_folder.compare_exchange_strong(none, folder);
  return true;
}

}  // namespace hooke
