#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace hooke::app {

/// Shows a line on stderr with how far a long task is and when it will be over. It shows nothing unless
/// stderr is a terminal and the task takes more than a second.
class Progress {
 public:
  Progress(std::string label, std::uint64_t total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Clears the line.
  ~Progress();

  /// Shows that `done` of the total is done; callers may call it as often as they like.
  void show(std::uint64_t done);

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  std::uint64_t total_ = 0;
  bool terminal_ = false;
  bool shown_ = false;
  Clock::time_point start_;
  Clock::time_point next_;
};

}  // namespace hooke::app
