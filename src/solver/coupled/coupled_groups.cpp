/// Loads a bundle, solves it, checks, repeats if need be. Read solve_bundle first, at the end of the file.

#include "solver/coupled/coupled_groups.h"

#include "math/rotation.h"
#include "solver/coupled/coupled_group_solution.h"
#include "solver/joint/hook_breaks.h"
#include "solver/joint_rows/geometric_stiffness.h"
#include "solver/soft/particle_contact_solve.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::Hook;

}  // namespace

void BundleSolution::load(const std::vector<state::VelocityLine>& before, const std::vector<Chain>& chains) {
  b_.ropes.clear();
  b_.settings.clear();
  b_.chain_nodes.clear();
  for (const std::uint32_t c : b_.chains) {
    const std::size_t first = b_.ropes.nodes.size();
    const std::size_t first_segment = b_.ropes.segments.size();
    const std::size_t first_touch = b_.ropes.touches.size();
    load_rope(chains[c], before, h_, t_, b_.ropes);
    load_bends(chains[c], first, t_.segments, b_.ropes);
    b_.settings.push_back(first_setting(first, first_segment, first_touch, b_.ropes));
    b_.chain_nodes.push_back(chains[c].node_count);
  }
  load_points();
  for (std::size_t i = 0; i < b_.bodies.size(); ++i) {
    const JointBody body = joint_body_now(t_.bodies, b_.bodies[i]);
    b_.moving[i] = {.body = body,
                    .stiffness = {},
                    .excess = {},
                    .found = {},
                    .v = body.v,
                    .omega_scaled = body.omega_scaled};
  }
  for (RopeTouch& touch : b_.ropes.touches)
    touch.body = touch.row == RopeTouch::kTether ? -1 : b_.body_of(t_.contacts.body[touch.row]);
  load_hooks();
  load_inner();
  stiffen();
}

/// Points that touch nothing which gives way are held by what they touch after all ropes
/// (solver/soft/particle_contact_solve.h).
void BundleSolution::load_points() {
  const std::vector<std::uint32_t>& particle = t_.contacts.particle;
  auto row = particle.begin();
  for (std::size_t i = 0; i < b_.points.size(); ++i) {
    const std::uint32_t p = b_.points[i];
    const auto node = static_cast<std::uint32_t>(b_.ropes.nodes.size());
    b_.ropes.nodes.push_back(load_node(p, t_.particles.velocity[p].v, t_.particles));
    row = std::lower_bound(row, particle.end(), p);
    const auto first = static_cast<std::size_t>(row - particle.begin());
    row = std::upper_bound(row, particle.end(), p);
    const auto end = static_cast<std::size_t>(row - particle.begin());
    const bool touches = touches_what_gives_way(t_.bodies, t_.contacts, first, end) || has_inner(node);
    if (!(b_.ropes.nodes.back().w > 0) || !touches) continue;
    const std::span<const std::uint32_t> tethers =
        std::span(b_.tethers).subspan(b_.first_tether[i], b_.first_tether[i + 1] - b_.first_tether[i]);
    load_point_touches(node, b_.ropes.nodes.back(), first, end, tethers, heaviest_inner(node), h_, t_,
                       b_.ropes.touches);
  }
}

void BundleSolution::load_hooks() {
  std::array<JointRow, Hook::kMaxRows> rows;
  for (std::size_t i = 0; i < b_.hooks.size(); ++i) {
    Hook& hook = t_.hooks[b_.hooks[i]];
    const auto end_of = [&](int end) {
      const int body = b_.ends[i][end];
      return body >= 0 ? b_.moving[body].body : joint_end(t_, end == 0 ? hook.a : hook.b);
    };
    JointBody a = end_of(0);
    if (hook.kind == HookKind::kRopeSlide) a.rotation = turn_of_slide(t_, hook);
    const bool a_given = b_.ends[i][0] < 0 && !hook.a.is_point();
    const bool b_given = b_.ends[i][1] < 0 && !hook.b.is_point();
    const int count = make_rows(hook, a, end_of(1), a_given, b_given, h_, rows);
    for (int k = 0; k < count; ++k) {
      const std::size_t row = b_.first_row[i] + static_cast<std::size_t>(k);
      b_.rows[row] = rows[k];
      b_.lambda[row] = static_cast<double>(hook.row_impulse[k]);
      b_.bound[row] = first_bound(rows[k], b_.lambda[row]);
    }
  }
}

