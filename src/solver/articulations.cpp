#include "solver/articulations.h"

#include "base/assert.h"
#include "math/rotation.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::Hook;
using state::HookPlace;

constexpr int kFreePasses = 8;  ///< Rows come and go.
constexpr int kMaxPasses = 16;  ///< In the rest rows only go.
constexpr int kMaxSolves = 4;
constexpr double kFastTurn = 0.03;           ///< In a substep, from which on rows are not straight [rad].
constexpr double kLargeError = 2e-4;         ///< Gap of a joint over its levers, or its angle [rad].
constexpr double kComplianceOfTrees = 1e-9;  ///< Share of each diagonal.
constexpr double kComplianceOfLoops = 1e-5;
constexpr double kStiffnessLeft = 0.5;     ///< Trace of h^2 S K S that is left explicit.
constexpr double kStiffnessDamping = 0.2;  ///< Share of the rest that acts on the velocity too.
constexpr double kStiffnessGrowth = 1.5;

double sign_at(const Articulation::Joint& joint, std::uint32_t link) {
  return link == joint.a ? -1 : 1;
}

const DVec3& lever_at(const Articulation::Joint& joint, std::uint32_t link, const JointRow& row) {
  return link == joint.a ? row.j_a : row.j_b;
}

std::uint32_t link_of(const std::vector<std::uint32_t>& bodies, std::uint32_t body) {
  return static_cast<std::uint32_t>(std::lower_bound(bodies.begin(), bodies.end(), body) - bodies.begin());
}

/// Hooks of each link that moves, by their place in `hook_rows`.
std::vector<std::vector<std::uint32_t>> hooks_of_links(const std::vector<std::uint32_t>& hook_rows,
                                                       const std::vector<Hook>& hooks,
                                                       const state::Bodies& bodies,
                                                       const std::vector<std::uint32_t>& links) {
  std::vector<std::vector<std::uint32_t>> of(links.size());
  for (std::uint32_t i = 0; i < hook_rows.size(); ++i) {
    const Hook& hook = hooks[hook_rows[i]];
    for (const std::uint32_t body : {hook.a.body, hook.b.body}) {
      if (is_dynamic(bodies, body)) of[link_of(links, body)].push_back(i);
    }
  }
  return of;
}

