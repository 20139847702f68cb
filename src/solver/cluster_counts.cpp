#include "solver/cluster_counts.h"

#include "solver/body/joint_body.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/soft/element_contact_solve.h"

#include <algorithm>

namespace hooke::solver {

namespace {

using state::ContactRoute;
using state::Hook;
using state::JointRoute;
using state::Manifold;

class Counter {
 public:
  Counter(const state::Tables& tables, const RefusedInputs& inputs) : t_(tables), inputs_(inputs) {}

  void count_direct(std::span<const RopeSystem> rope_systems, const DirectIslands& direct) {
    counts_.clusters += static_cast<std::uint32_t>(direct.count);
    for (int i = 0; i < direct.count; ++i) {
      counts_.rows_direct +=
          static_cast<std::uint32_t>(direct.islands[static_cast<std::size_t>(i)].rows.size());
    }
    for (const RopeSystem& rope : rope_systems) {
      if (!rope.in_coupled_group) add_cluster(rows_of(rope));
    }
    for (const CoupledGroup& group : inputs_.groups.live()) {
      std::size_t rows = group.first_row.back() + group.direct.rows.size();
      for (const std::uint32_t rope : group.rope_systems) rows += rows_of(rope_systems[rope]);
      add_cluster(rows);
    }
    for (const std::uint32_t i : inputs_.joints.order) count_articulation(inputs_.joints.articulations[i]);
  }

  void count_refused() {
    const state::Bodies& bodies = t_.bodies;
    const bool any = std::any_of(bodies.direct_state.begin(), bodies.direct_state.end(),
                                 [](std::int8_t state) { return state < kNotEvaluatedSteps; });
    if (any) {
      for (const Manifold& m : t_.pairs.manifold) {
        if (is_of_refused_island(m)) refuse(m);
      }
    }
    for (const std::uint32_t row : inputs_.manifolds) {
      const Manifold& m = t_.pairs.manifold[row];
      if (!is_of_refused_island(m)) refuse(m);
    }
    for (const std::vector<std::uint32_t>* rows :
         {&inputs_.joints.balls.hooks, &inputs_.joints.iterative.hooks}) {
      for (const std::uint32_t row : *rows) refuse(t_.hooks[row]);
    }
    for (const state::ElementContact& contact : t_.element_contacts) {
      const bool wanted = contact.joined && !contact.few && gives_way(t_.bodies, contact.body);
      if (wanted && !is_coupled(t_, contact)) refuse(CoupledContact::kRows, -contact.separation);
    }
    count_rope_contacts();
  }

  [[nodiscard]] const ClusterCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] static std::size_t rows_of(const RopeSystem& rope) {
    const std::size_t bends = rope.bend_stiffness > 0 && rope.node_count > 2 ? rope.node_count - 2 : 0;
    return 3 * (rope.node_count - 1 + bends);
  }

  void add_cluster(std::size_t rows) {
    ++counts_.clusters;
    counts_.rows_direct += static_cast<std::uint32_t>(rows);
  }

  void count_articulation(const Articulation& articulation) {
    std::size_t rows = 0;
    for (const Articulation::Joint& joint : articulation.joints) {
      if (joint.is_weld()) continue;
      const Hook& hook = t_.hooks[joint.hook];
      if (hook.route == JointRoute::kCoupled) return;  // Its coupled group is counted.
      if (is_awake(hook, t_.bodies)) rows += static_cast<std::size_t>(count_joint_rows(hook));
    }
    if (rows > 0) add_cluster(rows);
  }

  [[nodiscard]] bool is_of_refused_island(const Manifold& m) const {
    return is_refused(t_.bodies, m.body_a) || is_refused(t_.bodies, m.body_b);
  }

  void refuse(int rows, Real error) {
    counts_.rows_refused += static_cast<std::uint32_t>(rows);
    counts_.worst_error = std::max(counts_.worst_error, static_cast<double>(error));
  }

  /// How far a point of a body has moved in the step so far [m].
  [[nodiscard]] Vec3 displacement(std::uint32_t body, Vec3 anchor) const {
    const state::MotionRecord& m = t_.bodies.motion[body];
    if (!(m.inverse_mass > Real(0))) return m.dx;
    return m.dx + cross(t_.bodies.scale[body] * m.theta_scaled, anchor);
  }

  /// Contacts that went another way in the end, with what their bodies touch, are left out by no budget.
  void refuse(const Manifold& m) {
    if (m.route != ContactRoute::kSoft || m.point_count == 0) return;
    Real overlap = Real(0);
    for (std::int32_t k = 0; k < m.point_count; ++k) {
      const state::ContactPoint& p = m.point[static_cast<std::size_t>(k)];
      const Vec3 opening =
          m.is_refreshed() ? Vec3{} : displacement(m.body_b, p.anchor_b) - displacement(m.body_a, p.anchor_a);
      overlap = std::max(overlap, -(p.separation + dot(m.normal, opening)));
    }
    refuse(m.point_count + DirectContact::kFrictionRows, overlap);
  }

  void refuse(const Hook& hook) {
    if (!is_awake(hook, t_.bodies)) return;
    const double gap = joint_gap(hook, joint_end(t_, hook.a), joint_end(t_, hook.b));
    refuse(count_joint_rows(hook), static_cast<Real>(gap));
  }

  /// Coupled groups list those that they solve in ascending order.
  void count_rope_contacts() {
    const auto leaves_out = [](const CoupledGroup& group) { return group.refused > 0; };
    const std::span<const CoupledGroup> groups = inputs_.groups.live();
    if (std::none_of(groups.begin(), groups.end(), leaves_out)) return;
    const auto is_solved = [&](std::uint32_t row) {
      return std::any_of(groups.begin(), groups.end(), [row](const CoupledGroup& group) {
        return std::binary_search(group.rope_contacts.begin(), group.rope_contacts.end(), row);
      });
    };
    for (std::uint32_t row = 0; row < t_.rope_contacts.size(); ++row) {
      const state::RopeContact& contact = t_.rope_contacts[row];
      if (contact.joined && !is_solved(row)) refuse(CoupledContact::kRows, -contact.separation);
    }
  }

  const state::Tables& t_;
  const RefusedInputs& inputs_;
  ClusterCounts counts_;
};

}  // namespace

ClusterCounts count_clusters(const state::Tables& tables, std::span<const RopeSystem> rope_systems,
                             const DirectIslands& direct, const RefusedInputs& inputs) {
  Counter counter(tables, inputs);
  counter.count_direct(rope_systems, direct);
  counter.count_refused();
  return counter.counts();
}

}  // namespace hooke::solver
