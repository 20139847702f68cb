/// Contacts of two bodies of a coupled group: the rows of solver/contact/direct_rows.h, with stiffness in the
/// blocks of the bodies. Equations: solver/coupled/coupled_groups.h.

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/contact/contact_tuning.h"
#include "solver/coupled/coupled_group_solution.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using math::Symmetric3;

BodyRow row_of(const DirectLever& j) {
  return {{j[0], j[1], j[2]}, {j[3], j[4], j[5]}};
}

void put(DVec3 linear, DVec3 angular, std::size_t body, std::vector<double>& u) {
  for (std::size_t k = 0; k < 3; ++k) {
    u[6 * body + k] = component(linear, static_cast<int>(k));
    u[6 * body + 3 + k] = component(angular, static_cast<int>(k));
  }
}

/// Gives the angular half of a lever another inertia in place of that whose inverse is given.
void turn_lever(const Symmetric3<double>& inverse, const Symmetric3<double>& to, DirectLever& j) {
  const DVec3 turned = to * (inverse * DVec3{j[3], j[4], j[5]});
  for (std::size_t k = 0; k < 3; ++k) j[3 + k] = component(turned, static_cast<int>(k));
}

}  // namespace

void CoupledGroupSolution::read_velocities(std::vector<double>& u) const {
  u.resize(6 * b_.moving.size());
  for (std::size_t i = 0; i < b_.moving.size(); ++i) {
    const CoupledBody& m = b_.moving[i];
    put((1 / std::sqrt(m.body.inverse_mass)) * m.v, m.omega_scaled, i, u);
  }
}

/// Adds the contacts with points whose bodies both are in the group or do not give way.
void CoupledGroupSolution::add_body_contacts() {
  b_.direct.contacts.clear();
  b_.direct.rows.clear();
  for (const std::uint32_t index : b_.manifolds) {
    const state::CoupledManifold& of = t_.pairs.coupled[index];
    HOOKE_ASSERT(of.block >= 0);
    const ContactBlock& block = contacts_.blocks[of.block];
    DirectContact c = {.block = of.block, .lane = of.lane, .points = count_points(block, of.lane)};
    const int a = b_.body_of(block.record_a[of.lane] / 16);
    const int b = block.anchored ? -1 : b_.body_of(block.record_b[of.lane] / 16);
    HOOKE_ASSERT(a >= 0 && (block.anchored || b >= 0));
    c.a = static_cast<std::uint32_t>(a);
    if (!block.anchored) c.b = static_cast<std::uint32_t>(b);
    add_contact(block, t_.bodies, c, b_.direct);
  }
}

/// Lets rows begin with their part of the impulses that their lanes have, those of a whole substep.
void CoupledGroupSolution::load_carried_impulses() {
  load_impulses(contacts_, b_.direct);
  b_.kept.clear();
  for (DirectRow& row : b_.direct.rows) {
    row.before /= t_.desc.particle_substeps;
    b_.kept.push_back(row.before);
  }
}

/// Rows are of the inertia at the step's start, and the group's bodies have that of now.
void CoupledGroupSolution::turn_levers() {
  for (std::size_t i = 0; i < b_.moving.size(); ++i) {
    if (!is_gyroscopic_now(t_.bodies, b_.bodies[i])) continue;
    const Symmetric3<double> from = math::inverse(math::in_double(t_.bodies.scale[b_.bodies[i]]));
    const Symmetric3<double>& to = b_.moving[i].body.scale;
    for (const DirectContact& c : b_.direct.contacts) {
      for (DirectRow& row : b_.direct.rows_of(c)) {
        if (c.a == i) turn_lever(from, to, row.a);
        if (c.b == i) turn_lever(from, to, row.b);
      }
    }
  }
}

