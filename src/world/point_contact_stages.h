#pragma once

#include "world/world_data.h"

/// \file
/// The stages of the step that concern contacts of deformables: of particles, edges and faces with bodies,
/// and of ropes with ropes.

namespace hooke::world {

/// Which particles and elements may touch bodies, and which rope segments each other, within this step.
void find_point_contacts(WorldData& world, double dt);

/// Where these contacts are now, in a substep of length `h` [s].
void update_point_contacts(WorldData& world, Real h);

/// Contacts that no rope system and no coupled group has solved; and no rope passes through another one.
void solve_point_contacts(WorldData& world, Real h);

}  // namespace hooke::world
