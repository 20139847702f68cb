#include "solver/articulations.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/geometric_stiffness.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::Hook;
using state::HookPlace;

constexpr int kMaxSolves = 4;
constexpr double kFastTurn = 0.03;           ///< In a substep, from which on rows are not straight [rad].
constexpr double kLargeError = 2e-4;         ///< Gap of a joint over its levers, or its angle [rad].
constexpr double kComplianceOfTrees = 1e-9;  ///< Share of each diagonal.
constexpr double kComplianceOfLoops = 1e-5;
constexpr int kMostHooks = 8;  ///< Of a body that is not divided.
constexpr int kHooksOfPart = 4;
constexpr int kWeldRows = 6;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

double sign_at(const Articulation::Joint& joint, std::uint32_t link) {
  return link == joint.a ? -1 : 1;
}

const DVec3& lever_at(const Articulation::Joint& joint, std::uint32_t link, const JointRow& row) {
  return link == joint.a ? row.j_a : row.j_b;
}

std::uint32_t link_of(const std::vector<std::uint32_t>& bodies, std::uint32_t body) {
  return static_cast<std::uint32_t>(std::lower_bound(bodies.begin(), bodies.end(), body) - bodies.begin());
}

/// What is to be joined by rows: links, and the two of each joint.
struct Frame {
  std::vector<std::uint32_t> bodies;
  std::vector<double> parts;
  std::vector<Articulation::Joint> joints;  ///< Hooks as they come, then welds.
};

/// Links of all bodies of the hooks; divides those of many hooks.
Frame make_frame(const std::vector<std::uint32_t>& hook_rows, const std::vector<Hook>& hooks,
                 const state::Bodies& bodies) {
  std::vector<std::uint32_t> body_of;
  for (const std::uint32_t i : hook_rows) body_of.insert(body_of.end(), {hooks[i].a.body, hooks[i].b.body});
  std::sort(body_of.begin(), body_of.end());
  Frame frame;
  for (auto at = body_of.begin(); at != body_of.end();) {
    const auto next = std::upper_bound(at, body_of.end(), *at);
    const auto count = static_cast<int>(next - at);
    const bool divided = is_dynamic(bodies, *at) && count > kMostHooks;
    const int parts = divided ? (count + kHooksOfPart - 1) / kHooksOfPart : 1;
    frame.bodies.insert(frame.bodies.end(), static_cast<std::size_t>(parts), *at);
    frame.parts.insert(frame.parts.end(), static_cast<std::size_t>(parts), parts);
    at = next;
  }
  std::vector<int> taken(frame.bodies.size(), 0);
  const auto next_link = [&](std::uint32_t body) {
    const std::uint32_t first = link_of(frame.bodies, body);
    if (frame.parts[first] == 1) return first;
    return first + static_cast<std::uint32_t>(taken[first]++ / kHooksOfPart);
  };
  for (const std::uint32_t i : hook_rows) {
    const std::uint32_t a = next_link(hooks[i].a.body);
    frame.joints.push_back({.hook = i, .a = a, .b = next_link(hooks[i].b.body)});
  }
  for (std::uint32_t link = 1; link < frame.bodies.size(); ++link) {
    if (frame.bodies[link] == frame.bodies[link - 1])
      frame.joints.push_back({.hook = Articulation::kWeld, .a = link - 1, .b = link});
  }
  return frame;
}

/// Joints of each link that moves.
std::vector<std::vector<std::uint32_t>> joints_of_links(const Frame& frame, const state::Bodies& bodies) {
  std::vector<std::vector<std::uint32_t>> of(frame.bodies.size());
  for (std::uint32_t i = 0; i < frame.joints.size(); ++i) {
    for (const std::uint32_t link : {frame.joints[i].a, frame.joints[i].b}) {
      if (is_dynamic(bodies, frame.bodies[link])) of[link].push_back(i);
    }
  }
  return of;
}

/// More joints than a tree of these links can have.
bool has_loops(const Frame& frame, const state::Bodies& bodies) {
  const auto moves = [&](std::uint32_t link) { return is_dynamic(bodies, frame.bodies[link]); };
  std::ptrdiff_t moving = 0;
  for (std::uint32_t link = 0; link < frame.bodies.size(); ++link) moving += moves(link) ? 1 : 0;
  const bool grounded = std::any_of(frame.joints.begin(), frame.joints.end(),
                                    [&](const auto& joint) { return !moves(joint.a) || !moves(joint.b); });
  return static_cast<std::ptrdiff_t>(frame.joints.size()) > moving - (grounded ? 0 : 1);
}

