#pragma once

#include "hooke/math.h"

#include "world/world_data.h"

/// \file
/// These stages keep fast bodies from passing through others, and keep their energy while they rotate far.

namespace hooke::world {

/// Stores the rotations of awake bodies, because some rotate before the step ends. Freezes the inertia of
/// bodies that rotate far in this step and touch something or hang on hooks (state::FrozenInertia).
void begin_motion(WorldData& world, Real dt);

/// Freezes the inertia of touching bodies that have rotated too far for their rows (state::FrozenInertia). It
/// is called before contacts are solved in a substep of length `h` [s], and again when bodies have moved
/// (`moved`).
void freeze_inertia(WorldData& world, Real h, bool moved);

/// Sweeps the bodies whose motion and rotation in this step add up to more than a quarter of their thickness,
/// against all that is in their way, in relative motion. Those that would have gone through something are
/// clamped to their time of impact (collision/continuous/continuous.h). Velocities stay for the contact of
/// the next step. Only the angular momentum of a clamped body shrinks if its new rotation would give it more
/// energy. Nothing happens in a step in which nothing is fast.
void clamp_to_impact_times(WorldData& world);

}  // namespace hooke::world
