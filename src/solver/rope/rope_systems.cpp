/// Ropes side by side, as many as a vector has lanes: load them, take Newton steps until each is as long as
/// its forces say, write them back. The steps themselves are in wide/rope_sweep.h. Read Group::solve first.

#include "solver/rope/rope_systems.h"

#include "solver/joint_rows/hook_rows.h"
#include "solver/rope/rope_kernels.h"
#include "solver/rope/rope_rows.h"
#include "solver/simd/lane_arrays.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace hooke::solver {

namespace {

using wide::RopeLanes;

constexpr int kFewestForLanes = 2;  ///< Below that one after another is faster.

struct Source {
  std::span<const RopeAnchor> anchors;
  const std::vector<state::VelocityLine>& before;
  double h;
  state::Tables& tables;
};

/// A ball hook at a node, as rows of a substep.
struct AnchorRows {
  std::uint32_t node = 0, hook = 0;
  double sign = 1;  ///< How the rows' speed goes with the node's: 1 as end b, -1 as a.
  std::array<JointRow, 3> rows = {};
  std::array<double, 3> gamma = {};  ///< Compliance of each.
};

/// Up to kCount ropes of equally many nodes, and what stays of them until a table's rows change. Lanes
/// without a rope repeat the first.
template <int kCount>
class Members {
 public:
  void load(const std::vector<Chain*>& chains, const Source& source) {
    const std::uint64_t revision = source.tables.revision + source.tables.hook_revision;
    if (chains_ == chains && revision_ == revision && h_ == source.h) return;
    chains_ = chains;
    revision_ = revision;
    h_ = source.h;
    const Chain& first = *chains.front();
    const std::size_t nodes = first.node_count;
    traits_.rows.resize(nodes);
    traits_.bends.resize(first.bend_stiffness > 0 && nodes > 2 ? nodes - 2 : 0);
    traits_.pinned.assign(nodes, 0);
    traits_.limits = false;
    for (int lane = 0; lane < kCount; ++lane) load_lane(chain(lane), lane, source);
  }

  [[nodiscard]] int count() const { return static_cast<int>(chains_.size()); }
  [[nodiscard]] Chain& chain(int lane) const { return *chains_[lane < count() ? lane : 0]; }
  [[nodiscard]] const wide::RopeTraits<kCount>& traits() const { return traits_; }

 private:
  void load_lane(const Chain& chain, int lane, const Source& source) {
    for (std::uint32_t i = 0; i < chain.node_count; ++i) {
      const std::uint32_t row = chain.first_particle + i;
      const auto w = static_cast<double>(source.tables.particles.velocity[row].inverse_mass);
      traits_.rows[i].mass[lane] = static_cast<double>(source.tables.particles.mass[row]);
      traits_.rows[i].w[lane] = w;
      if (!(w > 0)) traits_.pinned[i] = 1;
    }
    traits_.length[lane] = 0;
    for (std::uint32_t i = 0; i + 1 < chain.node_count; ++i) load_segment(chain, i, lane, source);
    for (std::uint32_t i = 0; i < traits_.bends.size(); ++i) load_bend_at(chain, i, lane, source);
  }

  void load_segment(const Chain& chain, std::uint32_t i, int lane, const Source& source) {
    wide::RopeTraitLanes<kCount>& to = traits_.rows[i];
    const wide::RopeTraitLanes<kCount>& next = traits_.rows[i + 1];
    const double lighter = lighter_end(to.mass[lane], to.w[lane], next.mass[lane], next.w[lane]);
    const wide::SegmentTraits<double> traits =
        segment_traits(chain.first_segment + i, lighter, source.h, source.tables.segments);
    to.rest[lane] = traits.rest;
    to.per_rest[lane] = traits.per_rest;
    to.limit[lane] = traits.limit;
    to.damping[lane] = traits.damping;
    to.per_stiffness[lane] = traits.per_stiffness;
    to.bias[lane] = traits.bias;
    to.grip[lane] = traits.grip;
    to.lighter[lane] = traits.lighter;
    to.per_lighter[lane] = traits.per_lighter;
    traits_.length[lane] += traits.rest;
    traits_.limits = traits_.limits || traits.limit < std::numeric_limits<double>::infinity();
  }