void list_couplings(const state::Bodies& bodies, Articulation& art) {
  for (std::uint32_t k = 0; k < art.pattern.block.size(); ++k) {
    const Articulation::Joint& left = art.joints[art.pattern.block[k].row];
    const Articulation::Joint& right = art.joints[art.pattern.block[k].column];
    for (const std::uint32_t link : {left.a, left.b}) {
      if (link != right.a && link != right.b) continue;
      if (is_dynamic(bodies, art.bodies[link])) art.couplings.push_back({k, link});
    }
  }
}

/// An equal part of a body moves as the body does.
void divide(double parts, JointBody& body) {
  if (parts == 1) return;
  const double root = std::sqrt(parts);
  body.inverse_mass *= parts;
  body.scale = scaled(root, body.scale);
  body.omega_scaled = (1 / root) * body.omega_scaled;
}

/// Both links have one velocity.
void make_weld(const Articulation::Joint& joint, Articulation& art) {
  const std::array<DVec3, 3> axes = {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}};
  for (int k = 0; k < kWeldRows; ++k) {
    JointRow row = {.low = -kUnbounded, .high = kUnbounded};
    const DVec3& axis = axes[k % 3];
    (k < 3 ? row.n : row.axis) = axis;
    if (k >= 3) {
      row.j_a = art.links[joint.a].body.scale * axis;
      row.j_b = art.links[joint.b].body.scale * axis;
    }
    art.rows[joint.first + k] = row;
    art.bound[joint.first + k] = 0;
  }
}

void load_links(const state::Bodies& bodies, Articulation& art) {
  for (std::size_t i = 0; i < art.bodies.size(); ++i) {
    Link& link = art.links[i];
    link.body = joint_body_now(bodies, art.bodies[i]);
    divide(art.parts[i], link.body);
    link.stiffness = {};
    link.excess = {};
    link.response = link.body.inverse_mass > 0 ? Symmetric3<double>::diagonal(1) : Symmetric3<double>{};
  }
}

void make_rows(double h, std::vector<Hook>& hooks, Articulation& art) {
  std::array<JointRow, Hook::kMaxRows> rows;
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.is_weld()) {
      make_weld(joint, art);
      continue;
    }
    Hook& hook = hooks[joint.hook];
    const int count = make_joint_rows(hook, art.links[joint.a].body, art.links[joint.b].body, h, rows);
    HOOKE_ASSERT(count == joint.count);
    for (int k = 0; k < count; ++k) {
      const JointRow& row = rows[k];
      art.rows[joint.first + k] = row;
      art.bound[joint.first + k] = first_bound(row, static_cast<double>(hook.row_impulse[k]));
    }
  }
}

/// The body as it will be at the end of the substep with the velocity that was found.
JointBody moved(const Link& link, double h) {
  JointBody body = link.body;
  body.ahead = h * link.v;
  body.center += body.ahead;
  body.rotation = math::quaternion_of(body.scale * (h * link.omega_scaled)) * body.rotation;
  return body;
}

/// What the gap of a joint is small against: its levers on bodies that move [m].
double size_of(const Hook& hook, const Link& a, const Link& b) {
  constexpr double kLeast = 0.01;
  const double size_a = a.body.inverse_mass > 0 ? length(hook.a.anchor) : 0;
  const double size_b = b.body.inverse_mass > 0 ? length(hook.b.anchor) : 0;
  return std::max(kLeast, size_a + size_b);
}

/// Newton: the rows about the end of the substep as it was found, where C = c + h J (v' - v) for another
/// velocity v'. Returns the largest error of a lock.
double make_rows_ahead(double h, std::vector<Hook>& hooks, Articulation& art) {
  std::array<JointRow, Hook::kMaxRows> rows;
  double worst = 0;
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.is_weld()) continue;
    const Link& a = art.links[joint.a];
    const Link& b = art.links[joint.b];
    const double size = size_of(hooks[joint.hook], a, b);
    make_joint_rows(hooks[joint.hook], moved(a, h), moved(b, h), h, rows);
    for (int k = 0; k < joint.count; ++k) {
      JointRow row = rows[k];
      // An error beyond the speed limit comes back along the row it has.
      const bool limited =
          row.role == RowRole::kLock && std::abs(row.target) < 0.999 * row.rate * std::abs(row.c);
      if (limited) continue;
      const double v = dot(row.n, b.v - a.v) + dot(row.j_b, b.omega_scaled) - dot(row.j_a, a.omega_scaled);
      row.target += row.rate * h * v;
      art.rows[joint.first + k] = row;
      if (row.role == RowRole::kLock)
        worst = std::max(worst, std::abs(row.c) / (row.axis == DVec3{} ? size : 1));
    }
  }
  return worst;
}