void CoupledGroupSolution::load_body_contacts() {
  add_body_contacts();
  if (b_.direct.rows.empty()) return;
  b_.direction.resize(6 * b_.moving.size());
  for (std::size_t i = 0; i < b_.moving.size(); ++i) {
    const state::MotionRecord& m = t_.bodies.motion[b_.bodies[i]];
    const double root = 1 / std::sqrt(static_cast<double>(m.inverse_mass));
    put(root * vector_cast<double>(m.dx), vector_cast<double>(m.theta_scaled), i, b_.direction);
  }
  load_drifts(contacts_, t_.bodies, b_.direct);
  open_gaps(h_, contacts_, t_.bodies, b_.direction, b_.direct);
  turn_levers();
  load_carried_impulses();
  read_velocities(b_.velocity);
  b_.free = b_.velocity;
}

/// Adds -D j j^T to the blocks of the bodies.
void CoupledGroupSolution::assemble_body_contact(const DirectContact& c, double stiffness,
                                                 const DirectLever& a, const DirectLever& b) {
  const auto subtract = [&](std::uint32_t left, std::uint32_t right, const DirectLever& j_left,
                            const DirectLever& j_right) {
    const Numbers block = numbers(body_block(static_cast<int>(left)), body_block(static_cast<int>(right)));
    for (int i = 0; i < 6; ++i) {
      const double factor = stiffness * j_left[static_cast<std::size_t>(i)];
      for (int k = 0; k < 6; ++k) block(i, k) -= factor * j_right[static_cast<std::size_t>(k)];
    }
  };
  subtract(c.a, c.a, a, a);
  if (!c.has_b()) return;
  subtract(c.b, c.b, b, b);
  subtract(c.a, c.b, a, b);
}

void CoupledGroupSolution::assemble_body_contacts() {
  for (std::size_t i = 0; i < b_.direct.contacts.size(); ++i) {
    const DirectContact& c = b_.direct.contacts[i];
    for (const DirectRow& row : b_.direct.rows_of(c)) {
      if (row.holds) assemble_body_contact(c, row.stiffness, row.a, row.b);
    }
    const SlidingRow& sliding = b_.sliding[i];
    if (sliding.stiffness > 0) assemble_body_contact(c, sliding.stiffness, sliding.a, sliding.b);
  }
}

/// Adds what contacts push whatever the new velocities are: impulse + D J velocity.
void CoupledGroupSolution::push_by_body_contacts() {
  const auto push = [&](const DirectContact& c, double impulse, const DirectLever& a, const DirectLever& b) {
    b_.start[c.a] += impulse * row_of(a);
    if (c.has_b()) b_.start[c.b] += impulse * row_of(b);
  };
  for (std::size_t i = 0; i < b_.direct.contacts.size(); ++i) {
    const DirectContact& c = b_.direct.contacts[i];
    for (const DirectRow& row : b_.direct.rows_of(c)) {
      const double held = row.holds ? row.stiffness * (row.rate - row.drift) : 0;
      push(c, row.impulse + held, row.a, row.b);
    }
    const SlidingRow& sliding = b_.sliding[i];
    if (!(sliding.stiffness > 0)) continue;
    double rate = product(sliding.a, &b_.velocity[6 * c.a]);
    if (c.has_b()) rate += product(sliding.b, &b_.velocity[6 * c.b]);
    push(c, sliding.stiffness * rate, sliding.a, sliding.b);
  }
}

/// Finds how rates change on the way to the velocities that the linear system has given, and what the rest of
/// the group will have felt there: that is linear on the way.
void CoupledGroupSolution::note_search() {
  read_velocities(b_.direction);
  for (std::size_t i = 0; i < b_.direction.size(); ++i) b_.direction[i] -= b_.velocity[i];
  for (std::size_t i = 0; i < b_.direct.contacts.size(); ++i) {
    const DirectContact& c = b_.direct.contacts[i];
    for (int k = c.first; k < c.end(); ++k) {
      DirectRow& row = b_.direct.rows[k];
      row.slope = rate_of(c, row, b_.direction);
      b_.felt_then[k] = row.impulse - (row.holds ? row.stiffness * row.slope : 0);
    }
    const SlidingRow& sliding = b_.sliding[i];
    const int x = c.first + c.points;
    const double slope = sliding.x * b_.direct.rows[x].slope + sliding.y * b_.direct.rows[x + 1].slope;
    b_.felt_then[x] -= sliding.stiffness * slope * sliding.x;
    b_.felt_then[x + 1] -= sliding.stiffness * slope * sliding.y;
  }
}