/// Geometric stiffness of the forces found last. True if it has grown so much that the solution must be
/// repeated.
bool BundleSolution::stiffen() {
  for (BundleBody& body : b_.moving) body.found = {};
  for (std::size_t i = 0; i < b_.hooks.size(); ++i) {
    const Hook& hook = t_.hooks[b_.hooks[i]];
    DVec3 force;
    for (std::uint32_t row = b_.first_row[i]; row < b_.first_row[i + 1]; ++row)
      force += (b_.lambda[row] / h_) * b_.rows[row].n;
    for (int end = 0; end < 2; ++end) {
      const int body = b_.ends[i][end];
      const DVec3 anchor = end == 0 ? hook.a.anchor : hook.b.anchor;
      if (body < 0 || force == DVec3{} || anchor == DVec3{}) continue;
      BundleBody& at = b_.moving[body];
      at.found =
          at.found + stiffness_of(rotate(at.body.rotation, anchor), end == 0 ? -force : force, at.body, h_);
    }
  }
  bool grew = false;
  for (BundleBody& moving : b_.moving) {
    const double before = trace(moving.stiffness);
    if (trace(moving.found) <= before) continue;
    grew = grew || trace(moving.found) > std::max(kStiffnessGrowth * before, kStiffnessLeft);
    moving.stiffness = moving.found;
    moving.excess = excess_of(moving.found);
  }
  return grew;
}

void BundleSolution::read_solution() {
  const auto vector_at = [&](std::uint32_t block, int first) {
    return DVec3{right_side(block, first), right_side(block, first + 1), right_side(block, first + 2)};
  };
  for (std::uint32_t i = 0; i < segment_count(); ++i) b_.ropes.segments[i].q = vector_at(i, 0);
  for (std::uint32_t i = 0; i < b_.ropes.bends.size(); ++i)
    b_.ropes.bends[i].impulse = vector_at(bend_block(i), 0);
  for_each_row([&](std::uint32_t hook, std::uint32_t row, int k) {
    if (b_.bound[row] == 0) b_.lambda[row] = right_side(hook_block(hook), k);
  });
  for (int i = 0; i < static_cast<int>(b_.moving.size()); ++i) {
    b_.moving[i].v = std::sqrt(b_.moving[i].body.inverse_mass) * vector_at(body_block(i), 0);
    b_.moving[i].omega_scaled = vector_at(body_block(i), 3);
  }
  move_nodes();
}

/// u = v* + W (B^T l + R V); what rows at bounds give is in v* already.
void BundleSolution::move_nodes() {
  for (RopeTouch& touch : b_.ropes.touches) {
    if (touch.body < 0) continue;
    const BundleBody& m = b_.moving[touch.body];
    touch.surface = touch.belt + m.v + cross(m.body.scale * m.omega_scaled, touch.lever);
  }
  for (std::size_t n = 0; n < b_.ropes.nodes.size(); ++n) {
    RopeNode& node = b_.ropes.nodes[n];
    DVec3 impulse;
    for (const Bundle::Incident& at : incidents_of(n)) {
      if (at.block < vector_count()) {
        impulse += at.weight * vector_impulse(at.block);
        continue;
      }
      const std::uint32_t first = b_.first_row[at.block - vector_count()];
      for (int k = 0; k < size_of(at.block); ++k)
        impulse += (at.weight * b_.lambda[first + static_cast<std::uint32_t>(k)]) * direction(at.block, k);
    }
    node.u = node.target + node.inverse * impulse;
  }
  for (const RopeTouch& touch : b_.ropes.touches) {
    if (touch.body < 0 || !touch.active) continue;
    RopeNode& node = b_.ropes.nodes[touch.node];
    node.u += node.inverse * (grip_of(touch) * (touch.surface - touch.belt));
  }
}