bool turns_fast(const Articulation& art, double h) {
  return std::any_of(art.links.begin(), art.links.end(), [&](const Link& link) {
    return link.body.inverse_mass > 0 && h * length(link.body.scale * link.omega_scaled) > kFastTurn;
  });
}

/// Writes the stiffness of all links under the impulses of their hooks, where it grows; true if it grew so
/// much that a solution found without it is not to be trusted.
bool stiffen(double h, const std::vector<Hook>& hooks, Articulation& art) {
  std::vector<Symmetric3<double>>& found = art.stiffness_found;
  found.assign(art.links.size(), {});
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.is_weld()) continue;
    const Hook& hook = hooks[joint.hook];
    const DVec3 force = (1 / h) * vector_cast<double>(hook.impulse);
    if (force == DVec3{}) continue;
    Link& a = art.links[joint.a];
    Link& b = art.links[joint.b];
    const DVec3 r_a = rotate(a.body.rotation, hook.a.anchor);
    const DVec3 r_b = rotate(b.body.rotation, hook.b.anchor);
    if (a.body.inverse_mass > 0) found[joint.a] = found[joint.a] + stiffness_of(r_a, -force, a.body, h);
    if (b.body.inverse_mass > 0) found[joint.b] = found[joint.b] + stiffness_of(r_b, force, b.body, h);
  }
  bool grew = false;
  for (std::size_t i = 0; i < art.links.size(); ++i) {
    Link& link = art.links[i];
    if (!(link.body.inverse_mass > 0) || !(trace(found[i]) > trace(link.stiffness))) continue;
    grew = grew || trace(found[i]) > std::max(kStiffnessGrowth * trace(link.stiffness), kStiffnessLeft);
    link.stiffness = found[i];
    link.excess = excess_of(found[i]);
    link.response =
        math::inverse(Symmetric3<double>::diagonal(1) + scaled(1 + kStiffnessDamping, link.excess));
  }
  return grew;
}

/// A motor that is at no bound holds the velocity along its axis, which gives the impulse of the spring
/// there.
void give_springs(Articulation& art) {
  for (const Articulation::Joint& joint : art.joints) {
    for (int i = joint.first; i + 1 < joint.first + joint.count; ++i) {
      const JointRow& spring = art.rows[i];
      const JointRow& motor = art.rows[i + 1];
      if (spring.role != RowRole::kSpring || motor.role != RowRole::kMotor) continue;
      if (!(spring.n == motor.n) || !(spring.axis == motor.axis)) continue;
      art.bound[i] = art.bound[i + 1] == 0 ? Articulation::kGiven : std::int8_t{0};
      if (art.bound[i] != 0) art.lambda[i] = (spring.target - motor.target) / spring.gamma;
    }
  }
}

/// Lists the rows that are at no bound, those of a joint column by column.
void list_free_rows(Articulation& art) {
  art.free.clear();
  art.free_sizes.clear();
  art.columns.clear();
  for (const Articulation::Joint& joint : art.joints) {
    const std::size_t begin = art.free.size();
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      if (art.bound[i] == 0) art.free.push_back(i);
    }
    const auto rows = std::span(art.free).subspan(begin);
    art.free_sizes.push_back(static_cast<int>(rows.size()));
    for (const auto member : {&JointRow::n, &JointRow::j_a, &JointRow::j_b}) {
      for (const auto axis : {&DVec3::x, &DVec3::y, &DVec3::z}) {
        for (const int i : rows) art.columns.push_back(art.rows[i].*member.*axis);
      }
    }
  }
  resize_blocks(art.free_sizes, art.pattern);
}

/// The part of a link in the block of two joints' rows.
void add_coupling(const Articulation::Coupling& coupling, Articulation& art) {
  const BlockPattern::Block& block = art.pattern.block[coupling.block];
  const Articulation::Joint& left = art.joints[block.row];
  const Articulation::Joint& right = art.joints[block.column];
  const Link& link = art.links[coupling.link];
  const double sign = sign_at(left, coupling.link) * sign_at(right, coupling.link);
  const int* rows = art.free.data() + art.pattern.first[block.row];
  const auto count = static_cast<std::size_t>(art.free_sizes[block.column]);
  const double* n = art.columns.data() + 9 * static_cast<std::size_t>(art.pattern.first[block.column]);
  const double* j = n + (coupling.link == right.a ? 3 : 6) * count;
  double* to = art.factors.data() + block.offset;
  for (int r = 0; r < art.free_sizes[block.row]; ++r) {
    const JointRow& row = art.rows[rows[r]];
    const DVec3 v = sign * link.body.inverse_mass * row.n;
    const DVec3 w = sign * (link.response * lever_at(left, coupling.link, row));
    for (std::size_t c = 0; c < count; ++c) {
      to[c] += (v.x * n[c] + v.y * n[count + c] + v.z * n[2 * count + c]) +
               (w.x * j[c] + w.y * j[count + c] + w.z * j[2 * count + c]);
    }
    to += count;
  }
}

