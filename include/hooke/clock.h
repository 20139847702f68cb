#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/world.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Time regulation: from the time a machine takes to steps of one fixed length, so that every machine makes
/// the same steps whatever its speed and its display. The caller reads a clock (std::chrono::steady_clock);
/// nothing here does.
///
///     Clock clock = Clock::create({.step_seconds = double(dt)}).value();
///     while (playing) {
///       const Clock::Due due = clock.advance(seconds_since_the_last_picture);
///       for (int i = 0; i < due.steps; ++i) {
///         before = copy_points(world.positions(rope));
///         world.step(dt);
///       }
///       draw(blend(before, world.positions(rope), due.blend));
///     }

namespace hooke {

struct ClockDesc {
  double step_seconds = 1.0 / 60;  ///< Length of a step [s]. [1e-6, 1]
  /// Most steps between two pictures. Counted in steps, not in time: who calls with the same times makes the
  /// same steps. [1, 1000000]
  int catch_up_steps = 4;
};

/// Turns elapsed time into steps that are due. Without a bound on them a machine that needs longer than a
/// step for a step would owe more with every picture and show ever fewer; here the time beyond the bound is
/// dropped and reported: the simulation then runs slower than the clock, and at its normal speed right after.
///
/// At any moment: elapsed = (step_count + dropped_step_count) step_seconds + remainder. Counts are whole and
/// the remainder is exact but for one rounding per call (2^-53 of the time added).
class Clock {
 public:
  /// What is due before the next picture.
  struct Due {
    int steps = 0;              ///< To make now; 0 if the display is faster than the steps.
    std::uint64_t dropped = 0;  ///< Steps that will never be made.
    double blend = 0;           ///< Where the picture lies between the last two states. [0, 1)
  };

  static Result<Clock> create(const ClockDesc& desc = {});

  /// Adds the time since the last call [s]. What is negative or not a number counts as zero, what is longer
  /// than 1e6 s, infinity included, as 1e6 s.
  Due advance(double elapsed_seconds);

  /// Forgets the remainder: after a pause, or when the simulation began anew.
  void reset();

  [[nodiscard]] const ClockDesc& desc() const { return desc_; }
  [[nodiscard]] std::uint64_t step_count() const { return step_count_; }             ///< All that were due.
  [[nodiscard]] std::uint64_t dropped_step_count() const { return dropped_count_; }  ///< See dropped_seconds.
  /// States between two pictures that no picture shows.
  [[nodiscard]] std::uint64_t skipped_frame_count() const { return skipped_count_; }
  /// Time that was not simulated because of the bound [s].
  [[nodiscard]] double dropped_seconds() const;
  /// Time that is not yet a whole step [s]. [0, step_seconds)
  [[nodiscard]] double remainder_seconds() const { return remainder_; }

 private:
  explicit Clock(const ClockDesc& desc) : desc_(desc) {}

  ClockDesc desc_;
  std::uint64_t step_count_ = 0;
  std::uint64_t dropped_count_ = 0;
  std::uint64_t skipped_count_ = 0;
  double remainder_ = 0;  ///< [s]
};

/// Between two states by `part`, which is held to [0, 1]: positions on a straight line, rotations at an even
/// rate the short way around. Exactly the states themselves at 0 and 1. For pictures, not inside the step.
[[nodiscard]] DVec3 blend(DVec3 before, DVec3 after, double part);
[[nodiscard]] Quat blend(Quat before, Quat after, double part);
[[nodiscard]] Pose blend(const Pose& before, const Pose& after, double part);
/// Points that are new in `after` stay where they are.
[[nodiscard]] std::vector<DVec3> blend(std::span<const DVec3> before, const PointView& after, double part);
[[nodiscard]] std::vector<DVec3> blend(std::span<const DVec3> before, std::span<const DVec3> after,
                                       double part);

/// A copy that outlives the step.
[[nodiscard]] std::vector<DVec3> copy_points(const PointView& points);

}  // namespace hooke
