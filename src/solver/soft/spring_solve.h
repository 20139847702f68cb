#pragma once

#include "parallel/range.h"
#include "solver/soft/spring_blocks.h"
#include "state/particles.h"

namespace hooke::solver {

/// Corrects velocities so that each spring ends the substep with the force of an implicit Euler step, in one
/// pass.
///
/// Constraint   C = |x_a - x_b| - L [m],  n = (x_a - x_b) / |x_a - x_b|, both at the start of the substep
/// Softness     b = k / (c + h k) [1/s],  gamma = 1 / (h (c + h k)) [1/kg];  k = infinity: b = 1/h, gamma = 0
/// Impulse      lambda = -(n . (v_a - v_b) + b C) / (w_a + w_b + gamma) [N s]
/// Update       v_a += w_a lambda n,  v_b -= w_b lambda n
///
/// A damper that is much stronger than its spring and than the mass of its points is a lock on their speed.
/// One pass over a sheet of such locks does not solve them: light strips with weak shear came to 1e15 m/s. So
/// c counts up to m / 2 h or 10 h k, whichever is more, where m is the row's damped_mass.
///
/// The multiplier starts from zero each substep: carrying it over makes stiff springs gain energy. With d =
/// x_a - x_b and l = |d| the impulse is p = -d (d . dv + b l (l - L)) / (l^2 (w_a + w_b + gamma)), which
/// takes one square root and one division. A row of zero length, or between two pinned particles, is left
/// alone. One-sided rows only pull. `blocks` must lie within one pass.
void solve_springs(const SpringBlocks& springs, const SpringPass& pass, parallel::Range blocks, Real h,
                   state::Particles& particles);

}  // namespace hooke::solver
