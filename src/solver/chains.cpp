/// Ropes side by side, as many as a vector has lanes: load them, take Newton steps until each is as long as
/// its forces say, write them back. The steps themselves are in wide/rope_sweep.h. Read Group::solve first.

#include "solver/chains.h"

#include "solver/bundles.h"
#include "solver/lanes.h"
#include "solver/rope_rows.h"
#include "solver/wide/ropes.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hooke::solver {

namespace {

using wide::RopeLanes;

constexpr int kFewestForLanes = 2;  ///< Below that one after another is faster.

struct Source {
  std::span<const RopeAnchor> anchors;
  const std::vector<Vec3>& before;
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

/// Up to kCount ropes of equally many nodes. Lanes without one repeat the first.
template <int kCount>
class Group {
 public:
  void solve(const std::vector<Chain*>& chains, const Source& source) {
    const int count = static_cast<int>(chains.size());
    resize(*chains.front());
    load(chains, source);
    std::array<bool, kCount> done = {};
    for (int solves = 1;; ++solves) {
      hold(source.h);
      wide::solve_ropes(source.h, ropes_);
      bool all_done = true;
      for (int lane = 0; lane < count; ++lane) {
        if (done[lane]) continue;
        ++chains[lane]->solves;
        done[lane] = settle(lane, solves, source.h);
        if (done[lane]) store(*chains[lane], lane, source);
        all_done = all_done && done[lane];
      }
      if (all_done) return;
    }
  }

 private:
  void resize(const Chain& chain) {
    const std::size_t nodes = chain.node_count;
    ropes_.nodes.resize(nodes);
    ropes_.segments.resize(nodes - 1);
    ropes_.bends.resize(chain.bend_stiffness > 0 && nodes > 2 ? nodes - 2 : 0);
    ropes_.holds.resize(nodes);
    ropes_.held.assign(nodes, 0);
  }

  /// Node after node, so that a line of lanes is written while it is in the cache.
  void load(const std::vector<Chain*>& chains, const Source& source) {
    std::array<const Chain*, kCount> chain;
    for (int lane = 0; lane < kCount; ++lane)
      chain[lane] = chains[static_cast<std::size_t>(lane) < chains.size() ? lane : 0];
    std::array<double, kCount> rest = {};
    for (std::uint32_t i = 0; i < ropes_.nodes.size(); ++i) {
      for (int lane = 0; lane < kCount; ++lane) load_node_at(*chain[lane], i, lane, source);
      for (int lane = 0; i > 0 && lane < kCount; ++lane)
        rest[lane] += load_between(*chain[lane], i - 1, lane, source);
    }
    for (std::uint32_t i = 0; i < ropes_.bends.size(); ++i) {
      for (int lane = 0; lane < kCount; ++lane) load_bend_at(*chain[lane], i, lane, source);
    }
    for (int lane = 0; lane < kCount; ++lane) {
      touches_[lane].clear();
      anchors_[lane].clear();
      if (static_cast<std::size_t>(lane) < chains.size()) load_ties(*chain[lane], lane, source);
      begin(rest[lane], lane);
    }
  }

  void load_node_at(const Chain& chain, std::uint32_t i, int lane, const Source& source) {
    const std::uint32_t row = chain.first_particle + i;
    const RopeNode node = load_node(row, source.before[row], source.tables.particles);
    wide::RopeNodeLanes<kCount>& to = ropes_.nodes[i];
    put(node.x, to.x, lane);
    put(node.v_free, to.v_free, lane);
    put(node.v_before, to.v_before, lane);
    to.mass[lane] = node.mass;
    to.w[lane] = node.w;
  }

  void load_ties(const Chain& chain, int lane, const Source& source) {
    load_touches(chain, 0, source.h, source.tables, touches_[lane]);
    for (std::uint32_t i = chain.first_anchor; i < chain.end_anchor; ++i)
      load_anchor(source.anchors[i], lane, source);
  }

  /// How the first step is linearized.
  void begin(double rest, int lane) {
    const auto& first = ropes_.nodes.front();
    const auto& last = ropes_.nodes.back();
    const RopeSetting setting = first_setting(touches_[lane], rest, get(last.x, lane) - get(first.x, lane),
                                              get(last.v_before, lane) - get(first.v_before, lane));
    ropes_.compliance[lane] = setting.compliance;
    ropes_.first[lane] = 1;
    put(setting.turning, ropes_.turning, lane);
  }

  /// Segment i; its length.
  double load_between(const Chain& chain, std::uint32_t i, int lane, const Source& source) {
    const wide::RopeNodeLanes<kCount>& a = ropes_.nodes[i];
    const wide::RopeNodeLanes<kCount>& b = ropes_.nodes[i + 1];
    const RopeSegment e = load_segment(chain.first_segment + i, source.tables.segments);
    wide::RopeSegmentLanes<kCount>& to = ropes_.segments[i];
    to.rest[lane] = e.rest;
    to.stiffness[lane] = e.stiffness;
    to.damping[lane] = e.damping;
    to.limit[lane] = e.limit;
    to.lighter[lane] = lighter_end(a.mass[lane], a.w[lane], b.mass[lane], b.w[lane]);
    to.held[lane] = a.w[lane] > 0 || b.w[lane] > 0 ? 0 : 1;
    to.tension_bound[lane] = e.tension_bound;
    to.limited[lane] = e.limited ? 1 : 0;
    return e.rest;
  }

