#pragma once

#include "hooke/result.h"

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

/// \file
/// Other programs, started and ended cleanly: the importer of models, ffmpeg, gnuplot.

namespace hooke::process {

/// A file descriptor that is closed with this value.
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

  void close();
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_ = -1;
};

struct Pipe {
  Descriptor read;
  Descriptor write;
};

/// Closed in programs that are started. Nothing when the system has none left.
std::optional<Pipe> make_pipe();

/// The path of the program `name` in the folder of the running one; empty if there is none.
std::string find_beside(const std::string& name);

/// What a program gets as its three standard streams; -1 is /dev/null.
struct Streams {
  int input = -1;
  int output = -1;
  int error = -1;
};

/// A running program, in a process group of its own and with nothing open but its standard streams. Killed
/// and collected, with what it started, when it goes out of scope.
class Child {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// The first word is a path, or a name that is looked for in PATH. kUnsupported when it cannot be started:
  /// `where` is the first word, the message the system's reason.
  static Result<Child> start(std::vector<std::string> words, const Streams& streams);

  Child() = default;
  Child(Child&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Child& operator=(Child&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() { kill(); }

  /// The status that waitpid gives, once the program has ended by itself. A caller that ignores SIGCHLD
  /// learns no status and gets 0: then what the program wrote must speak for itself.
  int wait();
  /// The same; nothing if the program still runs at `deadline`.
  std::optional<int> wait_until(TimePoint deadline);
  /// The system's number of the process; 0 when there is none, or no more.
  [[nodiscard]] pid_t number() const { return id_; }
  /// Ends it, if it runs.
  void kill();

 private:
  explicit Child(pid_t id) : id_(id) {}

  pid_t id_ = 0;  ///< 0 when there is none, or no more.
};

}  // namespace hooke::process
