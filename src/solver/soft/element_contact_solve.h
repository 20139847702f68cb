#pragma once

#include "state/tables.h"

#include <span>

namespace hooke::solver {

/// Whether an element contact is solved together with the body that its object touches, in a coupled group
/// (solver/coupled/coupled_groups.h). It is if the object is a rope, or a cloth with few contacts of bodies
/// that give way, and only once the contact has been near.
[[nodiscard]] bool is_coupled(const state::Tables& tables, const state::ElementContact& contact);

/// Whether the contact may act within this substep (collision::update_element_contacts).
[[nodiscard]] bool is_near(const state::ElementContact& contact);

/// Solves the other element contacts, row after row, in order, twice, as
/// solver/soft/particle_contact_solve.h does for particles. The contact's place has the velocity sum w_i v_i
/// and the inverse mass sum w_i^2 / m_i, to which that of the body is added if it gives way. An overlap is
/// undone in the position of the points only, in the same shares.
void solve_element_contacts(Real h, state::Tables& tables);

/// Solves a row of collision/deformable/body_passes.h, with friction. What has come nearer than its distance
/// is not pushed back. Returns the change of speed along the normal that was needed [m/s].
Real stop_pass(Real h, state::ElementContact& pass, state::Tables& tables);

/// Moves the points of a contact out of the body that they overlap.
void push_out(const state::ElementContact& contact, Real h, state::Tables& tables);

}  // namespace hooke::solver
