#pragma once

#include "world/world_data.h"

/// \file
/// These stages of the step concern deformables as a whole. They call kernels of solver/ and collision/.

namespace hooke::world {

/// Makes the solver's copies of rows again for the objects whose rows were added, removed or changed since.
void refresh_derived(WorldData& world);

/// Computes the coefficients of springs, bends and tetrahedra for particle substeps of length `h` [s].
void prepare_particle_rows(WorldData& world, Real h);

/// Reads the wind at each particle for the middle of the step, begins the forces on bodies, gives each rope
/// the range of its contacts, and zeroes the sums of the step.
void begin_step(WorldData& world, double dt);

/// Damps solids and stores the velocities of ropes. It is called before the forces of a particle substep,
/// because both need the velocities from before.
void begin_particle_substep(WorldData& world, Real h);

/// Solves the yarns of woven cloths (solver/soft/yarns.h).
void solve_yarns(WorldData& world);

/// The first function solves the springs of the classes from `first` to `last`. The second solves bends and
/// isometric bending elements, whose springs belong to them. Rows of one pass share no particle, so their
/// order does not matter; passes follow one another.
void solve_springs(WorldData& world, Real h, state::SpringClass first, state::SpringClass last);
void solve_bends(WorldData& world);

/// The first two functions find cloths that bear much more than their yarns hold, before any spring is
/// solved: by what presses on their points, and by masses that these have or were lent. The third solves
/// these as a whole, after all passes (solver/cloth/loaded_cloths.h).
void find_pressed_cloths(WorldData& world, Real h);
void find_loaded_cloths(WorldData& world);
void solve_loaded_cloths(WorldData& world, Real h);

/// Starts a particle substep of length `h` [s] for ropes and coupled groups. Twisted ropes turn bodies, hooks
/// slide along ropes, and coupled groups are built. Their bodies get gravity and contact impulses in shares,
/// and mass shares begin. `first` marks the first particle substep of a substep.
void begin_coupled_groups(WorldData& world, Real h, bool first);
/// Splits points of cloths and solids that are strained or stressed more than they take, and lists them.
void tear_deformables(WorldData& world, double dt);
/// Solves rope systems and coupled groups up to `end_time` [s]. `first` marks the first particle substep of a
/// step.
void solve_ropes(WorldData& world, double end_time, Real h, bool first);

/// Solves solids, by tetrahedra or shape matching, and then the gas in closed cloths.
void solve_solids(WorldData& world, Real h);

/// Moves all particles by a particle substep of length `h` [s]. Solids that are stressed beyond their yield
/// stress then take on a new rest shape. This happens in each particle substep, because an impact may be
/// shorter than a step.
void move_particles(WorldData& world, Real h);

/// Gives bends of cloths that are bent beyond their yield angle a new rest angle. It is called once a step.
void flow_cloths(WorldData& world);

/// Puts particles whose state is not finite back to where they began the step, at rest, and clears tensions
/// that are not finite. Returns the number of particles.
std::uint32_t quarantine_non_finite(WorldData& world);

/// Moves the origin of each object that has gone far from it, by whole meters.
void rebase_origins(WorldData& world);

}  // namespace hooke::world
