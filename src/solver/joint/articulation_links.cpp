#include "solver/joint/articulation_links.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/joint_rows/geometric_stiffness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::Hook;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Divides a body into equal parts, each of which moves as the body does.
void divide(double parts, JointBody& body) {
  if (parts == 1) return;
  const double root = std::sqrt(parts);
  body.inverse_mass *= parts;
  body.scale = scaled(root, body.scale);
  body.omega_scaled = (1 / root) * body.omega_scaled;
}

/// Makes the rows of a weld: both links have one velocity.
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
  HOOKE_ASSERT(art.links.size() == art.bodies.size() && art.parts.size() == art.bodies.size());
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
      JointRow& row = rows[k];
      row.start = row.c;
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

/// The length that a joint's gap is compared with: its levers on bodies that move [m].
double size_of(const Hook& hook, const Link& a, const Link& b) {
  const double size_a = a.body.inverse_mass > 0 ? length(hook.a.anchor) : 0;
  const double size_b = b.body.inverse_mass > 0 ? length(hook.b.anchor) : 0;
  return std::max(kLeastJointLever, size_a + size_b);
}

/// A Newton step: makes the rows about the end of the substep as it was found, where C = c + h J (v' - v) for
/// another velocity v'. Returns the largest error of a lock.
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
      // An error beyond the speed limit is removed along the row that exists.
      const bool limited =
          row.role == RowRole::kLock && std::abs(row.target) < 0.999 * row.rate * std::abs(row.c);
      if (limited) continue;
      const double v = dot(row.n, b.v - a.v) + dot(row.j_b, b.omega_scaled) - dot(row.j_a, a.omega_scaled);
      row.target += row.rate * h * v;
      row.start = art.rows[joint.first + k].start;
      art.rows[joint.first + k] = row;
      if (row.role == RowRole::kLock)
        worst = std::max(worst, std::abs(row.c) / (row.axis == DVec3{} ? size : 1));
    }
  }
  return worst;
}

/// Whether any stiffness may be more than what is left explicit, even where a solution is repeated for it.
/// Its trace is at most h^2 tr S^2 times the sum of |r| |F|.
bool stiffness_matters(double h, const std::vector<Hook>& hooks, Articulation& art) {
  for (Link& link : art.links) link.most_stiffness = 0;
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.is_weld()) continue;
    const Hook& hook = hooks[joint.hook];
    const double impulse = length(vector_cast<double>(hook.impulse));
    art.links[joint.a].most_stiffness += impulse * length(hook.a.anchor);
    art.links[joint.b].most_stiffness += impulse * length(hook.b.anchor);
  }
  return std::any_of(art.links.begin(), art.links.end(), [h](const Link& link) {
    const Symmetric3<double>& s = link.body.scale;
    const double square =
        s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + 2 * (s.xy * s.xy + s.xz * s.xz + s.yz * s.yz);
    return link.body.inverse_mass > 0 && h * link.most_stiffness * square * kStiffnessGrowth > kStiffnessLeft;
  });
}

/// Writes the stiffness of all links under the impulses of their hooks, where it grows. True if it grew so
/// much that a solution found without it is not to be trusted.
bool stiffen(double h, const std::vector<Hook>& hooks, Articulation& art) {
  if (!stiffness_matters(h, hooks, art)) return false;
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

void store_impulses(const Articulation& art, std::vector<Hook>& hooks) {
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.is_weld()) continue;
    const auto first = static_cast<std::size_t>(joint.first);
    const auto count = static_cast<std::size_t>(joint.count);
    store_joint_impulses(std::span(art.rows).subspan(first, count),
                         std::span(art.lambda).subspan(first, count), hooks[joint.hook]);
  }
}

}  // namespace

void begin_articulation(double h, JointTables tables, Articulation& art) {
  load_links(tables.bodies, art);
  make_rows(h, tables.hooks, art);
  stiffen(h, tables.hooks, art);
}

bool begin_next_solution(double h, JointTables tables, Articulation& art) {
  store_impulses(art, tables.hooks);
  const bool grew = stiffen(h, tables.hooks, art);
  const bool bent =
      turns_farther(kBentRowsTurn, h, art) && make_rows_ahead(h, tables.hooks, art) > kBentRowsError;
  return grew || bent;
}

bool turns_farther(double angle, double h, const Articulation& art) {
  return std::any_of(art.links.begin(), art.links.end(), [&](const Link& link) {
    return link.body.inverse_mass > 0 && h * length(link.body.scale * link.omega_scaled) > angle;
  });
}

bool lines_turn_farther(double angle, double h, const std::vector<Hook>& hooks, const Articulation& art) {
  return std::any_of(art.joints.begin(), art.joints.end(), [&](const Articulation::Joint& joint) {
    if (joint.is_weld() || hooks[joint.hook].kind != HookKind::kDistance) return false;
    return h * length(art.links[joint.b].v - art.links[joint.a].v) >
           angle * std::abs(hooks[joint.hook].value[0]);
  });
}

/// The parts of a body differ by rounding: their mean has all its momentum.
void store_velocities(const Articulation& art, state::Bodies& bodies) {
  for (std::size_t i = 0; i < art.links.size();) {
    const auto parts = static_cast<std::size_t>(art.parts[i]);
    HOOKE_ASSERT(parts > 0 && art.bodies[i + parts - 1] == art.bodies[i]);
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

void reset_velocities(Articulation& art) {
  for (Link& link : art.links) {
    link.v = link.body.v;
    link.omega_scaled = link.body.omega_scaled;
    if (trace(link.excess) > 0)
      link.omega_scaled -= kStiffnessDamping * (link.response * (link.excess * link.body.omega_scaled));
  }
}

void clamp_impulses(Articulation& art) {
  HOOKE_ASSERT(art.lambda.size() == art.rows.size());
  for (std::size_t i = 0; i < art.rows.size(); ++i)
    art.lambda[i] = std::clamp(art.lambda[i], art.rows[i].low, art.rows[i].high);
  reset_velocities(art);
  apply_rows([](int) { return true; }, art);
}

}  // namespace hooke::solver