/// How fast the energy of the group grows along the search direction, after a share t of it. All but these
/// contacts is linear and in balance with the impulses that it has felt.
double CoupledGroupSolution::climb(double t) {
  double sum = 0;
  for (const DirectContact& c : b_.direct.contacts) {
    respond(t, c, b_.direct.rows);
    for (int k = c.first; k < c.end(); ++k) {
      const DirectRow& row = b_.direct.rows[k];
      sum += row.slope * ((1 - t) * b_.felt[k] + t * b_.felt_then[k] - row.impulse);
    }
  }
  return sum;
}

/// Computes impulses at the present velocities. True if they are what the rest of the group has felt.
bool CoupledGroupSolution::evaluate() {
  find_rates(b_.velocity, b_.direct);
  std::fill(b_.direction.begin(), b_.direction.end(), 0.0);
  for (const DirectContact& c : b_.direct.contacts) {
    respond(0, c, b_.direct.rows);
    for (int k = c.first; k < c.end(); ++k) b_.direct.rows[k].slope = b_.direct.rows[k].impulse - b_.felt[k];
    add_impulses(b_.direct, c, &DirectRow::slope, b_.direction);
  }
  double left = 0;
  double done = 0;
  for (std::size_t i = 0; i < b_.direction.size(); ++i) {
    left = std::max(left, std::abs(b_.direction[i]));
    done = std::max(done, std::abs(b_.velocity[i] - b_.free[i]));
  }
  return left <= kDirectTolerance * done;
}

/// Goes a share t of the search direction. All of the group goes along: it is linear on the way.
void CoupledGroupSolution::go(double t) {
  for (std::size_t i = 0; i < b_.velocity.size(); ++i) b_.velocity[i] += t * b_.direction[i];
  for (std::size_t k = 0; k < b_.felt.size(); ++k) b_.felt[k] += t * (b_.felt_then[k] - b_.felt[k]);
  if (t < 1) {
    HOOKE_ASSERT(b_.last.size() == b_.right_side.size());
    for (std::size_t i = 0; i < b_.last.size(); ++i)
      b_.right_side[i] = b_.last[i] + t * (b_.right_side[i] - b_.last[i]);
    read_solution();
  }
  b_.last = b_.right_side;
}

/// Makes Newton steps with limits of friction as they are. False if they do not converge.
bool CoupledGroupSolution::descend(int steps) {
  for (int step = 0; step < steps; ++step) {
    if (evaluate()) return true;
    if (!within_budget()) return false;
    for (std::size_t i = 0; i < b_.sliding.size(); ++i)
      b_.sliding[i] = sliding_row(b_.direct.contacts[i], b_.direct);
    solve_once();
    if (!is_sound()) return false;
    note_search();
    go(find_least([&](double t) { return climb(t); }));
  }
  return evaluate();
}

/// Solves the group if just the guessed rows hold, even by pulling.
void CoupledGroupSolution::jump(Guess guess) {
  find_rates(b_.velocity, b_.direct);
  guess_rows(guess, b_.direct);
  b_.sliding.assign(b_.direct.contacts.size(), {});
  for (DirectRow& row : b_.direct.rows)
    row.impulse = row.holds ? row.before - row.stiffness * row.rate : row.before;
  solve_once();
  if (!is_sound()) return;
  b_.last = b_.right_side;
  read_velocities(b_.velocity);
  find_rates(b_.velocity, b_.direct);
  b_.felt.clear();
  for (const DirectRow& row : b_.direct.rows)
    b_.felt.push_back(row.holds ? row.before - row.stiffness * row.rate : row.impulse);
}

