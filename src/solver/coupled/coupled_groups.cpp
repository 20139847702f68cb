/// Loads a coupled group, solves it, checks it and repeats that if needed. Read solve_coupled_group first, at
/// the end of the file.

#include "solver/coupled/coupled_groups.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/coupled/coupled_group_solution.h"
#include "solver/coupled/coupled_tuning.h"
#include "solver/joint_rows/geometric_stiffness.h"
#include "solver/soft/particle_contact_solve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::Hook;

}  // namespace

void CoupledGroupSolution::load(const std::vector<state::VelocityRecord>& before,
                                const std::vector<RopeSystem>& rope_systems) {
  b_.ropes.clear();
  b_.settings.clear();
  b_.rope_node_counts.clear();
  for (const std::uint32_t c : b_.rope_systems) {
    const std::size_t first = b_.ropes.nodes.size();
    const std::size_t first_segment = b_.ropes.segments.size();
    const std::size_t first_contact_row = b_.ropes.contact_rows.size();
    load_rope(rope_systems[c], before, h_, t_, b_.ropes);
    load_loads(rope_systems[c], static_cast<std::uint32_t>(first), h_, surfaces_, t_, b_.ropes.contact_rows);
    load_bends(rope_systems[c], first, t_.segments, b_.ropes);
    b_.settings.push_back(first_setting(first, first_segment, first_contact_row, b_.ropes));
    b_.rope_node_counts.push_back(rope_systems[c].node_count);
  }
  apply_dashpots(rope_systems);
  HOOKE_ASSERT(b_.moving.size() == b_.bodies.size());
  load_points();
  for (std::size_t i = 0; i < b_.bodies.size(); ++i) {
    const JointBody body = joint_body_now(t_.bodies, b_.bodies[i]);
    HOOKE_ASSERT(body.inverse_mass > 0);
    b_.moving[i] = {.body = body,
                    .stiffness = {},
                    .excess = {},
                    .found = {},
                    .v = body.v,
                    .omega_scaled = body.omega_scaled};
  }
  for (RopeContactRow& contact_row : b_.ropes.contact_rows) {
    const bool is_tether = contact_row.row == RopeContactRow::kTether;
    contact_row.body = is_tether ? -1 : b_.body_of(t_.contacts.body[contact_row.row]);
  }
  load_body_contacts();
  load_hooks();
  load_coupled_contacts();
  stiffen();
}

/// The tethers of a point whose contacts are [contact, end). A cloth with loads at single points has none:
/// a load that tethers of points beside it stop here leaves the cloth, which has been solved without them.
std::span<const std::uint32_t> CoupledGroupSolution::tethers_of(std::size_t point, std::size_t contact,
                                                                std::size_t end) const {
  if (contact < end && !loaded_at_points_.empty() && loaded_at_points_[t_.contacts.object[contact]] != 0)
    return {};
  const std::uint32_t first = b_.first_tether[point];
  return std::span(b_.tethers).subspan(first, b_.first_tether[point + 1] - first);
}

/// All contacts of a group's points are its rows, also those with the ground: what a hook pulls on would
/// otherwise be stopped afterwards, whatever the hook holds.
void CoupledGroupSolution::load_points() {
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
    if (!(b_.ropes.nodes.back().w > 0) || (first == end && !has_coupled_contact(node))) continue;
    std::fill(t_.contacts.coupled.begin() + static_cast<std::ptrdiff_t>(first),
              t_.contacts.coupled.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{1});
    load_point_contact_rows({.node = b_.ropes.nodes.back(),
                             .index = node,
                             .first = first,
                             .end = end,
                             .tethers = tethers_of(i, first, end),
                             .heaviest = heaviest_in_contact(node)},
                            h_, t_, b_.ropes.contact_rows);
  }
}

void CoupledGroupSolution::load_hooks() {
  std::array<JointRow, Hook::kMaxRows> rows;
  const double bounded =
      b_.direct.rows.empty() ? std::numeric_limits<double>::infinity() : kJointPushInContact;
  const double most_push = is_calm_ ? 0 : bounded;
  for (std::size_t i = 0; i < b_.hooks.size(); ++i) {
    Hook& hook = t_.hooks[b_.hooks[i]];
    const auto end_of = [&](int end) {
      const int body = b_.ends[i][end];
      return body >= 0 ? b_.moving[body].body : joint_end(t_, end == 0 ? hook.a : hook.b);
    };
    RowEnd a = {end_of(0), b_.ends[i][0] < 0 && !hook.a.is_point()};
    const RowEnd b = {end_of(1), b_.ends[i][1] < 0 && !hook.b.is_point()};
    if (hook.kind == HookKind::kRopeSlide) a.body.rotation = slide_rotation(t_, hook);
    const int count = make_rows(hook, a, b, h_, rows, most_push);
    HOOKE_ASSERT(b_.first_row[i] + static_cast<std::uint32_t>(count) == b_.first_row[i + 1]);
    for (int k = 0; k < count; ++k) {
      const std::size_t row = b_.first_row[i] + static_cast<std::size_t>(k);
      b_.rows[row] = rows[k];
      b_.lambda[row] = static_cast<double>(hook.row_impulse[k]);
      b_.bound[row] = first_bound(rows[k], b_.lambda[row]);
    }
  }
}

