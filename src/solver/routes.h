#pragma once

#include "hooke/world.h"

#include "solver/contact/body_contacts.h"
#include "solver/coupled/coupled_groups.h"
#include "solver/coupled/direct_islands.h"
#include "solver/coupled/load_bearing_contacts.h"
#include "solver/joint/joints.h"
#include "solver/rope/rope_systems.h"
#include "state/route.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Which way each contact and each hook is solved: the signpost of the solver. The tables carry the ways
/// (state/route.h), and StepReport counts them. Ways of contacts and hooks are chosen once a step, by the
/// functions below; what they choose by is the work of the files named here. When contacts are looked for is
/// chosen by the narrow phase (collision/narrow_phase/narrow_phase.cpp), which trees are approximate by
/// evaluate_ragdolls before contacts are looked for, and who belongs to a coupled group by
/// build_coupled_groups in each particle substep.
///
// clang-format off
/// Contacts of two bodies (state::ContactRoute)
///
///   none      A sensor, bodies none of which moves, or no point near enough: there is nothing to solve.
///   coupled   One of the bodies hangs on hooks, and the other is at least twice as heavy or presses harder than
///             the first weighs; or a light hooked body is pressed on the ground by what it is hooked to
///             (solver/coupled/load_bearing_contacts.h). Rows of the contact alone pass on at most what stops the
///             light body, so the contact is solved with those hooks and ropes, by factorizations in each substep.
///             512 manifolds at most: StepReport::rows_refused counts the others that ask for it. So are all
///             other contacts of these bodies, and direct islands with such a body or a hooked one
///             (solver/coupled/coupled_manifolds.h). docs/decisions/0022-borne-contacts.md,
///             docs/decisions/0032-contacts-in-coupled-groups.md
///   direct    The contacts of its island sag, or would buckle, as soft rows: a high stack, a heavy body on light
///             ones. All contacts of the island are solved by one factorization in each substep
///             (solver/coupled/direct_islands.h). 256 bodies and 4e4 multiplications an island at most, 1e6 in
///             all, the largest loads first: StepReport::rows_refused counts the others, which stay soft, and
///             those that kDirectStepBudget gave up. An island is direct at once if something heavy arrives on
///             something light (docs/decisions/0035-arrivals-and-calm-solutions.md).
///             docs/decisions/0007-hard-islands.md
///   soft      All others. Rows that yield a little are solved color after color, 16 side by side, once with and
///             once without bias in a substep (solver/contact/body_contacts.h). It is the cheapest way.
///             docs/decisions/0004-body-contacts.md
///
/// Contacts with restitution collide in the order of time besides: each impact within the substep
/// gives its impulse before the rows are solved (solver/contact/impacts.h). docs/decisions/0018-hits.md
///
/// When contacts of two bodies are looked for (state::ContactRefresh)
///
///   at start       Most: their rows follow the bodies to first order within the step.
///   in the middle  A body that spins or rolls on another one and stays in contact.
///   at impact      Fast pairs: where they will meet, if they meet within the step.
///   each substep   Pairs that roll or slide far for their thickness, without restitution, of bodies that are near
///                  no third one, where it would cost most and help least. Soft contacts get new rows then, direct
///                  ones keep those of the step's start. docs/decisions/0015-lively-contacts.md
///
/// Contacts that bear load are refreshed in each substep, whatever the narrow phase has chosen.
///
/// Hooks (state::JointRoute). Hooks that share bodies which forces move are one group, an articulation.
///
///   none              Forces move neither body: there is nothing to solve.
///   tree              The group has no loop: links are eliminated one after the other, several trees side by
///                     side (solver/joint/articulation_trees.cpp). Exact, and linear in the hooks, within ten
///                     times kArticulationBudget. docs/decisions/0017-articulations.md
///   approximate tree  A ragdoll: a tree of like masses that moves freely, with friction at each joint and no
///                     drive, whose errors are small. It is solved once a substep, in float
///                     (solver/joint/approximate_trees.h). docs/decisions/0023-loose-trees.md
///   loop              The group has loops: a sparse factorization, within kArticulationBudget of work, ten times
///                     that where masses are unlike (solver/joint/articulation_loops.cpp).
///                     docs/decisions/0017-articulations.md
///   block             The group is beyond its budget: plain ball hooks of bodies with few hooks are iterated, 16
///                     side by side (solver/joint/ball_joints.h). StepReport::rows_refused counts their rows.
///                     docs/decisions/0008-hooks-that-do-not-diverge.md
///   iterative         The same for all other hooks of such groups (solver/joint/iterative_joints.h).
///   coupled           An end of the hook is a point of a rope, cloth, solid or group of particles, or its group,
///                     ragdolls too, has contacts or points that are solved with it. All of it is one coupled
///                     group with the ropes (solver/coupled/coupled_groups.h): Newton steps with a factorization
///                     each. After four of them kCoupledGroupBudget of work ends it, and where none is found it
///                     takes one that can only lose energy (docs/decisions/0035-arrivals-and-calm-solutions.md):
///                     StepReport::coupled_groups_cut_short counts both. Ball hooks that hold a rope by what does
///                     not move are anchors of the rope alone, and count here too.
///                     docs/decisions/0011-ties.md
// clang-format on
///
/// Cloths. Springs, limits and bends along the rows and columns of a woven cloth are solved yarn by yarn,
/// each exactly (solver/soft/yarns.h, docs/decisions/0046-yarns.md); all others are swept once in a substep.
/// A cloth that bears more than four times the mass of a yarn, at a point by a load, a hook or what presses
/// on its faces, or by all that gravity presses on its points, is solved as a whole after these passes, with
/// the bodies on its points (solver/cloth/loaded_cloths.h, docs/decisions/0049-loaded-cloths.md).
/// StepReport::cloths_unconverged counts what used up its work.
///
/// Solids of which a tetrahedron is stiff are solved as a whole, with what presses on their points and faces,
/// what they are hooked to and each other (solver/solid/stiff_solution.h,
/// docs/decisions/0037-stiff-solids-as-a-whole.md, docs/decisions/0051-faces-of-stiff-solids.md); all others
/// are swept once.
///
/// Ropes alone are rope systems, solved several side by side (solver/rope/rope_systems.h,
/// docs/decisions/0012-rope-lanes.md). Ropes that hold or touch something that gives way belong to a coupled
/// group. Contacts of a rope belong to its rope system or coupled group. All contacts of other points that
/// touch a body which gives way, or hang on a hook, belong to its coupled group, those of edges and faces
/// with such a body if the object has few of them. All others are swept once in a substep
/// (solver/soft/particle_contact_solve.h, solver/soft/element_contact_solve.h).