/// J M^-1 J^T + gamma of the free rows: impulses at bounds are in the velocities already.
void assemble(Articulation& art) {
  art.factors.assign(art.pattern.number_count, 0.0);
  for (const Articulation::Coupling& coupling : art.couplings) add_coupling(coupling, art);
  const double compliance = art.has_loops ? kComplianceOfLoops : kComplianceOfTrees;
  for (int i = 0; i < art.pattern.node_count(); ++i) {
    const BlockPattern::Block& block = art.pattern.block[art.pattern.column_begin[i]];
    const int n = art.free_sizes[i];
    for (int r = 0; r < n; ++r) {
      double& number = art.factors[block.offset + static_cast<std::size_t>(r * (n + 1))];
      number += art.rows[art.free[art.pattern.first[i] + r]].gamma + compliance * number;
    }
  }
}

/// Velocities of all links under the impulses of the rows that `which` picks.
template <class Which>
void apply_rows(Which&& which, Articulation& art) {
  for (const Articulation::Joint& joint : art.joints) {
    Link& a = art.links[joint.a];
    Link& b = art.links[joint.b];
    DVec3 linear;
    DVec3 angular_a;
    DVec3 angular_b;
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      if (!which(i)) continue;
      const double lambda = art.lambda[i];
      linear += lambda * art.rows[i].n;
      angular_a += lambda * art.rows[i].j_a;
      angular_b += lambda * art.rows[i].j_b;
    }
    a.v -= a.body.inverse_mass * linear;
    a.omega_scaled -= a.response * angular_a;
    b.v += b.body.inverse_mass * linear;
    b.omega_scaled += b.response * angular_b;
  }
}

void reset_velocities(Articulation& art) {
  for (Link& link : art.links) {
    link.v = link.body.v;
    link.omega_scaled = link.body.omega_scaled;
    if (trace(link.excess) > 0)
      link.omega_scaled -= kStiffnessDamping * (link.response * (link.excess * link.body.omega_scaled));
  }
}

/// What a row lacks of its target at the present velocities, without gamma lambda.
double shortfall(const Articulation& art, const Articulation::Joint& joint, const JointRow& row) {
  const Link& a = art.links[joint.a];
  const Link& b = art.links[joint.b];
  return row.target - dot(row.n, b.v - a.v) - dot(row.j_b, b.omega_scaled) + dot(row.j_a, a.omega_scaled);
}

void solve_free_rows(Articulation& art) {
  for (std::size_t i = 0; i < art.rows.size(); ++i) {
    art.lambda[i] = art.bound[i] < 0 ? art.rows[i].low : art.bound[i] > 0 ? art.rows[i].high : 0;
  }
  give_springs(art);
  reset_velocities(art);
  apply_rows([&](int i) { return art.bound[i] != 0; }, art);
  list_free_rows(art);
  assemble(art);
  art.right_side.clear();
  for (const Articulation::Joint& joint : art.joints) {
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      if (art.bound[i] == 0) art.right_side.push_back(shortfall(art, joint, art.rows[i]));
    }
  }
  factor(art.pattern, art.factors, art.factor_scratch);
  solve(art.pattern, art.factors, art.right_side);
  for (std::size_t k = 0; k < art.free.size(); ++k) art.lambda[art.free[k]] = art.right_side[k];
  apply_rows([&](int i) { return art.bound[i] == 0; }, art);
}

/// Rows beyond a bound go to it; rows that the bound holds back are let go if `release`. True if any changed.
bool revise_bounds(bool release, Articulation& art) {
  bool changed = false;
  for (const Articulation::Joint& joint : art.joints) {
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      const JointRow& row = art.rows[i];
      std::int8_t bound = 0;
      if (art.bound[i] == Articulation::kGiven) continue;
      if (art.bound[i] == 0) {
        bound = side_of(art.lambda[i], row.low, row.high);
      } else if (!release) {
        continue;
      } else {
        const double lacks = shortfall(art, joint, row) - row.gamma * art.lambda[i];
        bound = stays_at(art.bound[i], lacks) ? art.bound[i] : std::int8_t{0};
      }
      changed = changed || bound != art.bound[i];
      art.bound[i] = bound;
    }
  }
  return changed;
}

