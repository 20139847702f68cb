#include "solver/contact/direct_contacts.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/contact/contact_tuning.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>

namespace hooke::solver {

namespace {

using state::Bodies;

void find_blocks(const BlockPattern& p, DirectContact& c) {
  HOOKE_ASSERT(c.a < p.order.size() && c.a != c.b);
  c.diagonal_a = p.block[p.column_begin[c.a]].offset;
  if (c.b == DirectContact::kNone) return;
  c.diagonal_b = p.block[p.column_begin[c.b]].offset;
  c.b_is_row = c.b > c.a;
  c.between = p.block[find_block(p, std::max(c.a, c.b), std::min(c.a, c.b))].offset;
}

/// How fast the energy grows along the search direction, after a share t of it.
double climb(double t, DirectIsland& island) {
  double sum = 0;
  for (std::size_t i = 0; i < island.velocity.size(); ++i) {
    const double d = island.direction[i];
    sum += d * (island.velocity[i] - island.free[i] + t * d);
  }
  for (const DirectContact& c : island.contacts) {
    respond(t, c, island.rows);
    for (int i = c.first; i < c.end(); ++i) sum -= island.rows[i].impulse * island.rows[i].slope;
  }
  return sum;
}

void add_block(double d, const DirectLever& left, const DirectLever& right, double* block) {
  for (int r = 0; r < 6; ++r) {
    const double factor = d * left[r];
    for (int c = 0; c < 6; ++c) block[6 * r + c] += factor * right[c];
  }
}

/// H += d j j^T
void add_row(double d, const DirectContact& c, const DirectLever& a, const DirectLever& b,
             std::vector<double>& h) {
  add_block(d, a, a, &h[c.diagonal_a]);
  if (c.b == DirectContact::kNone) return;
  add_block(d, b, b, &h[c.diagonal_b]);
  add_block(d, c.b_is_row ? b : a, c.b_is_row ? a : b, &h[c.between]);
}

/// Factors 1 + J^T D J over the rows that hold, and over friction that slides if `slides`.
void make_factors(bool slides, DirectIsland& island, std::vector<double>& h) {
  const BlockPattern& p = island.pattern;
  h.assign(p.number_count, 0.0);
  for (int node = 0; node < p.node_count(); ++node) {
    double* diagonal = &h[p.block[p.column_begin[node]].offset];
    for (int i = 0; i < 6; ++i) diagonal[7 * i] = 1;
  }
  for (const DirectContact& c : island.contacts) {
    for (const DirectRow& row : island.rows_of(c)) {
      if (row.holds) add_row(row.stiffness, c, row.a, row.b, h);
    }
    if (!slides) continue;
    const SlidingRow sliding = sliding_row(c, island);
    if (sliding.stiffness > 0) add_row(sliding.stiffness, c, sliding.a, sliding.b, h);
  }
  factor(p, h, island.factor_scratch);
  island.work += p.operations;
}

double largest(const std::vector<double>& x) {
  double most = 0;
  for (const double number : x) most = std::max(most, std::abs(number));
  return most;
}

/// Computes impulses and the downhill direction at the present velocities. True if nothing is left to go.
bool evaluate(DirectIsland& island) {
  for (std::size_t i = 0; i < island.velocity.size(); ++i)
    island.direction[i] = island.free[i] - island.velocity[i];
  find_rates(island.velocity, island);
  for (const DirectContact& c : island.contacts) {
    respond(0, c, island.rows);
    add_impulses(island, c, &DirectRow::impulse, island.direction);
  }
  double done = 0;
  for (std::size_t i = 0; i < island.velocity.size(); ++i)
    done = std::max(done, std::abs(island.velocity[i] - island.free[i]));
  return largest(island.direction) <= kDirectTolerance * done;
}

/// The share of the search direction where the energy is least.
double search(DirectIsland& island) {
  for (const DirectContact& c : island.contacts) {
    for (int i = c.first; i < c.end(); ++i)
      island.rows[i].slope = rate_of(c, island.rows[i], island.direction);
  }
  return find_least([&](double t) { return climb(t, island); });
}

/// Makes one pass over the rows of a contact.
void sweep_contact(const DirectContact& c, DirectIsland& island) {
  const std::span<DirectRow> rows = island.rows_of(c);
  const auto points = static_cast<std::size_t>(c.points);
  const auto push = [&](DirectRow& row, double impulse) {
    const double change = impulse - row.impulse;
    row.impulse = impulse;
    add_lever(change, row.a, &island.velocity[6 * c.a]);
    if (c.b != DirectContact::kNone) add_lever(change, row.b, &island.velocity[6 * c.b]);
  };
  const auto wish = [&](const DirectRow& row) {
    return row.impulse - row.mass * (rate_of(c, row, island.velocity) + row.drift);
  };
  double load = 0;
  double twist_limit = 0;
  for (DirectRow& row : rows.first(points)) {
    push(row, std::max(0.0, wish(row)));
    load += row.impulse;
    twist_limit += row.impulse * row.twist_lever;
  }
  const double limit = load * c.friction;
  push(rows[points + 2], std::clamp(wish(rows[points + 2]), -twist_limit, twist_limit));
  const double x = wish(rows[points]);
  const double y = wish(rows[points + 1]);
  const double size = std::sqrt(x * x + y * y);
  const double shrink = size > limit ? limit / size : 1;
  push(rows[points], shrink * x);
  push(rows[points + 1], shrink * y);
}

/// Computes the velocities if just the guessed rows hold, even by pulling. From there on impulses are of the
/// right size, and few Newton steps are needed. From anywhere else each step ends where one contact of many
/// changes. Factors are used again as long as the guess is the same.
void jump(Guess guess, DirectIsland& island) {
  find_rates(island.velocity, island);
  for (std::size_t i = 0; i < island.velocity.size(); ++i)
    island.direction[i] = island.free[i] - island.velocity[i];
  guess_rows(guess, island);
  bool same = island.cached_stiffness == island.stiffness && island.cached_holds.size() == island.rows.size();
  island.cached_holds.resize(island.rows.size());
  for (std::size_t i = 0; i < island.rows.size(); ++i) {
    DirectRow& row = island.rows[i];
    same = same && island.cached_holds[i] == static_cast<std::uint8_t>(row.holds);
    island.cached_holds[i] = static_cast<std::uint8_t>(row.holds);
    row.impulse = row.holds ? row.before - row.stiffness * row.rate : row.before;
  }
  if (!same) make_factors(false, island, island.cached_factors);
  island.cached_stiffness = island.stiffness;
  for (const DirectContact& c : island.contacts)
    add_impulses(island, c, &DirectRow::impulse, island.direction);
  solve(island.pattern, island.cached_factors, island.direction);
  for (std::size_t k = 0; k < island.velocity.size(); ++k) island.velocity[k] += island.direction[k];
}

/// Makes Newton steps with limits of friction as they are. False if they do not converge.
bool descend(int steps, DirectIsland& island) {
  for (int i = 0; i < steps; ++i) {
    if (evaluate(island)) return true;
    if (island.work > island.most_work) return false;
    make_factors(true, island, island.factors);
    solve(island.pattern, island.factors, island.direction);
    const double t = search(island);
    for (std::size_t k = 0; k < island.velocity.size(); ++k) island.velocity[k] += t * island.direction[k];
  }
  return evaluate(island);
}

/// The six numbers of a node.
double* numbers_of(std::uint32_t i, const DirectIsland& island, std::vector<double>& u) {
  HOOKE_ASSERT(6 * (std::size_t{island.slot[i]} + 1) <= u.size());
  return &u[6 * island.slot[i]];
}

/// Reads v / sqrt(w) or dx / sqrt(w), with their angular halves, for all nodes.
template <class Read>
void read_nodes(const Bodies& bodies, Read&& read, const DirectIsland& island, std::vector<double>& u) {
  for (std::uint32_t i = 0; i < island.graph.bodies.size(); ++i) {
    const std::uint32_t body = island.graph.bodies[i];
    const auto [linear, angular] = read(body);
    HOOKE_ASSERT(is_moved(bodies, body));
    const double scale = 1 / std::sqrt(static_cast<double>(bodies.motion[body].inverse_mass));
    const DirectLever numbers = scaled_lever(scale, linear, 1, angular);
    std::copy(numbers.begin(), numbers.end(), numbers_of(i, island, u));
  }
}

/// Adds what rolling resistance did in the last substep; the velocities that relaxation starts from contain
/// it.
void add_rolling(const DirectContact& c, const BodyContacts& contacts, const Bodies& bodies,
                 std::vector<double>& u) {
  const ContactBlock& block = contacts.blocks[c.block];
  for (int i = 0; i < block.rolling_count; ++i) {
    const RollingRow& row = contacts.rolling[block.first_rolling + i];
    if (row.lane != c.lane) continue;
    const Vec3 on_a = bodies.scale[block.record_a[c.lane] / 16] * row.impulse;
    add_lever(1, scaled_lever(0, {}, -1, on_a), &u[6 * c.a]);
    if (c.b == DirectContact::kNone) continue;
    add_lever(1, scaled_lever(0, {}, 1, bodies.scale[block.record_b[c.lane] / 16] * row.impulse),
              &u[6 * c.b]);
  }
}

void load_island(double h, const BodyContacts& contacts, const Bodies& bodies, DirectIsland& island) {
  load_impulses(contacts, island);
  load_drifts(contacts, bodies, island);
  const auto displacement = [&](std::uint32_t body) {
    return std::pair{bodies.motion[body].dx, bodies.motion[body].theta_scaled};
  };
  read_nodes(bodies, displacement, island, island.velocity);
  open_gaps(h, contacts, bodies, island.velocity, island);
  const auto free = [&](std::uint32_t body) {
    return std::pair{bodies.free_motion[body].v, bodies.free_motion[body].omega_scaled};
  };
  read_nodes(bodies, free, island, island.free);
  for (const DirectContact& c : island.contacts) add_rolling(c, contacts, bodies, island.free);
  island.velocity = island.free;
  for (const DirectContact& c : island.contacts) add_impulses(island, c, &DirectRow::before, island.velocity);
}

/// The linear half of a node's numbers, and the angular one.
std::pair<Vec3, Vec3> halves(const double* u, Real inverse_mass) {
  const double root = std::sqrt(static_cast<double>(inverse_mass));
  const auto r = [](double x) { return static_cast<Real>(x); };
  return {{r(root * u[0]), r(root * u[1]), r(root * u[2])}, {r(u[3]), r(u[4]), r(u[5])}};
}

void store_island(DirectIsland& island, BodyContacts& contacts, Bodies& bodies) {
  for (std::uint32_t i = 0; i < island.graph.bodies.size(); ++i) {
    state::MotionRecord& m = bodies.motion[island.graph.bodies[i]];
    const auto [linear, angular] = halves(numbers_of(i, island, island.velocity), m.inverse_mass);
    m.v = linear;
    m.omega_scaled = angular;
  }
  for (const DirectContact& c : island.contacts) {
    ContactBlock& block = contacts.blocks[c.block];
    const DirectRow* row = &island.rows[c.first];
    const DirectRow* friction = row + c.points;
    for (int k = 0; k < c.points; ++k) block.point[k].impulse[c.lane] = static_cast<Real>(row[k].impulse);
    for (int i = 0; i < 2; ++i) block.friction_impulse[i][c.lane] = static_cast<Real>(friction[i].impulse);
    block.twist_impulse[c.lane] = static_cast<Real>(friction[2].impulse);
    Real load = Real(0);
    for (int k = 0; k < c.points; ++k) load += block.point[k].impulse[c.lane];
    block.pushed[c.lane] = std::max(block.pushed[c.lane], load);
  }
}

/// Moves bodies out of each other without adding velocity.
void remove_overlap(DirectIsland& island, Bodies& bodies) {
  bool any = false;
  std::fill(island.direction.begin(), island.direction.end(), 0.0);
  for (const DirectContact& c : island.contacts) {
    for (int i = c.first; i < c.end(); ++i) {
      DirectRow& row = island.rows[i];
      const bool overlaps = i < c.first + c.points && row.separation < -c.slop;
      any = any || overlaps;
      row.slope =
          overlaps ? row.stiffness * std::min(kDirectLargestPush, -kDirectPushOut * row.separation) : 0;
      row.holds = row.holds || overlaps;
    }
    add_impulses(island, c, &DirectRow::slope, island.direction);
  }
  if (!any) return;
  make_factors(false, island, island.factors);
  solve(island.pattern, island.factors, island.direction);
  for (std::uint32_t i = 0; i < island.graph.bodies.size(); ++i) {
    const std::uint32_t body = island.graph.bodies[i];
    state::MotionRecord& m = bodies.motion[body];
    const auto [displacement, turn] = halves(numbers_of(i, island, island.direction), m.inverse_mass);
    m.dx += displacement;
    m.theta_scaled += turn;
    if (is_gyroscopic(bodies.mass[body])) {
      bodies.rotation[body] =
          normalize(math::quaternion_of(bodies.scale[body] * turn) * bodies.rotation[body]);
    }
  }
}

/// How a solution is searched for.
struct Attempt {
  double stiffness = kDirectStiffness;  ///< D over effective masses.
  Guess guess = Guess::kSame;
  int steps = 0;
};

/// Finds the solution, with friction by its own loads. False if it is not found.
bool converge(const Attempt& attempt, DirectIsland& island) {
  island.stiffness = attempt.stiffness;
  set_stiffness(attempt.stiffness, island);
  limit_friction(island);
  jump(attempt.guess, island);
  for (int round = 0; round < kDirectFrictionRounds; ++round) {
    if (!descend(attempt.steps, island)) return false;
    if (!limit_friction(island)) break;
  }
  return true;
}

/// Sweeps row by row, from the impulses of the last substep. That is no solution, but a step toward it that
/// gains no energy.
void sweep_rows(DirectIsland& island) {
  island.velocity = island.free;
  for (DirectRow& row : island.rows) row.impulse = row.before;
  for (const DirectContact& c : island.contacts) add_impulses(island, c, &DirectRow::before, island.velocity);
  for (int i = 0; i < kDirectSweeps; ++i) {
    for (const DirectContact& c : island.contacts) sweep_contact(c, island);
  }
}

}  // namespace

std::uint32_t node_of(const std::vector<std::uint32_t>& bodies, std::uint32_t body) {
  HOOKE_ASSERT(std::binary_search(bodies.begin(), bodies.end(), body));
  return static_cast<std::uint32_t>(std::lower_bound(bodies.begin(), bodies.end(), body) - bodies.begin());
}

void prepare_direct_rows(const BodyContacts& contacts, const Bodies& bodies, DirectIsland& island) {
  island.contacts.clear();
  island.rows.clear();
  island.cached_stiffness = 0;
  island.work = 0;
  for (const ContactLane& at : island.lanes) {
    const ContactBlock& block = contacts.blocks[at.block];
    DirectContact c = {.block = at.block, .lane = at.lane, .points = count_points(block, at.lane)};
    c.a = island.slot[node_of(island.graph.bodies, block.record_a[at.lane] / 16)];
    if (!block.anchored) c.b = island.slot[node_of(island.graph.bodies, block.record_b[at.lane] / 16)];
    find_blocks(island.pattern, c);
    add_contact(block, bodies, c, island);
  }
  const std::size_t size = 6 * island.graph.bodies.size();
  for (std::vector<double>* x : {&island.free, &island.velocity, &island.direction}) x->resize(size);
}

void solve_direct_island(const BodyStep& step, DirectIsland& island, BodyContacts& contacts, Bodies& bodies) {
  load_island(static_cast<double>(step.h), contacts, bodies, island);
  const int steps = island.newton_steps;
  const Attempt attempts[] = {{.steps = kDirectQuickSteps},
                              {.guess = Guess::kAll, .steps = steps},
                              {.stiffness = kDirectSofterStiffness, .guess = Guess::kAll, .steps = steps}};
  const bool solved = std::any_of(std::begin(attempts), std::end(attempts),
                                  [&](const Attempt& attempt) { return converge(attempt, island); });
  if (!solved) sweep_rows(island);
  store_island(island, contacts, bodies);
  if (step.first) remove_overlap(island, bodies);
}

}  // namespace hooke::solver
