#pragma once

#include "hooke/math.h"

#include "solver/simd/lanes.h"

/// \file
/// Free turns of bodies whose inertia differs by axis, side by side; the formula stands in
/// solver/body/body_motion.h (accelerate_bodies). As in wide.h, every instruction set gives the bits of the
/// scalar twin.

namespace hooke::solver::wide {

struct alignas(64) TurnLanes {
  Real axes[4][kLanes];      ///< From the principal axes to those of the world: x y z w.
  Real inverse[3][kLanes];   ///< 1 / I about each [1/(kg m^2)].
  Real momentum[3][kLanes];  ///< Angular, in axes of the world [kg m^2/s].
  Real omega[3][kLanes];     ///< The result: mean velocity by the midpoint rule [rad/s].
};

/// Turns over a substep of length h [s], none of more than a quarter radian; the first `count` lanes.
void turn_freely(Real h, int count, TurnLanes& turns);
void turn_freely_scalar(Real h, int count, TurnLanes& turns);

}  // namespace hooke::solver::wide
