#include "solver/routes.h"

#include "base/assert.h"
#include "solver/contact/contact_colors.h"
#include "solver/coupled/coupled_articulations.h"
#include "solver/coupled/coupled_manifolds.h"
#include "solver/joint/hook_colors.h"
#include "solver/soft/element_contact_solve.h"

#include <algorithm>

namespace hooke::solver {

namespace {

using state::ContactRefresh;
using state::ContactRoute;
using state::Hook;
using state::JointRoute;
using state::Manifold;

JointRoute route_of(const Articulation& articulation) {
  if (articulation.has_loops()) return JointRoute::kLoop;
  return articulation.tree.approximate ? JointRoute::kApproximateTree : JointRoute::kTree;
}

/// Contacts between a direct body and what does not move, or between two of one island.
bool is_direct(const Manifold& m, const state::Bodies& bodies, const DirectIslands& direct) {
  const auto in_island = [&](std::uint32_t body) { return is_moved(bodies, body) && direct.holds(body); };
  const bool a = in_island(m.body_a);
  const bool b = in_island(m.body_b);
  if (!a && !b) return false;
  return a == b || !is_moved(bodies, m.body_a) || !is_moved(bodies, m.body_b);
}

ContactRoute route_of(const Manifold& m, const state::Bodies& bodies, const DirectIslands& direct) {
  if (m.route == ContactRoute::kCoupled) return m.route;
  if (!has_contact_rows(m, bodies)) return ContactRoute::kNone;
  return is_direct(m, bodies, direct) ? ContactRoute::kDirect : ContactRoute::kSoft;
}

void count_contact(const Manifold& m, RouteCounts& counts) {
  counts.contacts_soft += m.route == ContactRoute::kSoft ? 1 : 0;
  counts.contacts_direct += m.route == ContactRoute::kDirect ? 1 : 0;
  counts.contacts_coupled += m.route == ContactRoute::kCoupled ? 1 : 0;
  const bool has_rows = m.route != ContactRoute::kNone && m.point_count > 0;
  counts.contacts_bouncing += has_rows && m.restitution > Real(0) ? 1 : 0;
}

void count_pairs(const state::Tables& tables, RouteCounts& counts) {
  for (const state::Pair& pair : tables.pairs.pair) {
    if (pair.manifold_count == 0) continue;
    counts.pairs_at_start += pair.refresh == ContactRefresh::kAtStart ? 1 : 0;
    counts.pairs_in_the_middle += pair.refresh == ContactRefresh::kInTheMiddle ? 1 : 0;
    counts.pairs_at_impact += pair.refresh == ContactRefresh::kAtImpact ? 1 : 0;
    counts.pairs_each_substep += pair.is_refreshed() ? 1 : 0;
  }
}

/// Hooks that nothing solves in this step, because they hold nothing awake, are not counted.
void count_hooks(const state::Tables& tables, const Joints& joints, RouteCounts& counts) {
  const auto is_solved = [&](std::uint32_t row) { return is_awake(tables.hooks[row], tables.bodies); };
  for (const std::uint32_t i : joints.order) {
    for (const Articulation::Joint& joint : joints.articulations[i].joints) {
      if (joint.is_weld() || !is_solved(joint.hook)) continue;
      const JointRoute route = tables.hooks[joint.hook].route;
      counts.hooks_tree += route == JointRoute::kTree ? 1 : 0;
      counts.hooks_approximate_tree += route == JointRoute::kApproximateTree ? 1 : 0;
      counts.hooks_loop += route == JointRoute::kLoop ? 1 : 0;
      counts.hooks_coupled += route == JointRoute::kCoupled ? 1 : 0;
    }
  }
  counts.hooks_block = static_cast<std::uint32_t>(joints.balls.hook_of.size());
  const std::vector<std::uint32_t>& iterative = joints.iterative.hooks;
  counts.hooks_iterative =
      static_cast<std::uint32_t>(std::count_if(iterative.begin(), iterative.end(), is_solved));
  counts.hooks_coupled += static_cast<std::uint32_t>(joints.at_points.size());
}

void count_points(const state::Tables& tables, std::span<const RopeSystem> rope_systems,
                  RouteCounts& counts) {
  counts.points_swept = static_cast<std::uint32_t>(tables.contacts.count());
  for (const RopeSystem& rope : rope_systems) {
    const std::uint32_t count = rope.end_contact - rope.first_contact;
    HOOKE_ASSERT(rope.first_contact <= rope.end_contact && count <= counts.points_swept);
    (rope.in_coupled_group ? counts.points_coupled : counts.points_in_ropes) += count;
    counts.points_swept -= count;
  }
  const auto with_bodies = static_cast<std::uint32_t>(
      std::count(tables.contacts.coupled.begin(), tables.contacts.coupled.end(), std::uint8_t{1}));
  HOOKE_ASSERT(with_bodies <= counts.points_swept);
  counts.points_swept -= with_bodies;
  counts.points_coupled += with_bodies;
  for (const state::ElementContact& contact : tables.element_contacts)
    ++(is_coupled(tables, contact) ? counts.points_coupled : counts.points_swept);
  counts.points_coupled += static_cast<std::uint32_t>(tables.rope_contacts.size());
}

}  // namespace

void set_joint_routes(const Joints& joints, std::vector<Hook>& hooks) {
  for (Hook& hook : hooks) hook.route = hook.holds_point() ? JointRoute::kCoupled : JointRoute::kNone;
  for (const std::uint32_t row : joints.balls.hooks) hooks[row].route = JointRoute::kBlock;
  for (const std::uint32_t row : joints.iterative.hooks) hooks[row].route = JointRoute::kIterative;
}

void choose_joint_routes(const Joints& joints, std::vector<Hook>& hooks) {
  for (const std::uint32_t i : joints.order) {
    const JointRoute route = route_of(joints.articulations[i]);
    for (const Articulation::Joint& joint : joints.articulations[i].joints) {
      if (!joint.is_weld()) hooks[joint.hook].route = route;
    }
  }
}

RouteCounts choose_contact_routes(const LoadBearingInputs& inputs, std::span<const std::uint32_t> awake,
                                  std::vector<std::uint8_t>& body_marks, LoadBearingScratch& load_bearing,
                                  DirectIslands& direct, state::Tables& tables) {
  find_load_bearing_contacts(inputs, tables.bodies, tables.hooks, tables.pairs, load_bearing);
  couple_neighbors(inputs.joints, tables, body_marks);
  find_direct_islands(awake, inputs.step, {load_bearing.footing, body_marks, inputs.joints}, tables, direct);
  if (direct.has_coupled() || !tables.pairs.coupled.empty())
    list_coupled_manifolds(tables.pairs, load_bearing.manifolds);
  couple_articulations(inputs.joints, body_marks, tables);
  RouteCounts counts;
  for (Manifold& m : tables.pairs.manifold) {
    m.route = route_of(m, tables.bodies, direct);
    count_contact(m, counts);
  }
  return counts;
}

RouteCounts count_routes(const state::Tables& tables, const Joints& joints,
                         std::span<const RopeSystem> rope_systems, const CoupledGroups& groups,
                         const DirectIslands& direct, RouteCounts counts) {
  count_pairs(tables, counts);
  count_hooks(tables, joints, counts);
  count_points(tables, rope_systems, counts);
  for (const RopeSystem& rope : rope_systems)
    ++(rope.in_coupled_group ? counts.ropes_coupled : counts.ropes_alone);
  counts.direct_islands = static_cast<std::uint32_t>(direct.count);
  counts.coupled_groups = static_cast<std::uint32_t>(groups.count);
  counts.articulations = static_cast<std::uint32_t>(
      std::count_if(joints.order.begin(), joints.order.end(), [&](std::uint32_t i) {
        const std::vector<std::uint32_t>& members = joints.articulations[i].bodies;
        return std::any_of(members.begin(), members.end(),
                           [&](std::uint32_t body) { return gives_way(tables.bodies, body); });
      }));
  return counts;
}

}  // namespace hooke::solver
