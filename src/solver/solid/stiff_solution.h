#pragma once

#include "solver/solid/stiff_rows.h"
#include "solver/solid/tetrahedron_blocks.h"
#include "solver/solid/tetrahedron_solve.h"
#include "state/particles.h"

/// \file
/// All rows of a group of tetrahedra solved at once, where some are stiff: the change dv of velocities with
///
///   W^-1 dv + sum K dv = f
///
/// f being the impulses of the rows at the velocities before, K how a row resists a motion of its corners
/// (StressBlock), and W how a particle answers an impulse. It is found by conjugate gradients, which the
/// blocks of three by three on the diagonal precondition (Hestenes and Stiefel 1952), so that a load of any
/// mass is felt through all of the solid. Each direction is one pass over the rows.
///
/// Sums are made in the order of particles, and passes color after color, so that results have the same bits
/// for any number of workers.

namespace hooke::solver {

/// Forgets the last solution of one part.
void begin_stiff_solution(TetrahedronBlocks& tetrahedra);

/// Begins with the change so far, and with `start` for points that a contact has taken hold of. It becomes
/// the direction. Returns whether it is other than zero, so that rows resist it.
[[nodiscard]] bool look_back(const StiffSystem& system);

/// Takes W of each particle, and finds the residual and the first direction. `image` is how rows resist the
/// change so far.
void aim(const state::Particles& particles, StiffSystem& system);

/// Whether the residual is too large still.
[[nodiscard]] bool needs_direction(const StiffSystem& system);

/// Whether enough directions are left to solve for other contacts to the end. What is not solved to the end
/// may gain energy; a contact that pulls for a substep does not.
[[nodiscard]] bool may_solve_again(const StiffSystem& system);

/// Lets the next solution have a smaller error. Returns false if it is the smallest already.
[[nodiscard]] bool sharpen(StiffSystem& system);

/// Whether the last solution came down to the smallest error before directions ran out.
[[nodiscard]] bool is_solved(const StiffSystem& system);

/// Goes along the direction as far as its image says, and finds the next one.
void advance(StiffSystem& system);

/// Calls `pass` with what rows of stress do, which it does with all blocks, color after color, and adds what
/// contacts and hooks resist.
template <class Pass>
void resist_direction(const StiffSystem& system, const Pass& pass) {
  pass(resist_tetrahedra);
  resist_stiff_rows(system);
  resist_ties(system);
}

/// Finds the first direction for the present W and contacts, from the change so far.
template <class Pass>
void begin_directions(const state::Particles& particles, StiffSystem& system, const Pass& pass) {
  if (look_back(system)) resist_direction(system, pass);
  aim(particles, system);
}

/// Goes along directions until the error is small enough. Call it again with a smaller error to go on.
template <class Pass>
void follow_directions(StiffSystem& system, const Pass& pass) {
  while (needs_direction(system)) {
    resist_direction(system, pass);
    advance(system);
  }
}

/// Notes the impulses that pressed points have so far.
void find_pressed_impulses(TetrahedronBlocks& tetrahedra);

/// Changes the velocities of all particles of a part but those that something presses on.
void finish_stiff_solution(bool converged, TetrahedronBlocks& tetrahedra, state::Particles& particles);

}  // namespace hooke::solver