bool CoupledGroupSolution::converge(double stiffness, Guess guess, int steps) {
  for (std::size_t k = 0; k < b_.kept.size(); ++k) {
    const double most = kMostCarriedSpeed * stiffness * b_.direct.rows[k].mass;
    b_.direct.rows[k].before = std::clamp(b_.kept[k], -most, most);
  }
  set_stiffness(stiffness, b_.direct);
  b_.felt_then.assign(b_.direct.rows.size(), 0);
  limit_friction(b_.direct);
  jump(guess);
  for (int round = 0; round < kDirectFrictionRounds; ++round) {
    if (!is_sound() || !descend(steps)) return false;
    if (!limit_friction(b_.direct)) break;
  }
  return true;
}

/// Solves the group with the bounds of its hooks as they are, and finds what its contacts do.
void CoupledGroupSolution::solve_body_contacts() {
  if (b_.direct.rows.empty()) {
    solve_once();
    return;
  }
  is_solved_ = converge(kDirectStiffness, Guess::kSame, kDirectQuickSteps) ||
               converge(kDirectStiffness, Guess::kAll, kDirectNewtonSteps) ||
               converge(kDirectSofterStiffness, Guess::kAll, kDirectNewtonSteps);
}

void CoupledGroupSolution::store_bodies() {
  for (std::size_t i = 0; i < b_.bodies.size(); ++i) {
    const CoupledBody& m = b_.moving[i];
    set_joint_velocity(m.body, m.v, m.omega_scaled, b_.bodies[i], t_.bodies);
  }
}

/// Lanes have the impulses of a whole substep at the force of this particle substep.
void CoupledGroupSolution::store_body_contacts() {
  b_.cut_short = b_.cut_short || !is_solved_;
  for (const DirectContact& c : b_.direct.contacts) {
    ContactBlock& block = contacts_.blocks[c.block];
    const DirectRow* row = &b_.direct.rows[c.first];
    const auto whole = [&](const DirectRow& of) {
      return static_cast<Real>(t_.desc.particle_substeps * of.impulse);
    };
    Real load = Real(0);
    for (int k = 0; k < c.points; ++k) load += block.point[k].impulse[c.lane] = whole(row[k]);
    const DirectRow* friction = row + c.points;
    for (int i = 0; i < 2; ++i) block.friction_impulse[i][c.lane] = whole(friction[i]);
    block.twist_impulse[c.lane] = whole(friction[2]);
    block.pushed[c.lane] = std::max(block.pushed[c.lane], load);
  }
}

/// Finds rows that overlap, which hold then, and how far each is pushed, in its slope. False if there are
/// none.
bool CoupledGroupSolution::find_overlaps() {
  bool any = false;
  for (const DirectContact& c : b_.direct.contacts) {
    for (int k = c.first; k < c.end(); ++k) {
      DirectRow& row = b_.direct.rows[k];
      const bool overlaps = k < c.first + c.points && row.separation < -c.slop;
      any = any || overlaps;
      row.slope = overlaps ? std::min(kDirectLargestPush, -kDirectPushOut * row.separation) : 0;
      row.holds = row.holds || overlaps;
    }
  }
  return any;
}

/// Fills the right side with what pushes overlaps apart.
void CoupledGroupSolution::fill_pushes() {
  b_.start.assign(b_.moving.size(), {});
  for (const DirectContact& c : b_.direct.contacts) {
    for (const DirectRow& row : b_.direct.rows_of(c)) {
      const double push = row.stiffness * row.slope;
      b_.start[c.a] += push * row_of(row.a);
      if (c.has_b()) b_.start[c.b] += push * row_of(row.b);
    }
  }
  std::fill(b_.right_side.begin(), b_.right_side.end(), 0.0);
  for (int i = 0; i < static_cast<int>(b_.start.size()); ++i) {
    for (int m = 0; m < 6; ++m) right_side(body_block(i), m) = -b_.start[i].at(m);
  }
}

