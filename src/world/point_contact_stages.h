#pragma once

#include "world/world_data.h"

/// \file
/// These stages of the step concern contacts of deformables: those of particles, edges and faces with bodies,
/// and those of ropes with ropes. The last four keep bodies from passing through faces and segments, at any
/// speed, whatever the solver has left (docs/decisions/0044-bodies-that-pass-nothing.md).

namespace hooke::world {

/// Finds the particles and elements that may touch bodies within `dt` [s], and the rope segments that may
/// touch each other.
void find_point_contacts(WorldData& world, double dt);

/// Updates normals, gaps and surface velocities of these contacts for a particle substep of length `h` [s].
void update_point_contacts(WorldData& world, Real h);

/// Solves the contacts that belong to no rope system and no coupled group, and stops ropes that would still
/// pass through each other.
void solve_point_contacts(WorldData& world, Real h);

/// Finds the faces of stiff solids on which bodies press in a particle substep of `h` [s], which belong to
/// the solution of these solids.
void find_pressed_faces(WorldData& world, Real h);

/// Adds the mass of bodies that press on faces and segments to their points while elastic rows are solved, so
/// that these stop the body and not only light points. What presses is what was stopped in the particle
/// substep before; in the `first` one of a step, what would pass within `h` [s].
void share_passing_masses(WorldData& world, Real h, bool first);

/// Takes these masses away again. Bodies get their share of the impulses.
void give_back_passing_masses(WorldData& world);

/// Gives the impulses that stop bodies and elements which would pass through each other within the particle
/// substep of length `h` [s]. It comes last of all that changes velocities.
void stop_body_passes(WorldData& world, Real h);

/// Takes back the motion of the last particle substep of those that have come through each other all the
/// same: they go on as one, with their common momentum, or stay with what nothing moves.
void hold_back_passes(WorldData& world, Real h);

}  // namespace hooke::world
