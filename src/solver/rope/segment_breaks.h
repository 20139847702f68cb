#pragma once

#include "solver/rope/rope_rows.h"
#include "state/springs.h"

#include <cstdint>
#include <vector>

/// \file
/// Segments of ropes that break: docs/decisions/0043-ropes-and-cloth-that-break.md. As with hooks
/// (solver/joint/hook_breaks.h), a segment that needs more than it can take becomes a dashpot for the rest of
/// that substep, and all is solved again. It gives way completely first, which shows the speed s0 at which
/// its ends part. A dashpot of F h / s0 then takes p and leaves s. As the speed falls by what the dashpot
/// takes, about (s0 - s) / p for each unit of impulse, the second dashpot takes F h:
///
///   gamma = s* / (F h),   s* = s0 - F h (s0 - s) / p.

namespace hooke::solver {

/// A segment that gives way in this substep.
struct GivingSegment {
  enum class Giving : std::uint8_t { kNothing, kSome, kMost };

  std::uint32_t row = 0;  ///< Its row.
  Giving giving = Giving::kNothing;
  double resistance = 0;    ///< Impulse of its dashpot over the speed of its ends [kg].
  double most = 0;          ///< Impulse that it can take, F h [N s].
  double parting = 0;       ///< s0 [m/s]
  double needed_force = 0;  ///< [N]
};

/// Constants of a segment that is a dashpot. They make the equation of solver/rope/rope_systems.h draw it
/// neither to a length nor across its direction, and find no error of its length.
[[nodiscard]] wide::SegmentTraits<double> dashpot_traits(double resistance,
                                                         const wide::SegmentTraits<double>& of);

/// Makes a segment that gives way a dashpot.
void apply_dashpot(const GivingSegment& giving, RopeSegment& segment);

/// Sets the next dashpot of a segment by a solution in which its ends parted at `speed` [m/s] and it took
/// `impulse` [N s]. False if it takes what it can.
bool set_dashpot(double speed, double impulse, GivingSegment& giving);

}  // namespace hooke::solver
