/// Solves ropes side by side, as many as a vector has lanes: loads them, takes Newton steps until each is as
/// long as its forces say, and writes them back. The steps themselves are in solver/rope/rope_sweep.h. Read
/// Group::solve first.

#include "solver/rope/rope_systems.h"

#include "base/assert.h"
#include "solver/joint_rows/hook_rows.h"
#include "solver/rope/rope_kernels.h"
#include "solver/rope/rope_rows.h"
#include "solver/rope/rope_tuning.h"
#include "solver/simd/lane_arrays.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace hooke::solver {

namespace {

using wide::RopeLanes;

struct Source {
  std::span<const RopeAnchor> anchors;
  const std::vector<state::VelocityRecord>& before;
  double h;
  SurfaceContacts& surfaces;
  state::Tables& tables;
};

/// A ball hook at a node, as rows of a substep.
struct AnchorRows {
  std::uint32_t node = 0, hook = 0;
  double sign = 1;  ///< Sign of the node's speed in the rows: 1 as end b, -1 as a.
  std::array<JointRow, 3> rows = {};
  std::array<double, 3> gamma = {};  ///< Compliance of each row.
};

/// Up to kCount ropes of equally many nodes, and their constants, which hold until a table's rows change.
/// Lanes without a rope repeat the first.
template <int kCount>
class Members {
 public:
  void load(const std::vector<RopeSystem*>& rope_systems, const Source& source) {
    const std::uint64_t revision = source.tables.revision + source.tables.hook_revision;
    if (rope_systems_ == rope_systems && revision_ == revision && h_ == source.h) return;
    rope_systems_ = rope_systems;
    revision_ = revision;
    h_ = source.h;
    const RopeSystem& first = *rope_systems.front();
    HOOKE_ASSERT(std::all_of(rope_systems.begin(), rope_systems.end(), [&](const RopeSystem* rope_system) {
      return rope_system->node_count == first.node_count && !rope_system->in_coupled_group;
    }));
    const std::size_t nodes = first.node_count;
    traits_.rows.resize(nodes);
    traits_.bends.resize(first.bend_stiffness > 0 && nodes > 2 ? nodes - 2 : 0);
    traits_.pinned.assign(nodes, 0);
    traits_.limits = false;
    for (int lane = 0; lane < kCount; ++lane) load_lane(rope_system(lane), lane, source);
  }

  [[nodiscard]] int count() const { return static_cast<int>(rope_systems_.size()); }
  [[nodiscard]] RopeSystem& rope_system(int lane) const { return *rope_systems_[lane < count() ? lane : 0]; }
  [[nodiscard]] const wide::RopeTraits<kCount>& traits() const { return traits_; }

 private:
  void load_lane(const RopeSystem& rope_system, int lane, const Source& source) {
    for (std::uint32_t i = 0; i < rope_system.node_count; ++i) {
      const std::uint32_t row = rope_system.first_particle + i;
      const auto w = static_cast<double>(source.tables.particles.velocity[row].inverse_mass);
      traits_.rows[i].mass[lane] = static_cast<double>(source.tables.particles.mass[row]);
      traits_.rows[i].w[lane] = w;
      if (!(w > 0)) traits_.pinned[i] = 1;
    }
    traits_.length[lane] = 0;
    for (std::uint32_t i = 0; i + 1 < rope_system.node_count; ++i) load_segment(rope_system, i, lane, source);
    for (std::uint32_t i = 0; i < traits_.bends.size(); ++i) load_bend_at(rope_system, i, lane, source);
  }

