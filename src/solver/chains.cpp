/// One rope after another: linearize its segments and contacts, sweep forward, sweep back, check, repeat if
/// need be. Read solve_chain first, at the end of the file.

#include "solver/chains.h"

#include "solver/rope_rows.h"

namespace hooke::solver {

namespace {

using V = DVec3;
using M = math::Symmetric3<double>;

void sweep(RopeScratch& s) {
  RopeNode& head = s.nodes.front();
  M phi_matrix = head.inverse;
  V phi = head.target;
  const std::size_t last = s.segments.size();
  for (std::size_t i = 0; i < last; ++i) {
    RopeSegment& e = s.segments[i];
    const RopeNode& node = s.nodes[i + 1];
    const M x = phi_matrix + e.compliance;
    e.s = phi + e.offset;
    e.k = math::inverse(x + node.inverse);
    phi_matrix = math::symmetric_product(x, e.k, node.inverse);
    phi = node.target + node.inverse * (e.k * (e.s - node.target));
  }
  V next = {};
  for (std::size_t i = last; i > 0; --i) {
    RopeSegment& e = s.segments[i - 1];
    RopeNode& node = s.nodes[i];
    e.q = e.k * (node.target + node.inverse * next - e.s);
    node.u = node.target + node.inverse * (next - e.q);
    next = e.q;
  }
  head.u = head.target + head.inverse * next;
}

/// Newton steps until the rope is as long as its forces say and its contacts are settled. `s` is loaded.
void solve_chain(Chain& chain, double h, RopeScratch& s) {
  RopeSetting setting = first_setting(0, s);
  double error = 0;
  for (int solves = 1; solves <= kMostRopeSolves; ++solves) {
    for (RopeSegment& segment : s.segments) linearize(setting, h, s.nodes, segment);
    hold_nodes(h, s);
    sweep(s);
    ++chain.solves;
    if (!is_finite(s)) break;

    const bool unsettled = update_touches(h, s);
    bool limits_changed = false;
    error = check_segments(h, s, limits_changed);
    const bool long_enough = error <= kLengthTolerance && !limits_changed;
    if (long_enough && solves >= least_solves(s, unsettled)) break;
    setting.first = setting.first && long_enough;
  }
  chain.unconverged = chain.unconverged || !(error <= kReportedError) || !is_finite(s);
}

}  // namespace

void solve_chains(std::span<Chain> chains, const std::vector<Vec3>& before, Real h,
                  state::Particles& particles, state::Segments& segments, state::Contacts& contacts) {
  thread_local RopeScratch scratch;
  const auto substep = static_cast<double>(h);
  for (Chain& chain : chains) {
    if (chain.in_bundle) continue;
    scratch.clear();
    load_rope(chain, before, substep, particles, segments, contacts, scratch);
    solve_chain(chain, substep, scratch);
    if (!is_finite(scratch)) continue;
    store_rope(chain, 0, 0, substep, scratch, particles, segments);
    store_touches(substep, scratch, contacts);
  }
}

}  // namespace hooke::solver
