#pragma once

#include "solver/contact/body_contacts.h"
#include "solver/joint/joints.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Which contacts of two bodies are solved in coupled groups: those that bear load
/// (solver/coupled/load_bearing_contacts.h), all others of their bodies, and direct islands
/// (solver/coupled/direct_islands.h) that have such a contact or a body of an articulation. Rows of one body
/// that were solved in turn would undo each other.

namespace hooke::solver {

/// Whether the contact may be coupled because of others: it has rows, and its bodies are not of one
/// articulation. What hooks say about their places already would be said twice, and never quite the same.
[[nodiscard]] bool may_be_coupled(const state::Manifold& manifold, const state::Bodies& bodies,
                                  const Joints& joints);

/// Couples all such contacts of bodies that have a coupled contact, and marks in `joined` by body row what
/// makes a direct island coupled: such a body, or one that hooks of an articulation or at points hold.
void couple_neighbors(const Joints& joints, state::Tables& tables, std::vector<std::uint8_t>& joined);

/// Fills Pairs::coupled by the ways of the manifolds.
void list_coupled_manifolds(state::Pairs& pairs, std::vector<std::uint32_t>& bearing);

/// Notes the lanes of coupled manifolds.
void find_coupled_lanes(const BodyContacts& contacts, state::Pairs& pairs);

}  // namespace hooke::solver