namespace hooke::solver {

/// Gives hooks outside articulations their ways, which stay the same as long as no hook comes or goes: call
/// it after build_joints. Hooks at points get the way "coupled".
void set_joint_routes(const Joints& joints, std::vector<state::Hook>& hooks);

/// Gives each hook of an articulation the way of its articulation in this step. Those that are solved with
/// contacts or points become coupled in choose_contact_routes.
void choose_joint_routes(const Joints& joints, std::vector<state::Hook>& hooks);

/// Gives each manifold its way, and the way "coupled" to the hooks that are solved with contacts or points.
/// `awake` are rows of bodies that move in
/// this step, in ascending order; `body_marks` is scratch. Call it after choose_joint_routes. Returns how
/// many contacts go which way, counted here because one more walk over all manifolds takes time.
[[nodiscard]] RouteCounts choose_contact_routes(const LoadBearingInputs& inputs,
                                                std::span<const std::uint32_t> awake,
                                                std::vector<std::uint8_t>& body_marks,
                                                LoadBearingScratch& load_bearing, DirectIslands& direct,
                                                state::Tables& tables);

/// Adds to the counts of contacts how many pairs, hooks and ropes go which way in this step.
[[nodiscard]] RouteCounts count_routes(const state::Tables& tables, const Joints& joints,
                                       std::span<const RopeSystem> rope_systems, const CoupledGroups& groups,
                                       const DirectIslands& direct, RouteCounts counts);

}  // namespace hooke::solver
