#pragma once

#include "hooke/math.h"

#include "world/world_data.h"

/// \file
/// The stage of the step that keeps fast bodies from passing through others.

namespace hooke::world {

/// Remembers how the bodies that are awake are turned, some turn before the step ends, and finds those that
/// touch something in it while they turn far (state::FrozenInertia).
void begin_motion(WorldData& world, Real dt);

/// Before contacts of a substep, and again when bodies have moved: those that have turned over while they
/// touch something keep the inertia that their rows know (state::FrozenInertia).
void freeze_inertia(WorldData& world, Real h, bool moved);

/// Bodies that moved farther in this step than a quarter of their thickness, or turned as far, are swept
/// against all that is in their way, in relative motion, and give way where they would have gone through it
/// (collision/continuous/continuous.h); velocities are not changed: the contact is the next step's. Does
/// nothing in a world in which nothing is fast.
void clamp_to_impact_times(WorldData& world);

}  // namespace hooke::world
