#pragma once

#include "solver/solid/stiff_ends.h"
#include "state/hooks.h"
#include "state/tables.h"

/// \file
/// Ball hooks of stiff solids in the stiff solution. The solution finds what points do under stress while
/// hooks hold them; hooks themselves are solved after it, with all that they join. Points that stress had
/// moved as if nothing held them were drawn back as light ones: a jelly of 100 MPa that hung on a hook with
/// 50 kg under it gained 17 times its energy.

namespace hooke::solver {

struct StiffSystem;

/// A hook between points of solids and a body, the world or points of other solids. It gives the points the
/// impulse
///
///   carried - stiffness u
///
/// u being the velocity at which the points leave the other end, after the solution. `carried` is what the
/// solution before found, so that u vanishes (augmented Lagrangian, Hestenes 1969).
struct StiffTie {
  WeightedPoints<2 * state::HookPlace::kMostParticles> points = {};
  StiffEnd other = {};
  DVec3 before = {};     ///< u before the solution, with what closes the gap within a substep [m/s].
  double stiffness = 0;  ///< [kg]
  DVec3 carried = {};    ///< [N s]
};

/// Lets bodies that hooks hold be unknowns of the solution, and chooses how stiff each hook is in it. Call it
/// after rows of stress have been linearized and pressed points noted.
void prepare_ties(const state::Tables& tables, const StiffSystem& system);

/// Adds what hooks add to the diagonals of their points.
void add_tie_diagonals(const StiffSystem& system);

/// Adds the impulses of hooks at the velocities before to the residuals.
void add_tie_forces(const StiffSystem& system);

/// Adds the impulses by which hooks resist the direction to the images.
void resist_ties(const StiffSystem& system);

/// Carries the impulses of hooks on. Returns whether one changes so much that it is to be solved again.
[[nodiscard]] bool renew_ties(const StiffSystem& system);

/// Takes the impulses of hooks back, so that hooks find them again when they are solved.
void release_ties(const StiffSystem& system, state::Particles& particles);

}  // namespace hooke::solver