void solve_with_bounds(Articulation& art) {
  bool changed = true;
  for (int pass = 0; changed && pass < kMostBoundPasses; ++pass) {
    solve_free_rows(art);
    changed = revise_bounds(pass < kFreeBoundPasses, art);
  }
  if (!changed) return;
  for (std::size_t i = 0; i < art.rows.size(); ++i)
    art.lambda[i] = std::clamp(art.lambda[i], art.rows[i].low, art.rows[i].high);
  reset_velocities(art);
  apply_rows([](int) { return true; }, art);
}

void store_impulses(const Articulation& art, std::vector<Hook>& hooks) {
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.is_weld()) continue;
    const auto first = static_cast<std::size_t>(joint.first);
    const auto count = static_cast<std::size_t>(joint.count);
    store_joint_impulses(std::span(art.rows).subspan(first, count),
                         std::span(art.lambda).subspan(first, count), hooks[joint.hook]);
  }
}

/// The parts of a body differ by rounding: their mean has all of its momentum.
void store_velocities(const Articulation& art, state::Bodies& bodies) {
  for (std::size_t i = 0; i < art.links.size();) {
    const auto parts = static_cast<std::size_t>(art.parts[i]);
    JointBody before = art.links[i].body;
    if (before.inverse_mass > 0) {
      DVec3 v;
      DVec3 omega_scaled;
      for (std::size_t k = 0; k < parts; ++k) {
        v += art.links[i + k].v;
        omega_scaled += art.links[i + k].omega_scaled;
      }
      // omega~ of the whole body is sqrt(parts) times that of each.
      const double root = std::sqrt(art.parts[i]);
      before.scale = scaled(1 / root, before.scale);
      before.omega_scaled = root * before.omega_scaled;
      set_joint_velocity(before, (1 / art.parts[i]) * v, (1 / root) * omega_scaled, art.bodies[i], bodies);
    }
    i += parts;
  }
}

}  // namespace

std::optional<Articulation> make_articulation(const std::vector<std::uint32_t>& hook_rows,
                                              const std::vector<Hook>& hooks, const state::Bodies& bodies,
                                              double budget) {
  Frame frame = make_frame(hook_rows, hooks, bodies);
  std::vector<int> sizes;
  for (const Articulation::Joint& joint : frame.joints)
    sizes.push_back(joint.is_weld() ? kWeldRows : count_joint_rows(hooks[joint.hook]));

  BlockGraph graph;
  graph.reset(frame.joints.size());
  for (const std::vector<std::uint32_t>& group : joints_of_links(frame, bodies)) {
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        if (group[j] != group[k]) graph.join(group[j], group[k]);
      }
    }
  }
  Articulation art;
  art.has_loops = has_loops(frame, bodies);
  if (!make_block_pattern(graph, sizes, art.has_loops ? budget : kTreesMayTake * budget, art.pattern))
    return std::nullopt;
  for (int i = 0; i < art.pattern.node_count(); ++i) {
    Articulation::Joint joint = frame.joints[art.pattern.order[i]];
    joint.first = art.pattern.first[i];
    joint.count = art.pattern.size[i];
    art.joints.push_back(joint);
  }
  art.bodies = std::move(frame.bodies);
  art.parts = std::move(frame.parts);
  list_couplings(bodies, art);
  art.links.resize(art.bodies.size());
  const auto row_count = static_cast<std::size_t>(art.pattern.first.back());
  art.rows.resize(row_count);
  art.lambda.resize(row_count);
  art.bound.resize(row_count);
  art.free.reserve(row_count);
  art.columns.reserve(9 * row_count);
  art.right_side.reserve(row_count);
  art.factors.reserve(art.pattern.number_count);
  art.factor_scratch.reserve(art.pattern.number_count);
  return art;
}

void solve_articulation(double h, Articulation& art, std::vector<Hook>& hooks, state::Bodies& bodies) {
  load_links(bodies, art);
  make_rows(h, hooks, art);
  stiffen(h, hooks, art);
  for (int i = 0; i < kMaxSolves; ++i) {
    solve_with_bounds(art);
    store_impulses(art, hooks);
    const bool grew = stiffen(h, hooks, art);
    const bool bent = turns_fast(art, h) && make_rows_ahead(h, hooks, art) > kLargeError;
    if (!grew && !bent) break;
  }
  store_velocities(art, bodies);
}

}  // namespace hooke::solver