  void load_segment(const RopeSystem& rope_system, std::uint32_t i, int lane, const Source& source) {
    wide::RopeTraitLanes<kCount>& to = traits_.rows[i];
    const wide::RopeTraitLanes<kCount>& next = traits_.rows[i + 1];
    const double lighter = lighter_end(to.mass[lane], to.w[lane], next.mass[lane], next.w[lane]);
    const wide::SegmentTraits<double> traits =
        segment_traits(rope_system.first_segment + i, lighter, source.h, source.tables.segments);
    to.rest[lane] = traits.rest;
    to.per_rest[lane] = traits.per_rest;
    to.limit[lane] = traits.limit;
    to.damping[lane] = traits.damping;
    to.per_stiffness[lane] = traits.per_stiffness;
    to.bias[lane] = traits.bias;
    to.resistance[lane] = traits.resistance;
    to.lighter[lane] = traits.lighter;
    to.per_lighter[lane] = traits.per_lighter;
    traits_.length[lane] += traits.rest;
    traits_.limits = traits_.limits || traits.limit < std::numeric_limits<double>::infinity();
  }

  void load_bend_at(const RopeSystem& rope_system, std::uint32_t i, int lane, const Source& source) {
    const double h = source.h;
    const RopeBend bend = load_bend(rope_system, rope_system.first_segment + i, source.tables.segments);
    wide::RopeBendLanes<kCount>& to = traits_.bends[i];
    to.before[lane] = bend.before;
    to.behind[lane] = bend.behind;
    to.pull[lane] = -h * bend.stiffness;
    to.resistance[lane] = h * bend.resistance(h, false);
    to.whipping_resistance[lane] = h * bend.resistance(h, true);
    to.back[lane] = kBendNewmark * h;
  }

  std::vector<RopeSystem*> rope_systems_;
  std::uint64_t revision_ = 0;  ///< Sum of both revisions, which only grow; clamps depend on hooks too.
  double h_ = 0;
  wide::RopeTraits<kCount> traits_;
};

/// Solves the ropes of one Members.
template <int kCount>
class Group {
 public:
  void solve(const Members<kCount>& members, const Source& source) {
    resize(members.traits());
    load(members, source);
    bool done[kCount] = {};
    for (int solves = 1;; ++solves) {
      constraint(source.h);
      wide::solve_ropes(source.h, members.traits(), ropes_);
      bool chosen[kCount] = {};
      bool all_done = true;
      for (int lane = 0; lane < members.count(); ++lane) {
        if (done[lane]) continue;
        ++members.rope_system(lane).solves;
        done[lane] = converge(members.traits(), lane, solves, source.h);
        chosen[lane] = done[lane] && is_finite(lane);
        if (done[lane]) note_error(lane, members.rope_system(lane));
        all_done = all_done && done[lane];
      }
      store(members, chosen, source);
      if (all_done) return;
    }
  }

 private:
  void resize(const wide::RopeTraits<kCount>& traits) {
    const std::size_t nodes = traits.rows.size();
    ropes_.nodes.resize(nodes);
    ropes_.segments.resize(nodes - 1);
    ropes_.fills.resize(traits.bends.empty() ? 0 : nodes - 1);
    ropes_.constraints.resize(nodes);
    ropes_.constrained.assign(nodes, 0);
  }

  void load(const Members<kCount>& members, const Source& source) {
    wide::load_ropes(locations_of(members, source), ropes_);
    if (members.traits().limits) load_limited(members, source.tables.segments);
    for (int lane = 0; lane < kCount; ++lane) {
      contact_rows_[lane].clear();
      anchors_[lane].clear();
      if (lane < members.count()) load_contacts_and_anchors(members, lane, source);
      begin(members.rope_system(lane), members.traits().length[lane], lane, source);
    }
  }

  void load_limited(const Members<kCount>& members, const state::Segments& segments) {
    for (int lane = 0; lane < kCount; ++lane) {
      const std::uint8_t* limited = &segments.limited[members.rope_system(lane).first_segment];
      for (std::size_t i = 0; i < ropes_.segments.size(); ++i) ropes_.segments[i].limited[lane] = limited[i];
    }
  }

