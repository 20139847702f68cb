#pragma once

#include "world/world_data.h"

namespace hooke::world {

/// Explosions whose time falls within the `dt` that begins now change velocities; sleepers they reach wake.
void set_off_explosions(WorldData& world, double dt);

/// Start of a step: whether anything pushes bodies anew in each substep, and what was given for all of them.
void begin_body_forces(WorldData& world);

/// The force and torque on bodies for the substep of length h that begins at `time`: what was given for the
/// step, what twisted ropes and fields do, and what the user's laws over bodies ask for.
void force_bodies(WorldData& world, double time, Real h);

}  // namespace hooke::world
