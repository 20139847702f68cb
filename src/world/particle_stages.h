#pragma once

#include "world/world_data.h"

/// \file
/// The stages of the step that look at whole objects. The kernels they call are in solver/ and collision/.

namespace hooke::world {

/// Makes the solver's copies of rows anew if rows came or went since they were made.
void refresh_derived(WorldData& world);

/// The coefficients of springs, bends and tetrahedra for a particle substep of `h` [s].
void prepare_particle_rows(WorldData& world, Real h);

/// Reads the wind at each particle for the middle of the step, and zeroes what the step sums up.
void begin_step(WorldData& world, double dt);

/// What looks at velocities before the substep's forces change them: ropes remember theirs, solids are
/// damped.
void begin_particle_substep(WorldData& world, Real h);

/// The wind on triangles and segments; drag, forces, fields on particles; the user's force laws. Triangles
/// are weighed by the wind in the `first` particle substep of a substep and pushed by the same force in all
/// of them.
void apply_wind(WorldData& world, Real h, bool first);
void apply_forces(WorldData& world, Real h);
void apply_gravity(WorldData& world, Real h);
void call_force_laws(WorldData& world, double time, Real h);

/// Ropes and particles with repulsion push each other apart; pinned particles get the velocities that bring
/// them to where their pins are at `time`.
void repel_and_drive(WorldData& world, double time, Real h);

/// Springs of the classes from `first` to `last`; bends, with the springs that lie in hinges. Rows of one
/// pass share no particle, so their order does not matter; passes follow one another.
void solve_springs(WorldData& world, Real h, state::SpringClass first, state::SpringClass last);
void solve_bends(WorldData& world);

/// What is tied to what, in a substep of length h [s], the `first` of those that bodies share.
void begin_coupled_groups(WorldData& world, Real h, bool first);
/// Ropes and what they are tied to.
void solve_ropes(WorldData& world, Real h);

/// Tetrahedra of solids, color after color; then the gas in closed cloths.
void solve_solids(WorldData& world, Real h);

/// Moves all particles by a substep of length `h` [s]. Solids that are stressed beyond their yield stress
/// take on their new shape, in each particle substep, as a blow may be over within a step.
void move_particles(WorldData& world, Real h);

/// What is bent in cloths beyond their yield angle takes on its new angle.
void flow_cloths(WorldData& world);

/// Puts rows that are not finite back to where they began the step, at rest. Returns how many.
std::uint32_t quarantine_non_finite(WorldData& world);

/// Moves the origin of each object that has wandered far from it, by whole meters.
void rebase_origins(WorldData& world);

}  // namespace hooke::world