  static wide::RopeLocations<kCount> locations_of(const Members<kCount>& members, const Source& source) {
    static_assert(sizeof(state::PositionRecord) == 4 * sizeof(Real));
    static_assert(sizeof(state::VelocityRecord) == 4 * sizeof(Real));
    wide::RopeLocations<kCount> locations = {
        .first_particle = {},
        .first_segment = {},
        .position = reinterpret_cast<const Real*>(source.tables.particles.position.data()),
        .before = reinterpret_cast<const Real*>(source.before.data()),
        .velocity = reinterpret_cast<Real*>(source.tables.particles.velocity.data()),
        .tension = source.tables.segments.tension.data(),
        .mean_tension = source.tables.segments.mean_tension.data()};
    for (int lane = 0; lane < kCount; ++lane) {
      locations.first_particle[lane] = members.rope_system(lane).first_particle;
      locations.first_segment[lane] = members.rope_system(lane).first_segment;
    }
    return locations;
  }

  void load_contacts_and_anchors(const Members<kCount>& members, int lane, const Source& source) {
    const RopeSystem& rope_system = members.rope_system(lane);
    HOOKE_ASSERT(rope_system.first_anchor <= rope_system.end_anchor &&
                 rope_system.end_anchor <= source.anchors.size());
    load_contact_rows(rope_system, 0, source.h, source.tables, contact_rows_[lane]);
    load_loads(rope_system, 0, source.h, source.surfaces, source.tables, contact_rows_[lane]);
    for (std::uint32_t i = rope_system.first_anchor; i < rope_system.end_anchor; ++i)
      load_anchor(source.anchors[i], members.traits().rows[source.anchors[i].node].w[lane], lane, source);
  }

  /// Chooses how the first step is linearized.
  void begin(const RopeSystem& rope_system, double rest, int lane, const Source& source) {
    const std::size_t first = rope_system.first_particle;
    const std::size_t last = first + rope_system.node_count - 1;
    const std::vector<state::PositionRecord>& position = source.tables.particles.position;
    const DVec3 line = vector_cast<double>(position[last].x) - vector_cast<double>(position[first].x);
    const DVec3 speed =
        vector_cast<double>(source.before[last].v) - vector_cast<double>(source.before[first].v);
    const RopeSetting setting = first_setting(contact_rows_[lane], rest, line, speed);
    ropes_.compliance[lane] = setting.compliance;
    ropes_.first[lane] = 1;
    put(setting.turning, ropes_.turning, lane);
  }

  /// `w` is the inverse mass of the anchor's node.
  void load_anchor(const RopeAnchor& anchor, double w, int lane, const Source& source) {
    if (!(w > 0)) return;
    state::Hook& hook = source.tables.hooks[anchor.hook];
    HOOKE_ASSERT(count_joint_rows(hook) == 3 && anchor.node < ropes_.nodes.size());
    std::array<JointRow, state::Hook::kMaxRows> rows;
    make_rows(hook, {joint_end(source.tables, hook.a), anchor.node_is_b},
              {joint_end(source.tables, hook.b), !anchor.node_is_b}, source.h, rows);
    AnchorRows made;
    made.node = anchor.node;
    made.hook = anchor.hook;
    made.sign = anchor.node_is_b ? 1 : -1;
    for (int k = 0; k < 3; ++k) {
      made.rows[k] = rows[k];
      made.gamma[k] = rows[k].gamma + kHookCompliance * w;
    }
    anchors_[lane].push_back(made);
  }

  /// Node i of a lane in the form that the functions of contacts take.
  [[nodiscard]] RopeNode node_at(const wide::RopeTraits<kCount>& traits, std::uint32_t i, int lane) const {
    RopeNode one;
    one.v_free = get(ropes_.nodes[i].v_free, lane);
    one.mass = traits.rows[i].mass[lane];
    one.u = get(ropes_.nodes[i].u, lane);
    return one;
  }

