#pragma once

#include "hooke/result.h"

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

/// \file
/// Starts and ends other programs: the importer of models, ffmpeg, gnuplot.

namespace hooke::process {

/// A Descriptor owns a file descriptor and closes it on destruction.
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

/// Returns a pipe whose ends are closed in programs that are started, or nothing when the system has none
/// left.
std::optional<Pipe> make_pipe();

/// Returns the path of the program `name` in the folder of the running program, or an empty string if there
/// is none.
std::string find_beside(const std::string& name);

/// These are the three standard streams of a program; -1 stands for /dev/null.
struct Streams {
  int input = -1;
  int output = -1;
  int error = -1;
};

/// A Child is a running program in a process group of its own; only its standard streams are open. The
/// destructor kills the whole group and collects the program.
class Child {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Starts a program. The first word is a path, or a name that is looked up in PATH. If it cannot be
  /// started, the Error is kUnsupported, with the first word as `where` and the system's reason as message.
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

  /// Waits until the program has ended by itself and returns the status that waitpid gives. If the host
  /// ignores SIGCHLD there is no status, and the result is 0; the caller must then judge by what the program
  /// wrote.
  int wait();
  /// Waits as wait() does, but returns nothing if the program still runs at `deadline`.
  std::optional<int> wait_until(TimePoint deadline);
  /// Returns the process id, or 0 when nothing runs.
  [[nodiscard]] pid_t number() const { return id_; }
  /// Kills the program and its process group, if it runs, and waits for its end.
  void kill();

 private:
  explicit Child(pid_t id) : id_(id) {}

  pid_t id_ = 0;  ///< 0 when nothing runs.
};

}  // namespace hooke::process
