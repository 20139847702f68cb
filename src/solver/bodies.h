#pragma once

#include "hooke/math.h"

#include "parallel/range.h"
#include "state/bodies.h"

namespace hooke::solver {

/// Start of a step: S = I^(-1/2) in world axes, omega_scaled = S L, no displacement yet. `range` counts body
/// rows; bodies that are holes, static or asleep keep a line at rest, kinematic ones get their velocity.
void prepare_bodies(parallel::Range range, state::Bodies& bodies);

/// Start of a substep of length h [s]: gravity, external force and torque, damping, gyroscopic torque (Lie
/// midpoint rule, three fixed iterations), then the warm start of contact and joint rows.
void accelerate_bodies(parallel::Range range, Vec3 gravity, Real h, state::Bodies& bodies);

/// dx += h v, theta_scaled += h omega_scaled.
void move_bodies(parallel::Range range, Real h, state::Bodies& bodies);

/// End of a step: centers and rotations follow dx and theta, L follows the change of omega_scaled only (so
/// that a free body keeps it exactly), odometers grow by the way of the fastest point.
void finish_bodies(parallel::Range range, state::Bodies& bodies);

}  // namespace hooke::solver
