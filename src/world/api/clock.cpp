#include "hooke/clock.h"

#include "base/float_environment.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace hooke {

namespace {

constexpr double kShortestStep = 1e-6;   // [s]
constexpr double kLongestStep = 1;       // [s]
constexpr double kLongestElapsed = 1e6;  // [s]; a double holds the number of steps in it exactly.
constexpr int kMostCatchUpSteps = 1'000'000;
// Below this angle between two quaternions [rad], a straight line between them is even to 1e-7, and dividing
// by the sine of the angle would lose digits.
constexpr double kSmallAngle = 1e-3;

/// Clamps a part to [0, 1]; a NaN becomes 0.
double unit_part(double part) {
  return part > 0 ? std::min(part, 1.0) : 0.0;
}

}  // namespace

Result<Clock> Clock::create(const ClockDesc& desc) {
  if (!(desc.step_seconds >= kShortestStep && desc.step_seconds <= kLongestStep)) {
    return Error{ErrorCode::kOutOfRange, "clock.step_seconds",
                 std::to_string(desc.step_seconds) + " is out of range, must be 1e-6 to 1"};
  }
  if (desc.catch_up_steps < 1 || desc.catch_up_steps > kMostCatchUpSteps) {
    return Error{ErrorCode::kOutOfRange, "clock.catch_up_steps",
                 std::to_string(desc.catch_up_steps) + " is out of range, must be 1 to 1000000"};
  }
  return Clock(desc);
}

Clock::Due Clock::advance(double elapsed_seconds) {
  const base::FloatEnvironment environment;
  const double owed = remainder_ + (elapsed_seconds > 0 ? std::min(elapsed_seconds, kLongestElapsed) : 0.0);
  // std::fmod is exact, so nothing but the rounding of the sum above adds up.
  remainder_ = std::fmod(owed, desc_.step_seconds);
  const auto due = static_cast<std::uint64_t>(std::llround((owed - remainder_) / desc_.step_seconds));
  const std::uint64_t steps = std::min(due, static_cast<std::uint64_t>(desc_.catch_up_steps));
  step_count_ += steps;
  dropped_count_ += due - steps;
  skipped_count_ += steps > 1 ? steps - 1 : 0;
  return {static_cast<int>(steps), due - steps, remainder_ / desc_.step_seconds};
}

void Clock::reset() {
  remainder_ = 0;
}

double Clock::dropped_seconds() const {
  return static_cast<double>(dropped_count_) * desc_.step_seconds;
}

DVec3 blend(DVec3 before, DVec3 after, double part) {
  const base::FloatEnvironment environment;
  const double t = unit_part(part);
  return (1 - t) * before + t * after;
}

Quat blend(Quat before, Quat after, double part) {
  const base::FloatEnvironment environment;
  const double t = unit_part(part);
  const double product = static_cast<double>(before.x) * after.x + static_cast<double>(before.y) * after.y +
                         static_cast<double>(before.z) * after.z + static_cast<double>(before.w) * after.w;
  // A rotation has two quaternions. The one on the side of `before` gives the short way around.
  const double angle = std::acos(std::min(std::abs(product), 1.0));
  const bool small = !(angle > kSmallAngle);
  const double a = small ? 1 - t : std::sin((1 - t) * angle) / std::sin(angle);
  const double b = (product < 0 ? -1 : 1) * (small ? t : std::sin(t * angle) / std::sin(angle));
  const auto mix = [&](Real p, Real q) {
    return static_cast<Real>(a * static_cast<double>(p) + b * static_cast<double>(q));
  };
  return normalize(
      Quat{mix(before.x, after.x), mix(before.y, after.y), mix(before.z, after.z), mix(before.w, after.w)});
}

Pose blend(const Pose& before, const Pose& after, double part) {
  return {blend(before.position, after.position, part), blend(before.rotation, after.rotation, part)};
}

std::vector<DVec3> blend(std::span<const DVec3> before, std::span<const DVec3> after, double part) {
  const base::FloatEnvironment environment;
  std::vector<DVec3> points(after.begin(), after.end());
  const std::size_t common = std::min(before.size(), after.size());
  for (std::size_t i = 0; i < common; ++i) points[i] = blend(before[i], after[i], part);
  return points;
}

std::vector<DVec3> blend(std::span<const DVec3> before, const PointView& after, double part) {
  return blend(before, copy_points(after), part);
}

std::vector<DVec3> copy_points(const PointView& points) {
  std::vector<DVec3> copy(points.size());
  for (std::size_t i = 0; i < copy.size(); ++i) copy[i] = points[i];
  return copy;
}

}  // namespace hooke