  void load_bend_at(const Chain& chain, std::uint32_t i, int lane, const Source& source) {
    const double h = source.h;
    const RopeBend bend = load_bend(chain, chain.first_segment + i, source.tables.segments);
    wide::RopeBendLanes<kCount>& to = traits_.bends[i];
    to.before[lane] = bend.before;
    to.behind[lane] = bend.behind;
    to.pull[lane] = -h * bend.stiffness;
    to.grip[lane] = h * bend.grip(h, false);
    to.whipping_grip[lane] = h * bend.grip(h, true);
    to.back[lane] = kBendNewmark * h;
  }

  std::vector<Chain*> chains_;
  std::uint64_t revision_ = 0;  ///< Sum of both, which only grow; clamps are of hooks too.
  double h_ = 0;
  wide::RopeTraits<kCount> traits_;
};

/// The solution of members.
template <int kCount>
class Group {
 public:
  void solve(const Members<kCount>& members, const Source& source) {
    resize(members.traits());
    load(members, source);
    bool done[kCount] = {};
    for (int solves = 1;; ++solves) {
      hold(source.h);
      wide::solve_ropes(source.h, members.traits(), ropes_);
      bool chosen[kCount] = {};
      bool all_done = true;
      for (int lane = 0; lane < members.count(); ++lane) {
        if (done[lane]) continue;
        ++members.chain(lane).solves;
        done[lane] = settle(members.traits(), lane, solves, source.h);
        chosen[lane] = done[lane] && is_finite(lane);
        if (done[lane]) note_error(lane, members.chain(lane));
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
    ropes_.holds.resize(nodes);
    ropes_.held.assign(nodes, 0);
  }

  void load(const Members<kCount>& members, const Source& source) {
    wide::load_ropes(places_of(members, source), ropes_);
    if (members.traits().limits) load_limited(members, source.tables.segments);
    for (int lane = 0; lane < kCount; ++lane) {
      touches_[lane].clear();
      anchors_[lane].clear();
      if (lane < members.count()) load_ties(members, lane, source);
      begin(members.chain(lane), members.traits().length[lane], lane, source);
    }
  }

  void load_limited(const Members<kCount>& members, const state::Segments& segments) {
    for (int lane = 0; lane < kCount; ++lane) {
      const std::uint8_t* limited = &segments.limited[members.chain(lane).first_segment];
      for (std::size_t i = 0; i < ropes_.segments.size(); ++i) ropes_.segments[i].limited[lane] = limited[i];
    }
  }

  static wide::RopePlaces<kCount> places_of(const Members<kCount>& members, const Source& source) {
    static_assert(sizeof(state::PositionLine) == 4 * sizeof(Real));
    static_assert(sizeof(state::VelocityLine) == 4 * sizeof(Real));
    wide::RopePlaces<kCount> places = {
        .first_particle = {},
        .first_segment = {},
        .position = reinterpret_cast<const Real*>(source.tables.particles.position.data()),
        .before = reinterpret_cast<const Real*>(source.before.data()),
        .velocity = reinterpret_cast<Real*>(source.tables.particles.velocity.data()),
        .tension = source.tables.segments.tension.data(),
        .mean_tension = source.tables.segments.mean_tension.data()};
    for (int lane = 0; lane < kCount; ++lane) {
      places.first_particle[lane] = members.chain(lane).first_particle;
      places.first_segment[lane] = members.chain(lane).first_segment;
    }
    return places;
  }

  void load_ties(const Members<kCount>& members, int lane, const Source& source) {
    const Chain& chain = members.chain(lane);
    load_touches(chain, 0, source.h, source.tables, touches_[lane]);
    for (std::uint32_t i = chain.first_anchor; i < chain.end_anchor; ++i)
      load_anchor(source.anchors[i], members.traits().rows[source.anchors[i].node].w[lane], lane, source);
  }

  /// How the first step is linearized.
  void begin(const Chain& chain, double rest, int lane, const Source& source) {
    const std::size_t first = chain.first_particle;
    const std::size_t last = first + chain.node_count - 1;
    const std::vector<state::PositionLine>& position = source.tables.particles.position;
    const DVec3 line = vector_cast<double>(position[last].x) - vector_cast<double>(position[first].x);
    const DVec3 speed =
        vector_cast<double>(source.before[last].v) - vector_cast<double>(source.before[first].v);
    const RopeSetting setting = first_setting(touches_[lane], rest, line, speed);
    ropes_.compliance[lane] = setting.compliance;
    ropes_.first[lane] = 1;
    put(setting.turning, ropes_.turning, lane);
  }

  /// `w` is the inverse mass of its node.
  void load_anchor(const RopeAnchor& anchor, double w, int lane, const Source& source) {
    if (!(w > 0)) return;
    state::Hook& hook = source.tables.hooks[anchor.hook];
    std::array<JointRow, state::Hook::kMaxRows> rows;
    make_rows(hook, joint_end(source.tables, hook.a), joint_end(source.tables, hook.b), anchor.node_is_b,
              !anchor.node_is_b, source.h, rows);
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

  /// Node i of a lane as the functions of contacts take it.
  [[nodiscard]] RopeNode node_at(const wide::RopeTraits<kCount>& traits, std::uint32_t i, int lane) const {
    RopeNode one;
    one.v_free = get(ropes_.nodes[i].v_free, lane);
    one.mass = traits.rows[i].mass[lane];
    one.u = get(ropes_.nodes[i].u, lane);
    return one;
  }

  void hold(double h) {
    std::fill(ropes_.held.begin(), ropes_.held.end(), 0);
    for (int lane = 0; lane < kCount; ++lane) {
      for_each_touched(touches_[lane], [&](std::span<const RopeTouch> at_node) {
        const std::uint32_t i = at_node.front().node;
        note_held(i);
        put_hold(hold_of(at_node, {}, h), i, lane);
      });
    }
    for (int lane = 0; lane < kCount; ++lane) {
      for (const AnchorRows& anchor : anchors_[lane]) {
        note_held(anchor.node);
        NodeHold hold = hold_at(anchor.node, lane);
        for (int k = 0; k < 3; ++k) {
          const double grip = 1 / anchor.gamma[k];
          hold.mass = hold.mass + math::axial(anchor.rows[k].n, grip, 0.0);
          hold.impulse += (grip * anchor.sign * anchor.rows[k].target) * anchor.rows[k].n;
        }
        put_hold(hold, anchor.node, lane);
      }
    }
  }

  /// From now on `holds` counts for a node; nothing touches it yet. A sum with -0 is what it was to the bit,
  /// so that no lane feels what touches another.
  void note_held(std::uint32_t i) {
    if (ropes_.held[i] != 0) return;
    ropes_.held[i] = 1;
    constexpr NodeHold kNothing = {{-0.0, -0.0, -0.0, -0.0, -0.0, -0.0}, {-0.0, -0.0, -0.0}};
    for (int k = 0; k < kCount; ++k) put_hold(kNothing, i, k);
  }

  [[nodiscard]] NodeHold hold_at(std::uint32_t i, int lane) const {
    const auto& m = ropes_.holds[i].mass;
    return {{m[0][lane], m[1][lane], m[2][lane], m[3][lane], m[4][lane], m[5][lane]},
            get(ropes_.holds[i].impulse, lane)};
  }

  void put_hold(const NodeHold& hold, std::uint32_t i, int lane) {
    wide::RopeHoldLanes<kCount>& to = ropes_.holds[i];
    const math::Symmetric3<double>& m = hold.mass;
    const std::array<double, 6> entries = {m.xx, m.xy, m.xz, m.yy, m.yz, m.zz};
    for (int k = 0; k < 6; ++k) to.mass[k][lane] = entries[k];
    put(hold.impulse, to.impulse, lane);
  }

  /// Whether a lane needs no further step.
  bool settle(const wide::RopeTraits<kCount>& traits, int lane, int solves, double h) {
    if (!is_finite(lane)) return true;
    Unsettled unsettled;
    for (RopeTouch& t : touches_[lane])
      unsettled.add(update_touch(h, lets_go(solves), node_at(traits, t.node, lane), t));
    const bool long_enough = ropes_.error[lane] <= kLengthTolerance && !(ropes_.limits_changed[lane] > 0);
    if (long_enough && solves >= least_solves(touches_[lane], unsettled)) return true;
    if (!long_enough) ropes_.first[lane] = 0;
    return !solve_again(solves, ropes_.error[lane], unsettled.pulls, touches_[lane]);
  }

  [[nodiscard]] bool is_finite(int lane) const { return ropes_.finite[lane] == 0; }

  void note_error(int lane, Chain& chain) const {
    chain.unconverged = chain.unconverged || !(ropes_.error[lane] <= kReportedError) || !is_finite(lane);
  }

  void store(const Members<kCount>& members, const bool (&chosen)[kCount], const Source& source) {
    wide::store_ropes(source.h, places_of(members, source), members.traits(), chosen, ropes_);
    for (int lane = 0; lane < members.count(); ++lane) {
      if (!chosen[lane]) continue;
      if (members.traits().limits) store_limited(members.chain(lane), lane, source.tables.segments);
      store_touches(source.h, touches_[lane], source.tables.contacts);
      for (const AnchorRows& anchor : anchors_[lane]) store_anchor(anchor, lane, source);
    }
  }

  void store_limited(const Chain& chain, int lane, state::Segments& segments) const {
    std::uint8_t* limited = &segments.limited[chain.first_segment];
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
  std::array<std::vector<RopeTouch>, kCount> touches_;
  std::array<std::vector<AnchorRows>, kCount> anchors_;
};

bool fits(const Chain& a, const Chain& b) {
  return a.node_count == b.node_count && (a.bend_stiffness > 0) == (b.bend_stiffness > 0);
}

/// Ropes solved in one way, group after group.
template <int kCount>
struct GroupList {
  Group<kCount> group;  ///< Memory of the one that is being solved.
  std::vector<Members<kCount>> members;
  std::size_t used = 0;  ///< In this substep.

  void solve(const std::vector<Chain*>& chains, const Source& source) {
    if (used == members.size()) members.emplace_back();
    members[used].load(chains, source);
    group.solve(members[used++], source);
  }
};

}  // namespace

struct ChainScratch::Groups {
  GroupList<wide::kRopeLanes> together;
  GroupList<1> alone;
  std::vector<Chain*> next;
};

ChainScratch::ChainScratch() : groups_(std::make_unique<Groups>()) {}
ChainScratch::~ChainScratch() = default;
ChainScratch::ChainScratch(ChainScratch&&) noexcept = default;
ChainScratch& ChainScratch::operator=(ChainScratch&&) noexcept = default;

void solve_chains(std::span<Chain> chains, std::span<const RopeAnchor> anchors,
                  const std::vector<state::VelocityLine>& before, Real h, ChainScratch& scratch,
                  state::Tables& tables) {
  ChainScratch::Groups& groups = scratch.groups();
  std::vector<Chain*>& next = groups.next;
  const Source source = {anchors, before, static_cast<double>(h), tables};
  groups.together.used = groups.alone.used = 0;
  const auto finish = [&] {
    if (next.size() >= kFewestForLanes) {
      groups.together.solve(next, source);
    } else if (!next.empty()) {
      groups.alone.solve(next, source);
    }
    next.clear();
  };
  for (Chain& chain : chains) {
    if (chain.in_bundle) continue;
    if (next.size() == wide::kRopeLanes || (!next.empty() && !fits(*next.front(), chain))) finish();
    next.push_back(&chain);
  }
  finish();
}

}  // namespace hooke::solver