/// Computes the geometric stiffness of the forces found last. True if it has grown so much that the solution
/// must be repeated.
bool CoupledGroupSolution::stiffen() {
  for (CoupledBody& body : b_.moving) body.found = {};
  for (std::size_t i = 0; i < b_.hooks.size(); ++i) {
    const Hook& hook = t_.hooks[b_.hooks[i]];
    DVec3 force;
    for (std::uint32_t row = b_.first_row[i]; row < b_.first_row[i + 1]; ++row)
      force += (b_.lambda[row] / h_) * b_.rows[row].n;
    for (int end = 0; end < 2; ++end) {
      const int body = b_.ends[i][end];
      const DVec3 anchor = end == 0 ? hook.a.anchor : hook.b.anchor;
      if (body < 0 || force == DVec3{} || anchor == DVec3{}) continue;
      CoupledBody& at = b_.moving[body];
      at.found =
          at.found + stiffness_of(rotate(at.body.rotation, anchor), end == 0 ? -force : force, at.body, h_);
    }
  }
  bool grew = false;
  for (CoupledBody& moving : b_.moving) {
    const double before = trace(moving.stiffness);
    if (trace(moving.found) <= before) continue;
    grew = grew || trace(moving.found) > std::max(kStiffnessGrowth * before, kStiffnessLeft);
    moving.stiffness = moving.found;
    moving.excess = excess_of(moving.found);
  }
  return grew;
}

