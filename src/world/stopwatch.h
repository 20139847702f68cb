#pragma once

#include <chrono>

namespace hooke::world {

/// Measures the times of the parts of a step for its report. They never influence the physics.
class Stopwatch {
 public:
  /// Returns the milliseconds since the last call, or since construction.
  double lap_ms() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace hooke::world
