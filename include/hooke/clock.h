#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/world.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Time regulation: turns the time that passes into steps of one fixed length, so that every machine makes
/// the same steps, whatever its speed and its display. The caller reads a clock (std::chrono::steady_clock);
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

/// Describes a Clock.
struct ClockDesc {
  double step_seconds = 1.0 / 60;  ///< Length of a step [s]. [1e-6, 1]
  /// Largest number of steps between two pictures. [1, 1000000] It is a number of steps and not a time, so
  /// that two callers who pass the same times make the same steps.
  int catch_up_steps = 4;
};

/// Turns elapsed time into steps that are due. Their number has a bound: otherwise a machine that computes a
/// step more slowly than it lasts would owe more steps with every picture, and show ever fewer pictures. The
/// clock drops and reports the time beyond the bound. The simulation then runs slower than the clock, and at
/// its normal speed right after.
///
/// At any moment: elapsed = (step_count + dropped_step_count) step_seconds + remainder. Counts are whole and
/// the remainder is exact but for one rounding per call (2^-53 of the time added).
class Clock {
 public:
  /// What is due before the next picture.
  struct Due {
    int steps = 0;              ///< Steps to make now; 0 if the display is faster than the steps.
    std::uint64_t dropped = 0;  ///< Steps that will never be made.
    double blend = 0;           ///< Where the picture lies between the last two states. [0, 1)
  };

  /// Makes a clock without remainder. Errors: a field of `desc` out of range.
  static Result<Clock> create(const ClockDesc& desc = {});

  /// Adds the time since the last call [s]. A negative time or NaN counts as zero, and more than 1e6 s,
  /// infinity included, as 1e6 s.
  Due advance(double elapsed_seconds);

  /// Forgets the remainder, but keeps the counts: after a pause, or when the simulation began anew.
  void reset();

  /// The description that the clock was made from.
  [[nodiscard]] const ClockDesc& desc() const { return desc_; }
  /// Number of steps that advance() asked for, without those it dropped.
  [[nodiscard]] std::uint64_t step_count() const { return step_count_; }
  /// Number of steps that were dropped because of the bound.
  [[nodiscard]] std::uint64_t dropped_step_count() const { return dropped_count_; }
  /// Number of steps whose result no picture shows, because several were due at once.
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

///@{
/// A state between two states: `part` 0 is `before`, 1 is `after`, and what is beyond counts as 0 or 1.
/// Positions move on a straight line, and rotations at an even rate the short way around (Shoemake 1985,
/// Animating rotation with quaternion curves). It serves pictures, not the step.
[[nodiscard]] DVec3 blend(DVec3 before, DVec3 after, double part);
[[nodiscard]] Quat blend(Quat before, Quat after, double part);
[[nodiscard]] Pose blend(const Pose& before, const Pose& after, double part);
///@}
///@{
/// Blends point by point, as many as `after` has. A point that only `after` has stays where it is.
[[nodiscard]] std::vector<DVec3> blend(std::span<const DVec3> before, const PointView& after, double part);
[[nodiscard]] std::vector<DVec3> blend(std::span<const DVec3> before, std::span<const DVec3> after,
                                       double part);
///@}

/// Copies the points of a view, in the world [m], so that they outlive the step.
[[nodiscard]] std::vector<DVec3> copy_points(const PointView& points);

}  // namespace hooke
