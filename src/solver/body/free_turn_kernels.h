#pragma once

#include "hooke/math.h"

#include "solver/simd/lanes.h"

/// \file
/// Gyroscopic turns of bodies whose inertia differs by axis, side by side. The formula stands in
/// solver/body/body_motion.h (accelerate_bodies). Every instruction set gives the bits of the scalar twin
/// (solver/simd/dispatch.h).

namespace hooke::solver::wide {

struct alignas(64) TurnLanes {
  Real axes[4][kLanes];      ///< Rotation from the principal axes to those of the world: x y z w.
  Real inverse[3][kLanes];   ///< 1 / I about each principal axis [1/(kg m^2)].
  Real momentum[3][kLanes];  ///< Angular momentum in axes of the world [kg m^2/s].
  Real omega[3][kLanes];     ///< The result: mean velocity by the midpoint rule [rad/s].
};

/// Turns the first `count` lanes over a substep of length h [s], none by more than a quarter radian.
void turn_freely(Real h, int count, TurnLanes& turns);
void turn_freely_scalar(Real h, int count, TurnLanes& turns);

}  // namespace hooke::solver::wide
