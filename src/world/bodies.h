#pragma once

#include "hooke/world.h"

#include "parallel/thread_pool.h"
#include "world/world_data.h"

#include <cstdint>

/// \file
/// The stages of the step that concern bodies as a whole.

namespace hooke::world {

/// Fills `awake`.
void list_awake_bodies(WorldData& world);

/// Boxes of all colliders that move, the pairs they make, and their manifolds.
void find_body_contacts(WorldData& world, Real dt);

/// Velocities that bring kinematic bodies to where their paths want them at `time`, `h` from now.
void drive_kinematic_bodies(WorldData& world, double time, Real h);

/// Puts bodies whose state is not finite back to where the step began, at rest. Returns their number.
std::uint32_t quarantine_bodies(WorldData& world);

}  // namespace hooke::world
