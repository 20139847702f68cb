#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace hooke::app {

/// A line on stderr that says how far a long work is and when it will be over. Shows nothing unless stderr is
/// a terminal and the work takes more than a second.
class Progress {
 public:
  Progress(std::string label, std::uint64_t total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Wipes the line.
  ~Progress();

  /// `done` of the total; call it as often as you like.
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