/// As in articulations: rows beyond a bound go to it, rows that it holds back are let go if `release`.
bool BundleSolution::revise_bounds(bool release) {
  b_.speed.assign(b_.rows.size(), 0);
  for (std::size_t n = 0; n < b_.ropes.nodes.size(); ++n) {
    for (const Bundle::Incident& at : incidents_of(n)) {
      if (at.block < vector_count()) continue;
      const std::uint32_t hook = at.block - vector_count();
      for (std::uint32_t row = b_.first_row[hook]; row < b_.first_row[hook + 1]; ++row)
        b_.speed[row] += at.weight * dot(b_.rows[row].n, b_.ropes.nodes[n].u);
    }
  }
  bool changed = false;
  for_each_row([&](std::uint32_t hook, std::uint32_t row, int) {
    const JointRow& of = b_.rows[row];
    if (std::isinf(of.low) && std::isinf(of.high)) return;
    std::int8_t bound = b_.bound[row];
    if (bound == 0) {
      bound = side_of(b_.lambda[row], of.low, of.high);
    } else if (release) {
      double lacks = of.target - of.gamma * b_.lambda[row] - b_.speed[row];
      for (int end = 0; end < 2; ++end) {
        const int body = b_.ends[hook][end];
        if (body < 0) continue;
        const BundleBody& m = b_.moving[body];
        const BodyRow velocity = {(1 / std::sqrt(m.body.inverse_mass)) * m.v, m.omega_scaled};
        lacks -= dot(hook_row(of, end, m.body), velocity);
      }
      if (!stays_at(bound, lacks)) bound = 0;
    }
    changed = changed || bound != b_.bound[row];
    b_.bound[row] = bound;
    if (bound != 0) b_.lambda[row] = bound < 0 ? of.low : of.high;
  });
  return changed;
}

void BundleSolution::solve_with_bounds() {
  bool changed = true;
  for (int pass = 0; changed && pass < kMostBoundPasses && (pass == 0 || within_budget()); ++pass) {
    hold_nodes(h_, b_.ropes);
    resize_rope_touches();
    fill_right_side();
    assemble();
    factor(b_.pattern, b_.numbers, b_.factor_scratch);
    ++b_.factored;
    solve(b_.pattern, b_.numbers, b_.right_side);
    read_solution();
    if (!is_sound()) return;
    changed = revise_bounds(pass < kFreeBoundPasses);
  }
}

bool BundleSolution::within_budget() {
  if (b_.factored < kFewestFactorizations || b_.factored * b_.pattern.operations < kBundleBudget) return true;
  b_.cut_short = true;
  return false;
}

bool BundleSolution::is_sound() const {
  return solver::is_finite(b_.ropes) &&
         std::all_of(b_.moving.begin(), b_.moving.end(), [](const BundleBody& m) {
           return hooke::is_finite(m.v) && hooke::is_finite(m.omega_scaled);
         });
}

double BundleSolution::check_ropes(bool& limits_changed) {
  double worst = 0;
  std::span<RopeSegment> rest = b_.ropes.segments;
  for (std::size_t k = 0; k < b_.chains.size(); ++k) {
    const std::size_t count = b_.chain_nodes[k] - 1;
    const double error =
        check_segments(b_.settings[k], h_, b_.ropes.nodes, rest.first(count), limits_changed);
    worst = std::max(worst, error);
    rest = rest.subspan(count);
  }
  return worst;
}

/// Whether everything moves faster than before by more than can come of a stretch that is taken back. Where
/// ropes touch ropes, a solution in which contacts still pull throws what is folded far from where it is, and
/// another about that one may settle there.
bool BundleSolution::gains_energy() const {
  constexpr double kMostGain = 1.1;
  double before = 0;
  double behind = 0;
  for (const RopeNode& node : b_.ropes.nodes) {
    if (!(node.w > 0)) continue;
    before += node.mass * length_squared(node.v_free);
    behind += node.mass * length_squared(node.u);
  }
  for (const BundleBody& m : b_.moving) {
    before += length_squared(m.body.v) / m.body.inverse_mass;
    behind += length_squared(m.v) / m.body.inverse_mass;
  }
  return behind > kMostGain * before;
}

