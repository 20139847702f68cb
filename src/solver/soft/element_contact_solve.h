#pragma once

#include "state/tables.h"

namespace hooke::solver {

/// Whether a contact between points joins its object to what it touches and is solved with it, in a bundle
/// (solver/coupled/coupled_groups.h): of a rope; of a cloth with bodies that give way, if they are few. Only
/// once it has been near.
[[nodiscard]] bool is_coupled(const state::Tables& tables, const state::ElementContact& contact);

/// Whether the contact may act within this substep (collision::update_inner_contacts).
[[nodiscard]] bool is_near(const state::ElementContact& contact);

/// The others, row after row, in order, twice. As solver/soft/particle_contact_solve.h has it for particles,
/// with the velocity sum w_i v_i of the place, the inverse mass sum w_i^2 / m_i that resists there, and that
/// of the body if it gives way. An overlap is undone in the position of the points only, in the same shares.
void solve_element_contacts(Real h, state::Tables& tables);

/// Moves the points of a row out of what lies between them.
void push_out(const state::ElementContact& contact, Real h, state::Particles& particles);

}  // namespace hooke::solver
