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
/// Which way each contact and each hook is solved: the signpost of the solver. The ways are chosen once a
/// step, here and nowhere else; the tables carry them (state/route.h), and StepReport counts them.
///
/// Contacts of two bodies (state::ContactRoute)
///
///   none      A sensor, bodies none of which moves, or no point near enough: there is nothing to solve.
///   coupled   One of the bodies hangs on hooks, and the other is at least twice as heavy or presses harder
///   than
///             it weighs; or a light hooked body is pressed on the ground by what it is hooked to. Rows of
///             the contact alone pass on at most what stops the light body. The contact is solved with those
///             hooks and ropes (solver/coupled/load_bearing_contacts.h), by a factorization in each substep.
///             512 pairs of bodies at most: StepReport::contacts_refused counts the rest.
///             docs/decisions/0022.
///   direct    The contacts of its island sag or would buckle as soft rows: a high stack, a heavy body on
///   light
///             ones. All contacts of the island are solved by one factorization in each substep
///             (solver/coupled/direct_islands.h). 256 bodies and a budget of work at most, the largest loads
///             first: StepReport::islands_refused counts the rest, which stay soft. docs/decisions/0007.
///   soft      All others. Rows that yield a little are solved color after color, 16 side by side, once with
///   and
///             once without bias in a substep (solver/contact/body_contacts.h). The cheapest.
///             docs/decisions/0004.
///
/// Soft and direct contacts with restitution meet in the order of time besides: each impact within the
/// substep gives its impulse before the rows are solved (solver/contact/impacts.h). docs/decisions/0018.
///
/// When contacts of two bodies are looked for (state::ContactRefresh, chosen by the narrow phase)
///
///   at start       Most: their rows follow the bodies to first order within the step.
///   in the middle  A body that spins or rolls on another and stays in contact.
///   at impact      Fast pairs: where they will meet, if they meet within the step.
///   each substep   Pairs that roll or slide far for their thickness, without restitution; not in a pile,
///   where
///                  it would cost most and help least. docs/decisions/0015.
///
/// Hooks (state::JointRoute). Hooks that share bodies which forces move are one group, an articulation.
///
///   tree              The group has no loop: links are eliminated one after the other, several trees side by
///                     side (solver/joint/articulation_trees.cpp). Exact, linear in the hooks.
///                     docs/decisions/0017.
///   approximate tree  A ragdoll, of like masses and with ball hooks, whose errors are small: the same once a
///                     substep and in float (solver/joint/approximate_trees.h). docs/decisions/0023.
///   loop              The group has loops: a sparse factorization within kArticulationBudget of work
///                     (solver/joint/articulation_loops.cpp). docs/decisions/0017.
///   block             The group is beyond the budget, a net: plain ball hooks are iterated, 16 side by side
///                     (solver/joint/ball_joints.h). docs/decisions/0008.
///   iterative         The same for all other hooks of nets (solver/joint/iterative_joints.h).
///   coupled           An end of the hook is a point of a rope, cloth, solid or group of particles, or its
///   group
///                     has contacts that are solved with it. All of it is one coupled group with the ropes
///                     (solver/coupled/coupled_groups.h), by Newton steps with a factorization each, within
///                     kCoupledGroupBudget of work: StepReport::coupled_groups_cut_short counts those that
///                     end by it. docs/decisions/0011.
///
/// Ropes alone are rope systems, solved several side by side (solver/rope/rope_systems.h,
/// docs/decisions/0012); those that hold or touch something that gives way belong to a coupled group.
/// Contacts of points with bodies belong to the rope system or the coupled group of their rope, or to the
/// coupled group of a body on few of them; all others are swept once in a substep
/// (solver/soft/particle_contact_solve.h, element_contact_solve.h).

namespace hooke::solver {

/// What the choice of ways for contacts is made from, and where it is noted.
struct ContactRouting {
  const ContactStep& step;
  Real impulse_to_force = Real(0);       ///< Of the impulses that manifolds have from the last step [1/s].
  std::span<const std::uint32_t> awake;  ///< Rows of bodies that move in this step, in ascending order.
  std::span<const std::uint8_t> hooked;  ///< Whether a hook holds the body, by body row.
  const Supports& supports;
  const Joints& joints;
};

/// Gives each hook between bodies the way of its group. Coupled ones are found by choose_contact_routes.
void choose_joint_routes(const Joints& joints, std::vector<state::Hook>& hooks);

/// Gives each manifold its way, and the way "coupled" to the hooks that are solved with contacts or points.
/// `body_marks` is scratch. Call it after choose_joint_routes.
void choose_contact_routes(const ContactRouting& routing, std::vector<std::uint8_t>& body_marks,
                           LoadBearingScratch& load_bearing, DirectIslands& direct, state::Tables& tables);

/// How many contacts, hooks and ropes go which way in this step.
[[nodiscard]] RouteCounts count_routes(const state::Tables& tables, const Joints& joints,
                                       std::span<const RopeSystem> rope_systems, const CoupledGroups& groups,
                                       const DirectIslands& direct);

}  // namespace hooke::solver