void BundleSolution::run(std::vector<Chain>& chains) {
  double error = 0;
  Unsettled unsettled;
  const auto again = [&](int solves) {
    if (unsettled.points && solves < 2 * kMostRopeSolves) return true;
    const bool slides = solves == kMostRopeSolves && error > kReportedError && let_inner_slide();
    return solve_again(solves, error, unsettled.pulls, b_.ropes.touches) || slides;
  };
  for (int solves = 1; solves == 1 || (again(solves - 1) && within_budget()); ++solves) {
    std::size_t segment = 0;
    std::size_t bend = 0;
    for (std::size_t k = 0; k < b_.chains.size(); ++k) {
      Chain& chain = chains[b_.chains[k]];
      for (std::uint32_t i = 1; chain.bend_stiffness > 0 && i + 1 < chain.node_count; ++i)
        linearize(b_.settings[k], h_, b_.ropes.nodes, b_.ropes.bends[bend++]);
      for (std::uint32_t i = 0; i + 1 < chain.node_count; ++i)
        linearize(b_.settings[k], h_, b_.ropes.nodes, b_.ropes.segments[segment++]);
      ++chain.solves;
    }
    if (solves > 1) revise_inner();
    solve_with_bounds();
    if (!is_sound()) break;

    unsettled = update_touches(h_, lets_go(solves), b_.ropes);
    unsettled.add(update_inner(lets_go(solves)));
    bool limits_changed = false;
    error = check_ropes(limits_changed);
    const bool long_enough = error <= kLengthTolerance && !limits_changed;
    const bool grew = stiffen();
    const int least = std::max(least_solves(b_.ropes.touches, unsettled), least_solves_of_inner());
    const bool settled = !unsettled.points && solves >= least;
    if (long_enough && !grew && settled) break;
    const bool is_wild = !b_.rope_contacts.empty() && gains_energy();
    for (RopeSetting& setting : b_.settings) setting.first = is_wild || (setting.first && long_enough);
  }
  for (const std::uint32_t c : b_.chains)
    chains[c].unconverged = chains[c].unconverged || !(error <= kReportedError) || !is_sound();
}

bool BundleSolution::gives_way(int round) {
  b_.breakable.clear();
  for (const std::uint32_t row : b_.hooks) {
    if (t_.hooks[row].can_break() && !t_.hooks[row].broken) b_.breakable.push_back(row);
  }
  if (b_.breakable.empty() || !is_sound()) return false;
  return give_way(h_, b_.breakable, round, t_.hooks, [&](std::uint32_t hook) -> HookLoad {
    const auto i = std::lower_bound(b_.hooks.begin(), b_.hooks.end(), hook) - b_.hooks.begin();
    DVec3 linear;
    DVec3 angular;
    for (std::uint32_t row = b_.first_row[i]; row < b_.first_row[i + 1]; ++row) {
      linear += b_.lambda[row] * b_.rows[row].n;
      angular += b_.lambda[row] * b_.rows[row].axis;
    }
    return {length(linear), length(angular)};
  });
}

void BundleSolution::store(const std::vector<Chain>& chains) {
  if (!is_sound()) return;
  std::size_t node = 0;
  std::size_t segment = 0;
  for (const std::uint32_t c : b_.chains) {
    store_rope(chains[c], node, segment, h_, b_.ropes, t_);
    node += chains[c].node_count;
    segment += chains[c].node_count - 1;
  }
  for (const std::uint32_t p : b_.points) {
    if (b_.ropes.nodes[node].w > 0) t_.particles.velocity[p].v = vector_cast<Real>(b_.ropes.nodes[node].u);
    ++node;
  }
  store_touches(h_, b_.ropes.touches, t_.contacts);
  store_inner();
  push_out_points();
  for (std::size_t i = 0; i < b_.bodies.size(); ++i) {
    const BundleBody& m = b_.moving[i];
    set_joint_velocity(m.body, m.v, m.omega_scaled, b_.bodies[i], t_.bodies);
  }
  for (std::size_t i = 0; i < b_.hooks.size(); ++i) {
    const std::size_t first = b_.first_row[i];
    const std::size_t count = b_.first_row[i + 1] - first;
    Hook& hook = t_.hooks[b_.hooks[i]];
    store_joint_impulses(std::span(b_.rows).subspan(first, count), std::span(b_.lambda).subspan(first, count),
                         hook);
    add_up_impulses(static_cast<Real>(h_), hook);
  }
}

/// As in solver/soft/particle_contact_solve.h: overlap of points leaves by place, not by speed.
void BundleSolution::push_out_points() {
  for (const RopeTouch& touch : b_.ropes.touches) {
    if (touch.of_point && touch.row != RopeTouch::kTether)
      push_out(touch.row, static_cast<Real>(h_), t_.contacts, t_.particles);
  }
}

void solve_bundle(const std::vector<state::VelocityLine>& before, Real h, Bundle& bundle,
                  std::vector<Chain>& chains, state::Tables& tables) {
  bundle.factored = 0;
  BundleSolution solution(static_cast<double>(h), bundle, tables);
  solution.load(before, chains);
  solution.run(chains);
  for (int round = 0; solution.gives_way(round); ++round) {
    solution.load(before, chains);
    solution.run(chains);
  }
  solution.store(chains);
}

}  // namespace hooke::solver