  void load_anchor(const RopeAnchor& anchor, int lane, const Source& source) {
    const double w = ropes_.nodes[anchor.node].w[lane];
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

  void load_bend_at(const Chain& chain, std::uint32_t i, int lane, const Source& source) {
    const double h = source.h;
    const RopeBend bend = load_bend(chain, chain.first_segment + i, source.tables.segments);
    wide::RopeBendLanes<kCount>& to = ropes_.bends[i];
    to.before[lane] = bend.before;
    to.behind[lane] = bend.behind;
    to.pull[lane] = -h * bend.stiffness;
    to.grip[lane] = h * (bend.damping + h * bend.stiffness);
  }

  /// Node i of a lane as the functions of contacts take it.
  [[nodiscard]] RopeNode node_at(std::uint32_t i, int lane) const {
    const wide::RopeNodeLanes<kCount>& node = ropes_.nodes[i];
    RopeNode one;
    one.v_free = get(node.v_free, lane);
    one.mass = node.mass[lane];
    one.u = get(node.u, lane);
    return one;
  }

  void hold(double h) {
    std::fill(ropes_.held.begin(), ropes_.held.end(), 0);
    for (int lane = 0; lane < kCount; ++lane) {
      for_each_touched(touches_[lane], [&](std::span<const RopeTouch> at_node) {
        const std::uint32_t i = at_node.front().node;
        note_held(i, h);
        put_hold(hold_of(at_node, node_at(i, lane), h), i, lane);
      });
    }
    for (int lane = 0; lane < kCount; ++lane) {
      for (const AnchorRows& anchor : anchors_[lane]) {
        note_held(anchor.node, h);
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

  /// From now on `holds` counts for a node; nothing touches it yet.
  void note_held(std::uint32_t i, double h) {
    if (ropes_.held[i] != 0) return;
    ropes_.held[i] = 1;
    for (int k = 0; k < kCount; ++k) put_hold(hold_of({}, node_at(i, k), h), i, k);
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
  bool settle(int lane, int solves, double h) {
    if (ropes_.finite[lane] != 0) return true;
    Unsettled unsettled;
    for (RopeTouch& t : touches_[lane])
      unsettled.add(update_touch(h, lets_go(solves), node_at(t.node, lane), t));
    const bool long_enough = ropes_.error[lane] <= kLengthTolerance && !(ropes_.limits_changed[lane] > 0);
    if (long_enough && solves >= least_solves(touches_[lane], unsettled)) return true;
    if (!long_enough) ropes_.first[lane] = 0;
    return !solve_again(solves, ropes_.error[lane], unsettled.pulls, touches_[lane]);
  }

  void store(Chain& chain, int lane, const Source& source) {
    const bool finite = ropes_.finite[lane] == 0;
    chain.unconverged = chain.unconverged || !(ropes_.error[lane] <= kReportedError) || !finite;
    if (!finite) return;
    for (std::uint32_t i = 0; i < chain.node_count; ++i) {
      const wide::RopeNodeLanes<kCount>& node = ropes_.nodes[i];
      if (node.w[lane] > 0)
        source.tables.particles.velocity[chain.first_particle + i].v = vector_cast<Real>(get(node.u, lane));
    }
    for (std::uint32_t i = 0; i + 1 < chain.node_count; ++i) {
      const wide::RopeSegmentLanes<kCount>& e = ropes_.segments[i];
      store_tension(chain.first_segment + i, dot(get(e.n, lane), get(e.q, lane)) / source.h,
                    e.limited[lane] > 0, source.tables.segments);
    }
    store_touches(source.h, touches_[lane], source.tables.contacts);
    for (const AnchorRows& anchor : anchors_[lane]) {
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
  }

  RopeLanes<kCount> ropes_;
  std::array<std::vector<RopeTouch>, kCount> touches_;
  std::array<std::vector<AnchorRows>, kCount> anchors_;
};

bool fits(const Chain& a, const Chain& b) {
  return a.node_count == b.node_count && (a.bend_stiffness > 0) == (b.bend_stiffness > 0);
}

}  // namespace

struct ChainScratch::Groups {
  Group<wide::kRopeLanes> together;
  Group<1> alone;
  std::vector<Chain*> members;
};

ChainScratch::ChainScratch() : groups_(std::make_unique<Groups>()) {}
ChainScratch::~ChainScratch() = default;
ChainScratch::ChainScratch(ChainScratch&&) noexcept = default;
ChainScratch& ChainScratch::operator=(ChainScratch&&) noexcept = default;

void solve_chains(std::span<Chain> chains, std::span<const RopeAnchor> anchors,
                  const std::vector<Vec3>& before, Real h, ChainScratch& scratch, state::Tables& tables) {
  auto& [together, alone, members] = scratch.groups();
  const Source source = {anchors, before, static_cast<double>(h), tables};
  const auto finish = [&, &together = together, &alone = alone, &members = members] {
    if (members.size() >= kFewestForLanes) {
      together.solve(members, source);
    } else if (!members.empty()) {
      alone.solve(members, source);
    }
    members.clear();
  };
  for (Chain& chain : chains) {
    if (chain.in_bundle) continue;
    if (members.size() == wide::kRopeLanes || (!members.empty() && !fits(*members.front(), chain))) finish();
    members.push_back(&chain);
  }
  finish();
}

}  // namespace hooke::solver
