#pragma once

#include "world/world_data.h"

/// \file
/// These stages of the step concern contacts of deformables: those of particles, edges and faces with bodies,
/// and those of ropes with ropes.

namespace hooke::world {

/// Finds the particles and elements that may touch bodies within `dt` [s], and the rope segments that may
/// touch each other.
void find_point_contacts(WorldData& world, double dt);

/// Updates normals, gaps and surface velocities of these contacts for a particle substep of length `h` [s].
void update_point_contacts(WorldData& world, Real h);

/// Solves the contacts that belong to no rope system and no coupled group, and stops ropes that would still
/// pass through each other.
void solve_point_contacts(WorldData& world, Real h);

}  // namespace hooke::world