  void constraint(double h) {
    std::fill(ropes_.constrained.begin(), ropes_.constrained.end(), 0);
    for (int lane = 0; lane < kCount; ++lane) {
      for_each_node_in_contact(contact_rows_[lane], [&](std::span<const RopeContactRow> at_node) {
        const std::uint32_t i = at_node.front().node;
        note_constrained(i);
        put_constraint(node_constraint(at_node, {}, h), i, lane);
      });
    }
    for (int lane = 0; lane < kCount; ++lane) {
      for (const AnchorRows& anchor : anchors_[lane]) {
        note_constrained(anchor.node);
        NodeConstraint constraint = constraint_at(anchor.node, lane);
        for (int k = 0; k < 3; ++k) {
          const double resistance = 1 / anchor.gamma[k];
          constraint.mass = constraint.mass + math::axial(anchor.rows[k].n, resistance, 0.0);
          constraint.impulse += (resistance * anchor.sign * anchor.rows[k].target) * anchor.rows[k].n;
        }
        put_constraint(constraint, anchor.node, lane);
      }
    }
  }

  /// From now on `constraints` counts for a node, still without any. A sum with -0 keeps its bits, so that
  /// no lane depends on contacts of another.
  void note_constrained(std::uint32_t i) {
    if (ropes_.constrained[i] != 0) return;
    ropes_.constrained[i] = 1;
    constexpr NodeConstraint kNothing = {{-0.0, -0.0, -0.0, -0.0, -0.0, -0.0}, {-0.0, -0.0, -0.0}};
    for (int k = 0; k < kCount; ++k) put_constraint(kNothing, i, k);
  }

  [[nodiscard]] NodeConstraint constraint_at(std::uint32_t i, int lane) const {
    const auto& m = ropes_.constraints[i].mass;
    return {{m[0][lane], m[1][lane], m[2][lane], m[3][lane], m[4][lane], m[5][lane]},
            get(ropes_.constraints[i].impulse, lane)};
  }

  void put_constraint(const NodeConstraint& constraint, std::uint32_t i, int lane) {
    wide::NodeConstraintLanes<kCount>& to = ropes_.constraints[i];
    const math::Symmetric3<double>& m = constraint.mass;
    const std::array<double, 6> entries = {m.xx, m.xy, m.xz, m.yy, m.yz, m.zz};
    for (int k = 0; k < 6; ++k) to.mass[k][lane] = entries[k];
    put(constraint.impulse, to.impulse, lane);
  }

  /// Whether a lane needs no further step.
  bool converge(const wide::RopeTraits<kCount>& traits, int lane, int solves, double h) {
    if (!is_finite(lane)) return true;
    Unconverged unconverged;
    for (RopeContactRow& t : contact_rows_[lane]) {
      const RopeNode node = node_at(traits, t.node, lane);
      if (t.is_load()) {
        unconverged.ropes = update_load(h, node.u, t) || unconverged.ropes;
      } else {
        unconverged.add(update_contact_row(h, lets_go(solves), node, t));
      }
    }
    const bool long_enough = ropes_.error[lane] <= kRopeLengthTolerance && !(ropes_.limits_changed[lane] > 0);
    if (long_enough && solves >= least_solves(contact_rows_[lane], unconverged)) return true;
    if (!long_enough) ropes_.first[lane] = 0;
    return !solve_again(solves, ropes_.error[lane], unconverged.pulls, contact_rows_[lane]);
  }

  [[nodiscard]] bool is_finite(int lane) const { return ropes_.finite[lane] == 0; }

  void note_error(int lane, RopeSystem& rope_system) const {
    rope_system.unconverged =
        rope_system.unconverged || !(ropes_.error[lane] <= kRopeReportedError) || !is_finite(lane);
  }

