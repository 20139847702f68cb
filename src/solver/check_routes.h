#pragma once

#include "solver/contact/body_contacts.h"
#include "solver/coupled/coupled_groups.h"
#include "solver/coupled/direct_islands.h"
#include "solver/joint/joints.h"
#include "solver/rope/rope_systems.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Whether what is solved is what solver/routes.h says: each contact and each hook goes one way, and is in
/// what that way solves, once. Each function says in a few words what is wrong, or returns null. `marks` is
/// scratch, so that a warm step allocates nothing.

namespace hooke::solver {

/// After prepare_body_contacts and prepare_direct_islands: colors share no body that contacts move; each
/// manifold with a way has one lane; direct islands are disjoint, and have all direct contacts.
[[nodiscard]] const char* find_in_contact_routes(const state::Tables& tables, const BodyContacts& contacts,
                                                 const DirectIslands& direct,
                                                 std::vector<std::uint32_t>& marks);

/// After choose_joint_routes and choose_contact_routes: each hook is in one articulation, a ball joint or an
/// iterative joint; articulations share no body that forces move.
[[nodiscard]] const char* find_in_joint_routes(const state::Tables& tables, const Joints& joints,
                                               std::vector<std::uint32_t>& marks);

/// After build_coupled_groups: groups are disjoint, name rows that exist, and have all hooks and manifolds
/// that are coupled.
[[nodiscard]] const char* find_in_coupled_groups(const state::Tables& tables,
                                                 std::span<const RopeSystem> rope_systems,
                                                 const CoupledGroups& groups,
                                                 std::vector<std::uint32_t>& marks);

}  // namespace hooke::solver