void CoupledGroupSolution::read_solution() {
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

/// Computes u = v* + W (B^T l + R V); impulses of rows at bounds are in v* already.
void CoupledGroupSolution::move_nodes() {
  HOOKE_ASSERT(b_.first_incident.size() == b_.ropes.nodes.size() + 1);
  for (RopeContactRow& contact_row : b_.ropes.contact_rows) {
    if (contact_row.body < 0) continue;
    contact_row.surface = contact_row.belt + b_.moving[contact_row.body].velocity_at(contact_row.lever);
  }
  for (std::size_t n = 0; n < b_.ropes.nodes.size(); ++n) {
    RopeNode& node = b_.ropes.nodes[n];
    DVec3 impulse;
    for (const CoupledGroup::Incident& at : incidents_of(n)) {
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
  for (const RopeContactRow& contact_row : b_.ropes.contact_rows) {
    if (contact_row.body < 0 || !contact_row.active) continue;
    RopeNode& node = b_.ropes.nodes[contact_row.node];
    node.u += node.inverse * (contact_stiffness(contact_row) * (contact_row.surface - contact_row.belt));
  }
}

/// As in articulations, rows beyond a bound go to it. Rows that a bound holds back are let go if `release`.
bool CoupledGroupSolution::revise_bounds(bool release) {
  b_.speed.assign(b_.rows.size(), 0);
  for (std::size_t n = 0; n < b_.ropes.nodes.size(); ++n) {
    for (const CoupledGroup::Incident& at : incidents_of(n)) {
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
        const CoupledBody& m = b_.moving[body];
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

void CoupledGroupSolution::solve_with_bounds() {
  bool changed = true;
  for (int pass = 0; changed && pass < kMostBoundPasses && (pass == 0 || within_budget()); ++pass) {
    solve_body_contacts();
    if (!is_sound()) return;
    changed = revise_bounds(pass < kFreeBoundPasses);
  }
}

void CoupledGroupSolution::solve_once() {
  constrain_nodes(h_, b_.ropes);
  resize_coupled_contacts();
  fill_right_side();
  assemble();
  factor(b_.pattern, b_.numbers, b_.factor_scratch);
  ++b_.factored;
  solve(b_.pattern, b_.numbers, b_.right_side);
  // A single hook says nothing twice.
  if (b_.hooks.size() > 1) remove_unfelt(b_.pattern, b_.numbers, b_.compliance, b_.right_side, b_.unfelt);
  read_solution();
}

bool CoupledGroupSolution::within_budget() {
  if (b_.factored < kFewestFactorizations || b_.factored * b_.pattern.operations < kCoupledGroupBudget)
    return true;
  b_.cut_short = true;
  return false;
}

bool CoupledGroupSolution::is_sound() const {
  return solver::is_finite(b_.ropes) &&
         std::all_of(b_.moving.begin(), b_.moving.end(), [](const CoupledBody& m) {
           return hooke::is_finite(m.v) && hooke::is_finite(m.omega_scaled);
         });
}

/// Linearizes the bends and segments of all ropes about the last result.
void CoupledGroupSolution::linearize_ropes(std::vector<RopeSystem>& rope_systems) {
  std::size_t segment = 0;
  std::size_t bend = 0;
  for (std::size_t k = 0; k < b_.rope_systems.size(); ++k) {
    RopeSystem& rope_system = rope_systems[b_.rope_systems[k]];
    for (std::uint32_t i = 1; rope_system.bend_stiffness > 0 && i + 1 < rope_system.node_count; ++i)
      linearize(b_.settings[k], h_, b_.ropes.nodes, b_.ropes.bends[bend++]);
    for (std::uint32_t i = 0; i + 1 < rope_system.node_count; ++i)
      linearize(b_.settings[k], h_, b_.ropes.nodes, b_.ropes.segments[segment++]);
    ++rope_system.solves;
  }
  HOOKE_ASSERT(segment == b_.ropes.segments.size() && bend == b_.ropes.bends.size());
}

double CoupledGroupSolution::check_ropes(bool& limits_changed) {
  double worst = 0;
  std::span<RopeSegment> rest = b_.ropes.segments;
  for (std::size_t k = 0; k < b_.rope_systems.size(); ++k) {
    const std::size_t count = b_.rope_node_counts[k] - 1;
    const double error =
        check_segments(b_.settings[k], h_, b_.ropes.nodes, rest.first(count), limits_changed);
    worst = std::max(worst, error);
    rest = rest.subspan(count);
  }
  HOOKE_ASSERT(rest.empty());
  return worst;
}

/// Whether everything moves faster than before by more than the removal of a stretch can explain. Where ropes
/// touch ropes, a solution in which contacts still pull throws a folded rope far from its position. Another
/// solution about that state may converge there.
bool CoupledGroupSolution::gains_energy() const {
  double before = 0;
  double behind = 0;
  double mass = 0;
  for (const RopeNode& node : b_.ropes.nodes) {
    if (!(node.w > 0)) continue;
    before += node.mass * length_squared(node.v_free);
    behind += node.mass * length_squared(node.u);
    mass += node.mass;
  }
  for (const CoupledBody& m : b_.moving) {
    before += length_squared(m.body.v) / m.body.inverse_mass + length_squared(m.body.omega_scaled);
    behind += length_squared(m.v) / m.body.inverse_mass + length_squared(m.omega_scaled);
    mass += 1 / m.body.inverse_mass;
  }
  return behind > kMostEnergyGain * before && is_work(0.5 * (behind - before), mass);
}

void CoupledGroupSolution::load_and_solve(const std::vector<state::VelocityRecord>& before,
                                          std::vector<RopeSystem>& rope_systems) {
  is_calm_ = false;
  load(before, rope_systems);
  if (run(rope_systems)) return;
  is_calm_ = true;
  load(before, rope_systems);
  run_calmly(rope_systems);
}

bool CoupledGroupSolution::run(std::vector<RopeSystem>& rope_systems) {
  double error = 0;
  bool done = false;
  Unconverged unconverged;
  const auto again = [&](int solves) {
    if (unconverged.points && solves < 2 * kMostRopeSolves) return true;
    const bool slides = solves == kMostRopeSolves && error > kRopeReportedError && let_contacts_slide();
    return solve_again(solves, error, unconverged.pulls, b_.ropes.contact_rows) || slides;
  };
  for (int solves = 1; solves == 1 || (again(solves - 1) && within_budget()); ++solves) {
    linearize_ropes(rope_systems);
    if (solves > 1) revise_coupled_contacts();
    solve_with_bounds();
    if (!is_sound()) break;

    unconverged = update_contact_rows(h_, lets_go(solves), b_.ropes);
    unconverged.add(update_coupled_contacts(lets_go(solves)));
    bool limits_changed = false;
    error = check_ropes(limits_changed);
    const bool long_enough = error <= kRopeLengthTolerance && !limits_changed;
    const bool grew = stiffen();
    const int least = std::max(least_solves(b_.ropes.contact_rows, unconverged), least_solves_of_contacts());
    const bool converged = !unconverged.points && solves >= least;
    done = long_enough && !grew && converged;
    if (done) break;
    const bool is_wild = !b_.rope_contacts.empty() && gains_energy();
    for (RopeSetting& setting : b_.settings) setting.first = is_wild || (setting.first && long_enough);
  }
  const bool is_solved = error <= kRopeReportedError && is_sound();
  for (const std::uint32_t c : b_.rope_systems)
    rope_systems[c].unconverged = rope_systems[c].unconverged || !is_solved;
  // Where ropes touch ropes, all solutions go on from wild ones, and a calm one lets knots through.
  if (!b_.rope_contacts.empty()) return true;
  return !unconverged.impacts && (done || !gains_energy());
}

/// Lets contacts hold what they hold or would meet in this substep, without friction, and lets them take no
/// overlap back.
void CoupledGroupSolution::calm_contacts() {
  for (RopeContactRow& contact_row : b_.ropes.contact_rows) {
    const DVec3 surface = contact_row.body < 0
                              ? contact_row.surface
                              : contact_row.belt + b_.moving[contact_row.body].velocity_at(contact_row.lever);
    const double opening = dot(contact_row.n, b_.ropes.nodes[contact_row.node].v_free - surface);
    contact_row.active = contact_row.separation <= 0 || h_ * opening + contact_row.separation < 0;
    contact_row.separation = std::max(contact_row.separation, 0.0);
    contact_row.n0 = contact_row.normal = contact_row.friction = contact_row.drag = 0;
    contact_row.f0 = contact_row.f = {};
    contact_row.slides = true;
  }
  calm_coupled_contacts();
  std::fill(b_.kept.begin(), b_.kept.end(), 0.0);
}

void CoupledGroupSolution::run_calmly(std::vector<RopeSystem>& rope_systems) {
  b_.cut_short = true;
  calm_contacts();
  double error = 1;
  for (int solves = 0; error > kRopeLengthTolerance && solves < kMostRopeSolves; ++solves) {
    linearize_ropes(rope_systems);
    solve_with_bounds();
    bool limits_changed = false;
    error = check_ropes(limits_changed);
    for (RopeSetting& setting : b_.settings) setting.first = false;
  }
  if (!is_sound() || gains_energy()) {
    for (RopeSetting& setting : b_.settings) setting.first = true;
    linearize_ropes(rope_systems);
    for (RopeSegment& segment : b_.ropes.segments) segment.offset = {};
    for (RopeBend& bend : b_.ropes.bends) bend.target = {};
    solve_with_bounds();
  }
  if (!is_sound()) return;
  (void)update_contact_rows(h_, true, b_.ropes);
  (void)update_coupled_contacts(true);
}

void CoupledGroupSolution::store(const std::vector<RopeSystem>& rope_systems) {
  if (!is_sound()) return;
  std::size_t node = 0;
  std::size_t segment = 0;
  for (const std::uint32_t c : b_.rope_systems) {
    store_rope(rope_systems[c], node, segment, h_, b_.ropes, t_);
    node += rope_systems[c].node_count;
    segment += rope_systems[c].node_count - 1;
  }
  for (const std::uint32_t p : b_.points) {
    if (b_.ropes.nodes[node].w > 0) t_.particles.velocity[p].v = vector_cast<Real>(b_.ropes.nodes[node].u);
    ++node;
  }
  HOOKE_ASSERT(node == b_.ropes.nodes.size() && segment == b_.ropes.segments.size());
  store_contact_rows(h_, b_.ropes.contact_rows, t_.contacts);
  store_loads(b_.ropes.contact_rows, surfaces_);
  store_coupled_contacts();
  push_out_points();
  store_bodies();
  store_body_contacts();
  for (std::size_t i = 0; i < b_.hooks.size(); ++i) {
    const std::size_t first = b_.first_row[i];
    const std::size_t count = b_.first_row[i + 1] - first;
    Hook& hook = t_.hooks[b_.hooks[i]];
    store_joint_impulses(std::span(b_.rows).subspan(first, count), std::span(b_.lambda).subspan(first, count),
                         hook);
    add_up_impulses(static_cast<Real>(h_), hook);
  }
}

/// As in solver/soft/particle_contact_solve.h, overlap of points is removed by displacement, not by speed.
void CoupledGroupSolution::push_out_points() {
  const auto h = static_cast<Real>(h_);
  for (const RopeContactRow& contact_row : b_.ropes.contact_rows) {
    if (!contact_row.of_point || contact_row.row == RopeContactRow::kTether) continue;
    push_out(contact_row.row, h, t_.bodies, t_.contacts, t_.particles);
  }
}

void solve_coupled_group(const std::vector<state::VelocityRecord>& before, const ParticleSubstep& substep,
                         CoupledGroup& group, std::vector<RopeSystem>& rope_systems, BodyContacts& contacts,
                         state::Tables& tables) {
  group.factored = 0;
  group.giving.clear();
  CoupledGroupSolution solution(substep, group, contacts, tables);
  solution.load_and_solve(before, rope_systems);
  for (int round = 0; solution.gives_way(round, rope_systems); ++round)
    solution.load_and_solve(before, rope_systems);
  solution.store(rope_systems);
  solution.break_segments(substep.end_time);
  if (substep.first) solution.remove_overlaps(rope_systems);
}

}  // namespace hooke::solver