  void store(const Members<kCount>& members, const bool (&chosen)[kCount], const Source& source) {
    wide::store_ropes(source.h, locations_of(members, source), members.traits(), chosen, ropes_);
    for (int lane = 0; lane < members.count(); ++lane) {
      if (!chosen[lane]) continue;
      if (members.traits().limits) store_limited(members.rope_system(lane), lane, source.tables.segments);
      store_contact_rows(source.h, contact_rows_[lane], source.tables.contacts);
      store_loads(contact_rows_[lane], source.surfaces);
      for (const AnchorRows& anchor : anchors_[lane]) store_anchor(anchor, lane, source);
    }
  }

  void store_limited(const RopeSystem& rope_system, int lane, state::Segments& segments) const {
    std::uint8_t* limited = &segments.limited[rope_system.first_segment];
    for (std::size_t i = 0; i < ropes_.segments.size(); ++i)
      limited[i] = ropes_.segments[i].limited[lane] > 0 ? 1 : 0;
  }

  void store_anchor(const AnchorRows& anchor, int lane, const Source& source) const {
    const DVec3 u = get(ropes_.nodes[anchor.node].u, lane);
    std::array<double, 3> lambda;
    for (int k = 0; k < 3; ++k) {
      const JointRow& row = anchor.rows[k];
      lambda[k] = (row.target - anchor.sign * dot(row.n, u)) / anchor.gamma[k];
    }
    state::Hook& hook = source.tables.hooks[anchor.hook];
    store_joint_impulses(anchor.rows, lambda, hook);
    add_up_impulses(static_cast<Real>(source.h), hook);
  }

  RopeLanes<kCount> ropes_;
  std::array<std::vector<RopeContactRow>, kCount> contact_rows_;
  std::array<std::vector<AnchorRows>, kCount> anchors_;
};

bool fits(const RopeSystem& a, const RopeSystem& b) {
  return a.node_count == b.node_count && (a.bend_stiffness > 0) == (b.bend_stiffness > 0);
}

/// Ropes that are solved in one way, group after group.
template <int kCount>
struct GroupList {
  Group<kCount> group;  ///< Memory of the group that is being solved.
  std::vector<Members<kCount>> members;
  std::size_t used = 0;  ///< Number of `members` in this substep.

  void solve(const std::vector<RopeSystem*>& rope_systems, const Source& source) {
    if (used == members.size()) members.emplace_back();
    members[used].load(rope_systems, source);
    group.solve(members[used++], source);
  }
};

}  // namespace

struct RopeSystemScratch::Groups {
  GroupList<wide::kRopeLanes> together;
  GroupList<1> alone;
  std::vector<RopeSystem*> next;
};

RopeSystemScratch::RopeSystemScratch() : groups_(std::make_unique<Groups>()) {}
RopeSystemScratch::~RopeSystemScratch() = default;
RopeSystemScratch::RopeSystemScratch(RopeSystemScratch&&) noexcept = default;
RopeSystemScratch& RopeSystemScratch::operator=(RopeSystemScratch&&) noexcept = default;

void solve_rope_systems(std::span<RopeSystem> rope_systems, std::span<const RopeAnchor> anchors,
                        const RopeSubstep& substep, RopeSystemScratch& scratch, state::Tables& tables) {
  RopeSystemScratch::Groups& groups = scratch.groups();
  std::vector<RopeSystem*>& next = groups.next;
  const Source source = {anchors, substep.before, static_cast<double>(substep.h), substep.surfaces, tables};
  groups.together.used = groups.alone.used = 0;
  next.clear();  // a solution that ran out of memory has left ropes here
  const auto finish = [&] {
    if (next.size() >= kFewestRopesForLanes) {
      groups.together.solve(next, source);
    } else if (!next.empty()) {
      groups.alone.solve(next, source);
    }
    next.clear();
  };
  for (RopeSystem& rope_system : rope_systems) {
    if (rope_system.in_coupled_group) continue;
    if (next.size() == wide::kRopeLanes || (!next.empty() && !fits(*next.front(), rope_system))) finish();
    next.push_back(&rope_system);
  }
  finish();
}

}  // namespace hooke::solver