/// Displacements of bodies and nodes that the linear system has given, as velocities.
void CoupledGroupSolution::read_displacement() {
  for (int i = 0; i < static_cast<int>(b_.moving.size()); ++i) {
    const auto at = [&](int k) { return right_side(body_block(i), k); };
    CoupledBody& of = b_.moving[i];
    of.v = std::sqrt(of.body.inverse_mass) * DVec3{at(0), at(1), at(2)};
    of.omega_scaled = {at(3), at(4), at(5)};
  }
  for (std::size_t n = 0; n < b_.ropes.nodes.size(); ++n) {
    DVec3 impulse;
    for (const CoupledGroup::Incident& at : incidents_of(n)) {
      for (int k = 0; k < size_of(at.block); ++k)
        impulse += (at.weight * right_side(at.block, k)) * direction(at.block, k);
    }
    b_.ropes.nodes[n].u = b_.ropes.nodes[n].inverse * impulse;
  }
  for (const RopeContactRow& contact_row : b_.ropes.contact_rows) {
    if (contact_row.body < 0 || !contact_row.active) continue;
    RopeNode& node = b_.ropes.nodes[contact_row.node];
    const DVec3 surface = b_.moving[contact_row.body].velocity_at(contact_row.lever);
    node.u += node.inverse * (contact_stiffness(contact_row) * surface);
  }
}

/// Share of the displacement that moves no body by more than an overlap may be removed, and turns no segment
/// so far that its length changes: what is wedged in would go far for little. 0 if it is no number.
double CoupledGroupSolution::displaced_share() const {
  double most = 1;
  const auto allow = [&](DVec3 displacement, double length_allowed) {
    const double over = length(displacement) / length_allowed;
    if (!(over <= most)) most = over;  // also if it is no number
  };
  for (const CoupledBody& m : b_.moving) allow(m.v, kDirectLargestPush);
  for (const RopeNode& node : b_.ropes.nodes) allow(node.u, kDirectLargestPush);
  for (const RopeSegment& segment : b_.ropes.segments) {
    allow(b_.ropes.nodes[segment.a + 1].u - b_.ropes.nodes[segment.a].u,
          kMostSegmentPush * segment.traits.rest);
  }
  return std::isfinite(most) ? 1 / most : 0;
}

/// Moves everything to where overlaps are half as deep, without adding velocity. Hooks and ropes keep what
/// gaps and lengths they have.
void CoupledGroupSolution::remove_overlaps(const std::vector<RopeSystem>& rope_systems) {
  if (!is_sound() || !find_overlaps()) return;
  std::fill(b_.sliding.begin(), b_.sliding.end(), SlidingRow{});
  assemble();
  factor(b_.pattern, b_.numbers, b_.factor_scratch);
  fill_pushes();
  solve(b_.pattern, b_.numbers, b_.right_side);
  read_displacement();
  const double share = displaced_share();
  displace_bodies(share);
  displace_nodes(share, rope_systems);
}

void CoupledGroupSolution::displace_bodies(double share) {
  for (std::size_t i = 0; i < b_.moving.size(); ++i) {
    const CoupledBody& of = b_.moving[i];
    const std::uint32_t body = b_.bodies[i];
    state::MotionRecord& m = t_.bodies.motion[body];
    const DVec3 turn = share * (of.body.scale * of.omega_scaled);
    m.dx += vector_cast<Real>(share * of.v);
    m.theta_scaled += vector_cast<Real>(math::inverse(math::in_double(t_.bodies.scale[body])) * turn);
    if (is_gyroscopic_now(t_.bodies, body)) {
      t_.bodies.rotation[body] =
          normalize(math::quaternion_of(vector_cast<Real>(turn)) * t_.bodies.rotation[body]);
    }
  }
}

/// Ropes and points follow what they hang on and touch.
void CoupledGroupSolution::displace_nodes(double share, const std::vector<RopeSystem>& rope_systems) {
  std::size_t node = 0;
  const auto displace = [&](std::uint32_t particle) {
    const RopeNode& of = b_.ropes.nodes[node++];
    if (of.w > 0) t_.particles.position[particle].x += vector_cast<Real>(share * of.u);
  };
  for (const std::uint32_t c : b_.rope_systems) {
    for (std::uint32_t i = 0; i < rope_systems[c].node_count; ++i)
      displace(rope_systems[c].first_particle + i);
  }
  for (const std::uint32_t p : b_.points) displace(p);
}

}  // namespace hooke::solver