/// More hooks than a tree of these links can have.
bool count_loops(const std::vector<std::uint32_t>& hook_rows, const std::vector<Hook>& hooks,
                 const state::Bodies& bodies, const std::vector<std::uint32_t>& links) {
  const auto moving =
      std::count_if(links.begin(), links.end(), [&](std::uint32_t body) { return is_dynamic(bodies, body); });
  const bool grounded = std::any_of(hook_rows.begin(), hook_rows.end(), [&](std::uint32_t i) {
    return !is_dynamic(bodies, hooks[i].a.body) || !is_dynamic(bodies, hooks[i].b.body);
  });
  return static_cast<std::ptrdiff_t>(hook_rows.size()) > moving - (grounded ? 0 : 1);
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

/// The geometric stiffness of force `force` on `link` at lever r, in scaled coordinates times h^2.
Symmetric3<double> stiffness_of(DVec3 r, DVec3 force, const JointBody& body, double h) {
  const DVec3 s = normalize(r) + normalize(force);
  const double size = 0.25 * h * h * length(r) * length(force);
  const double square = length_squared(s);
  const Symmetric3<double> k = {size * (square - s.x * s.x), -size * s.x * s.y,  //
                                -size * s.x * s.z,           size * (square - s.y * s.y),
                                -size * s.y * s.z,           size * (square - s.z * s.z)};
  return math::symmetric_product(body.scale, k, body.scale);
}

double trace(const Symmetric3<double>& m) {
  return m.xx + m.yy + m.zz;
}

Symmetric3<double> scaled(double s, const Symmetric3<double>& m) {
  return {s * m.xx, s * m.xy, s * m.xz, s * m.yy, s * m.yz, s * m.zz};
}

/// The part of the stiffness that is not left explicit.
Symmetric3<double> excess_of(const Symmetric3<double>& stiffness) {
  const double size = trace(stiffness);
  return size > kStiffnessLeft ? scaled(1 - kStiffnessLeft / size, stiffness) : Symmetric3<double>{};
}

void load_links(const state::Bodies& bodies, Articulation& art) {
  for (std::size_t i = 0; i < art.bodies.size(); ++i) {
    Link& link = art.links[i];
    link.body = joint_body(bodies, art.bodies[i]);
    link.stiffness = {};
    link.excess = {};
    link.response = link.body.inverse_mass > 0 ? Symmetric3<double>::diagonal(1) : Symmetric3<double>{};
  }
}

/// -1 below the bounds, 1 above them.
std::int8_t side_of(double value, double low, double high) {
  if (value < low) return -1;
  return value > high ? std::int8_t{1} : std::int8_t{0};
}

/// Rows begin where they ended in the last substep.
std::int8_t first_bound(const JointRow& row, double last) {
  if (row.role == RowRole::kLimit) return last > 0 || row.c <= 0 ? 0 : -1;
  if (row.role != RowRole::kMotor) return 0;
  const double nearly = 0.999 * row.high;
  return side_of(last, -nearly, nearly);
}

void make_rows(double h, std::vector<Hook>& hooks, Articulation& art) {
  std::array<JointRow, Hook::kMaxRows> rows;
  for (std::size_t i = 0; i < art.hooks.size(); ++i) {
    const Articulation::Joint& joint = art.joints[i];
    Hook& hook = hooks[art.hooks[i]];
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
  for (std::size_t i = 0; i < art.hooks.size(); ++i) {
    const Articulation::Joint& joint = art.joints[i];
    const Link& a = art.links[joint.a];
    const Link& b = art.links[joint.b];
    const double size = size_of(hooks[art.hooks[i]], a, b);
    make_joint_rows(hooks[art.hooks[i]], moved(a, h), moved(b, h), h, rows);
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
  std::vector<Symmetric3<double>> found(art.links.size());
  for (std::size_t i = 0; i < art.joints.size(); ++i) {
    const Articulation::Joint& joint = art.joints[i];
    const Hook& hook = hooks[art.hooks[i]];
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

/// J M^-1 J^T + gamma.
void assemble(Articulation& art) {
  std::fill(art.matrix.begin(), art.matrix.end(), 0.0);
  for (const Articulation::Coupling& coupling : art.couplings) {
    const BlockPattern::Block& block = art.pattern.block[coupling.block];
    const Articulation::Joint& left = art.joints[block.row];
    const Articulation::Joint& right = art.joints[block.column];
    const Link& link = art.links[coupling.link];
    const double sign = sign_at(left, coupling.link) * sign_at(right, coupling.link);
    double* numbers = &art.matrix[block.offset];
    for (int c = 0; c < right.count; ++c) {
      const JointRow& row = art.rows[right.first + c];
      const DVec3 n = sign * link.body.inverse_mass * row.n;
      const DVec3 j = sign * (link.response * lever_at(right, coupling.link, row));
      for (int r = 0; r < left.count; ++r) {
        const JointRow& other = art.rows[left.first + r];
        numbers[r * right.count + c] += dot(other.n, n) + dot(lever_at(left, coupling.link, other), j);
      }
    }
  }
  const double compliance = art.has_loops ? kComplianceOfLoops : kComplianceOfTrees;
  for (int i = 0; i < art.pattern.node_count(); ++i) {
    double* diagonal = &art.matrix[art.pattern.block[art.pattern.column_begin[i]].offset];
    const int n = art.joints[i].count;
    for (int r = 0; r < n; ++r) {
      double& number = diagonal[r * n + r];
      number += art.rows[art.joints[i].first + r].gamma + compliance * number;
    }
  }
}

/// Rows at a bound become lambda = 0: their impulse is already in the velocities.
void drop_bound_rows(Articulation& art) {
  for (const BlockPattern::Block& block : art.pattern.block) {
    const Articulation::Joint& left = art.joints[block.row];
    const Articulation::Joint& right = art.joints[block.column];
    for (int r = 0; r < left.count; ++r) {
      for (int c = 0; c < right.count; ++c) {
        if (art.bound[left.first + r] == 0 && art.bound[right.first + c] == 0) continue;
        const bool diagonal = block.row == block.column && r == c;
        art.factors[block.offset + r * right.count + c] = diagonal ? 1 : 0;
      }
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
  art.factors = art.matrix;
  for (std::size_t i = 0; i < art.rows.size(); ++i) {
    art.lambda[i] = art.bound[i] < 0 ? art.rows[i].low : art.bound[i] > 0 ? art.rows[i].high : 0;
  }
  reset_velocities(art);
  const bool any_bound = std::any_of(art.bound.begin(), art.bound.end(), [](int b) { return b != 0; });
  if (any_bound) {
    apply_rows([&](int i) { return art.bound[i] != 0; }, art);
    drop_bound_rows(art);
  }
  for (const Articulation::Joint& joint : art.joints) {
    for (int i = joint.first; i < joint.first + joint.count; ++i)
      art.right_side[i] = art.bound[i] == 0 ? shortfall(art, joint, art.rows[i]) : 0;
  }
  factor(art.pattern, art.factors);
  solve(art.pattern, art.factors, art.right_side);
  for (std::size_t i = 0; i < art.rows.size(); ++i) {
    if (art.bound[i] == 0) art.lambda[i] = art.right_side[i];
  }
  apply_rows([&](int i) { return art.bound[i] == 0; }, art);
}

/// Rows beyond a bound go to it; rows that the bound holds back are let go if `release`. True if any changed.
bool revise_bounds(bool release, Articulation& art) {
  bool changed = false;
  for (const Articulation::Joint& joint : art.joints) {
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      const JointRow& row = art.rows[i];
      std::int8_t bound = 0;
      if (art.bound[i] == 0) {
        bound = side_of(art.lambda[i], row.low, row.high);
      } else if (!release) {
        continue;
      } else {
        const double lacks = shortfall(art, joint, row) - row.gamma * art.lambda[i];
        const bool stays = art.bound[i] < 0 ? lacks <= 1e-9 : lacks >= -1e-9;
        bound = stays ? art.bound[i] : std::int8_t{0};
      }
      changed = changed || bound != art.bound[i];
      art.bound[i] = bound;
    }
  }
  return changed;
}

void solve_with_bounds(Articulation& art) {
  assemble(art);
  bool changed = true;
  for (int pass = 0; changed && pass < kMaxPasses; ++pass) {
    solve_free_rows(art);
    changed = revise_bounds(pass < kFreePasses, art);
  }
  if (!changed) return;
  for (std::size_t i = 0; i < art.rows.size(); ++i)
    art.lambda[i] = std::clamp(art.lambda[i], art.rows[i].low, art.rows[i].high);
  reset_velocities(art);
  apply_rows([](int) { return true; }, art);
}

void store_impulses(const Articulation& art, std::vector<Hook>& hooks) {
  for (std::size_t i = 0; i < art.joints.size(); ++i) {
    const auto first = static_cast<std::size_t>(art.joints[i].first);
    const auto count = static_cast<std::size_t>(art.joints[i].count);
    store_joint_impulses(std::span(art.rows).subspan(first, count),
                         std::span(art.lambda).subspan(first, count), hooks[art.hooks[i]]);
  }
}

void store_velocities(const Articulation& art, state::Bodies& bodies) {
  for (std::size_t i = 0; i < art.links.size(); ++i) {
    const Link& link = art.links[i];
    if (link.body.inverse_mass > 0)
      set_joint_velocity(link.body, link.v, link.omega_scaled, art.bodies[i], bodies);
  }
}

}  // namespace

std::optional<Articulation> make_articulation(const std::vector<std::uint32_t>& hook_rows,
                                              const std::vector<Hook>& hooks, const state::Bodies& bodies,
                                              double budget) {
  Articulation art;
  std::vector<int> sizes;
  for (const std::uint32_t i : hook_rows) {
    art.bodies.insert(art.bodies.end(), {hooks[i].a.body, hooks[i].b.body});
    sizes.push_back(count_joint_rows(hooks[i]));
  }
  std::sort(art.bodies.begin(), art.bodies.end());
  art.bodies.erase(std::unique(art.bodies.begin(), art.bodies.end()), art.bodies.end());

  std::vector<std::vector<std::uint32_t>> neighbors(hook_rows.size());
  for (const std::vector<std::uint32_t>& group : hooks_of_links(hook_rows, hooks, bodies, art.bodies)) {
    if (static_cast<double>(group.size()) * static_cast<double>(group.size()) > budget) return std::nullopt;
    for (const std::uint32_t i : group) neighbors[i].insert(neighbors[i].end(), group.begin(), group.end());
  }
  for (std::uint32_t i = 0; i < neighbors.size(); ++i) {
    std::sort(neighbors[i].begin(), neighbors[i].end());
    neighbors[i].erase(std::unique(neighbors[i].begin(), neighbors[i].end()), neighbors[i].end());
    std::erase(neighbors[i], i);
  }
  std::optional<BlockPattern> pattern = make_block_pattern(neighbors, sizes, budget);
  if (!pattern) return std::nullopt;
  art.pattern = std::move(*pattern);
  art.has_loops = count_loops(hook_rows, hooks, bodies, art.bodies);
  for (int i = 0; i < art.pattern.node_count(); ++i) {
    const std::uint32_t hook = hook_rows[art.pattern.order[i]];
    art.hooks.push_back(hook);
    art.joints.push_back({link_of(art.bodies, hooks[hook].a.body), link_of(art.bodies, hooks[hook].b.body),
                          art.pattern.first[i], art.pattern.size[i]});
  }
  list_couplings(bodies, art);
  art.links.resize(art.bodies.size());
  const auto row_count = static_cast<std::size_t>(art.pattern.first.back());
  art.rows.resize(row_count);
  art.lambda.resize(row_count);
  art.bound.resize(row_count);
  art.right_side.resize(row_count);
  art.matrix.resize(art.pattern.number_count);
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
