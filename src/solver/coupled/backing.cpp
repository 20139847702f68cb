#include "solver/coupled/backing.h"

#include "solver/body/joint_body.h"
#include "solver/contact/contact_colors.h"
#include "solver/coupled/coupled_tuning.h"
#include "solver/joint_rows/hook_rows.h"
#include "solver/linear/dense_six.h"
#include "solver/solid/stiff_ties.h"
#include "state/body_frames.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hooke::solver {

namespace {

using state::Bodies;
using state::Manifold;
using Six = HoldingBody::Six;

Six six_of(double sign, DVec3 linear, DVec3 angular) {
  return {sign * linear.x,  sign * linear.y,  sign * linear.z,
          sign * angular.x, sign * angular.y, sign * angular.z};
}

/// Moves a body by a change of its motion. Like a hook's impulse it counts as free motion.
void change_motion(const Six& change, std::uint32_t row, Bodies& bodies) {
  const JointBody before = joint_body_now(bodies, row);
  const DVec3 turn = {change[3], change[4], change[5]};
  set_joint_velocity(before, before.v + DVec3{change[0], change[1], change[2]},
                     before.omega_scaled + math::inverse(before.scale) * turn, row, bodies);
}

/// Lists bodies level by level, with the rows between them.
class Finder {
 public:
  Finder(const state::Tables& tables, Real h, BackedBodies& out) : t_(tables), h_(h), out_(out) {
    for (const BackedBody& body : out_.bodies) out_.index_of[body.body] = 0;
    out_.bodies.clear();
    out_.links.clear();
    out_.rows.clear();
    out_.numbers.clear();
    out_.index_of.resize(tables.bodies.motion.size(), 0);
  }

  void add(std::uint32_t row) {
    if (!state::gives_way(t_.bodies, row) || out_.index_of[row] != 0) return;
    BackedBody& body = out_.bodies.emplace_back();
    body.body = row;
    body.own = body.mass = holding_body(t_.bodies, row).mass;
    out_.index_of[row] = static_cast<std::uint32_t>(out_.bodies.size());
  }

  void find_links() {
    while (level_begin_ < out_.bodies.size()) {
      const std::size_t level_end = out_.bodies.size();
      level_end_ = level_end;
      for (const Manifold& m : t_.pairs.manifold) link_contact(m);
      for (const state::Hook& hook : t_.hooks) link_hook(hook);
      level_begin_ = level_end;
    }
  }

  /// Eliminates what is behind each link, from the outside.
  void eliminate() {
    for (std::size_t i = out_.links.size(); i-- > 0;) eliminate(out_.links[i]);
    for (BackedBody& body : out_.bodies) factor(body);
  }

 private:
  [[nodiscard]] bool is_in_level(std::uint32_t row) const {
    return row < out_.index_of.size() && out_.index_of[row] > level_begin_ &&
           out_.index_of[row] <= level_end_;
  }

  /// Begins a link outwards between two bodies. Returns false if there is none.
  bool begin_link(std::uint32_t a, std::uint32_t b, bool& a_is_parent) {
    a_is_parent = is_in_level(a);
    if (a_is_parent == is_in_level(b)) return false;
    const std::uint32_t parent = a_is_parent ? a : b;
    const std::uint32_t other = a_is_parent ? b : a;
    const bool gives = state::gives_way(t_.bodies, other);
    if (gives && out_.index_of[other] != 0 && out_.index_of[other] <= level_begin_) return false;
    if (gives) add(other);
    BackingLink link = {.parent = out_.index_of[parent] - 1, .first = out_.rows.size()};
    if (gives) link.child = out_.index_of[other] - 1;
    out_.links.push_back(link);
    return true;
  }

  /// Keeps a link that has rows.
  void end_link() {
    BackingLink& link = out_.links.back();
    link.count = out_.rows.size() - link.first;
    if (link.count == 0) return out_.links.pop_back();
    if (link.child == BackingLink::kGround) {
      out_.bodies[link.parent].is_held = true;
    } else {
      ++out_.bodies[link.child].parents;
    }
  }

  void add_row(bool a_is_parent, const Six& a, const Six& b) {
    out_.rows.push_back({.of_parent = a_is_parent ? a : b, .of_child = a_is_parent ? b : a});
  }

  void link_contact(const Manifold& m) {
    if (m.point_count == 0 || !has_contact_rows(m, t_.bodies)) return;
    if (!is_in_level(m.body_a) && !is_in_level(m.body_b)) return;
    if (!touches(m)) return;
    bool a_is_parent = false;
    if (!begin_link(m.body_a, m.body_b, a_is_parent)) return;
    const auto n = normalize(vector_cast<double>(m.normal));
    const DVec3 t_1 = normalize(std::abs(n.x) < 0.5 ? cross(n, DVec3{1, 0, 0}) : cross(n, DVec3{0, 1, 0}));
    const std::array<DVec3, 3> directions = {n, t_1, cross(n, t_1)};
    for (std::int32_t k = 0; k < m.point_count; ++k) {
      const state::ContactPoint& p = m.point[static_cast<std::size_t>(k)];
      if (!may_press(m, p)) continue;
      const DVec3 r_a = vector_cast<double>(p.anchor_a);
      const DVec3 r_b = vector_cast<double>(p.anchor_b);
      for (std::size_t i = 0; i < (sticks(m, p) ? 3 : 1); ++i) {
        add_row(a_is_parent, six_of(-1, directions[i], cross(r_a, directions[i])),
                six_of(1, directions[i], cross(r_b, directions[i])));
      }
    }
    end_link();
  }

  [[nodiscard]] bool touches(const Manifold& m) const {
    for (std::int32_t k = 0; k < m.point_count; ++k) {
      if (may_press(m, m.point[static_cast<std::size_t>(k)])) return true;
    }
    return false;
  }

  /// Velocity of B relative to A at a point.
  [[nodiscard]] Vec3 relative(const Manifold& m, const state::ContactPoint& p) const {
    return state::velocity_now(t_.bodies, m.body_b, p.anchor_b) -
           state::velocity_now(t_.bodies, m.body_a, p.anchor_a) + m.surface_velocity;
  }

  [[nodiscard]] bool may_press(const Manifold& m, const state::ContactPoint& p) const {
    const state::MotionRecord& a = t_.bodies.motion[m.body_a];
    const state::MotionRecord& b = t_.bodies.motion[m.body_b];
    const Vec3 moved = b.dx + cross(t_.bodies.scale[m.body_b] * b.theta_scaled, p.anchor_b) - a.dx -
                       cross(t_.bodies.scale[m.body_a] * a.theta_scaled, p.anchor_a);
    return p.separation + dot(m.normal, moved + h_ * relative(m, p)) <= kLoadTouchingGap;
  }

  [[nodiscard]] bool sticks(const Manifold& m, const state::ContactPoint& p) const {
    const Vec3 u = relative(m, p);
    return m.friction > Real(0) && length(u - dot(m.normal, u) * m.normal) <= kBackingSticks;
  }

  void link_hook(const state::Hook& hook) {
    if (hook.broken || hook.holds_point()) return;
    if (!is_in_level(hook.a.body) && !is_in_level(hook.b.body)) return;
    bool a_is_parent = false;
    if (!begin_link(hook.a.body, hook.b.body, a_is_parent)) return;
    state::Hook copy = hook;  // its values are written
    const JointBody a = joint_end(t_, hook.a);
    const JointBody b = joint_end(t_, hook.b);
    std::array<JointRow, state::Hook::kMaxRows> rows;
    const int count = make_joint_rows(copy, a, b, static_cast<double>(h_), rows);
    for (int i = 0; i < count; ++i) {
      const JointRow& row = rows[static_cast<std::size_t>(i)];
      if (row.role != RowRole::kLock) continue;
      add_row(a_is_parent, six_of(-1, row.n, math::inverse(a.scale) * row.j_a),
              six_of(1, row.n, math::inverse(b.scale) * row.j_b));
    }
    end_link();
  }

  static void factor(BackedBody& body) {
    body.factor = body.mass;
    factorize_six(body.factor);
  }

  void eliminate(BackingLink& link) {
    factor(link);
    BackedBody& parent = out_.bodies[link.parent];
    for (std::size_t j = 0; j < 6; ++j) {
      scratch_.resize(link.count);
      for (std::size_t i = 0; i < link.count; ++i) scratch_[i] = out_.rows[link.first + i].of_parent[j];
      solve(&out_.numbers[link.factor], link.count, scratch_);
      for (std::size_t i = 0; i < link.count; ++i) {
        for (std::size_t l = 0; l < 6; ++l)
          parent.mass[l][j] += out_.rows[link.first + i].of_parent[l] * scratch_[i];
      }
    }
  }

  /// Factors how the rows of a link yield: by what is behind it, and a little by what is before it.
  void factor(BackingLink& link) {
    const std::size_t n = link.count;
    link.factor = out_.numbers.size();
    out_.numbers.resize(link.factor + n * n, 0);
    double* k = &out_.numbers[link.factor];
    std::array<Six, 6> own_factor = out_.bodies[link.parent].own;
    factorize_six(own_factor);
    BackedBody* child = link.child == BackingLink::kGround ? nullptr : &out_.bodies[link.child];
    if (child != nullptr) factor(*child);
    for (std::size_t j = 0; j < n; ++j) {
      const BackingRow& row = out_.rows[link.first + j];
      double yielding = product_six(row.of_parent, solved_six(own_factor, row.of_parent));
      if (child != nullptr) {
        Six moved = solved_six(child->factor, row.of_child);
        for (double& number : moved) number *= child->parents;
        for (std::size_t i = j; i < n; ++i)
          k[i * n + j] = product_six(out_.rows[link.first + i].of_child, moved);
        yielding += k[j * n + j];
      }
      k[j * n + j] += kBackingCompliance * yielding;
    }
    factorize(k, n);
  }

 public:
  /// Factors L D L^T in place: L below the diagonal, 1 / D on it.
  static void factorize(double* m, std::size_t n) {
    std::vector<double> d(n);
    for (std::size_t j = 0; j < n; ++j) {
      d[j] = m[j * n + j];
      for (std::size_t k = 0; k < j; ++k) d[j] -= m[j * n + k] * m[j * n + k] * d[k];
      const double inverse = d[j] > 0 ? 1 / d[j] : 0;
      for (std::size_t i = j + 1; i < n; ++i) {
        for (std::size_t k = 0; k < j; ++k) m[i * n + j] -= m[i * n + k] * m[j * n + k] * d[k];
        m[i * n + j] *= inverse;
      }
      m[j * n + j] = inverse;
    }
  }

  static void solve(const double* m, std::size_t n, std::vector<double>& x) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= m[i * n + k] * x[k];
    }
    for (std::size_t i = n; i-- > 0;) {
      x[i] *= m[i * n + i];
      for (std::size_t k = i + 1; k < n; ++k) x[i] -= m[k * n + i] * x[k];
    }
  }

 private:
  const state::Tables& t_;
  Real h_;
  BackedBodies& out_;
  std::size_t level_begin_ = 0;  ///< Bodies [level_begin_, level_end_) get their links now.
  std::size_t level_end_ = 0;
  std::vector<double> scratch_;
};

}  // namespace

void list_carried_forces(const state::Tables& t, const std::vector<std::uint8_t>& stiff,
                         std::vector<CarriedForce>& carried) {
  carried.clear();
  const state::Contacts& c = t.contacts;
  for (std::size_t row = 0; row < c.particle.size(); ++row) {
    if (stiff[c.object[row]] == 0 || !(c.normal_force[row] > Real(0))) continue;
    const std::uint32_t body = c.body[row];
    if (!state::gives_way(t.bodies, body)) continue;
    auto at = std::find_if(carried.begin(), carried.end(),
                           [&](const CarriedForce& one) { return one.body == body; });
    if (at == carried.end()) at = carried.insert(at, {.body = body});
    const DVec3 force = -vector_cast<double>(c.normal_force[row] * c.normal[row] + c.friction_force[row]);
    const DVec3 place =
        t.objects[c.object[row]].origin + vector_cast<double>(t.particles.position[c.particle[row]].x);
    add_impulse(force, place - joint_body_now(t.bodies, body).center, at->force);
  }
}

void push_carried(std::span<const CarriedForce> carried, Real h, Bodies& bodies) {
  for (const CarriedForce& one : carried) {
    std::array<Six, 6> mass = holding_body(bodies, one.body).mass;
    factorize_six(mass);
    Six impulse = one.force;
    for (double& number : impulse) number *= static_cast<double>(h);
    change_motion(solved_six(mass, impulse), one.body, bodies);
  }
}

void find_backing(const state::Tables& t, const std::vector<std::uint8_t>& stiff,
                  std::span<const CarriedForce> carried, std::span<const std::uint32_t> hooked, Real h,
                  BackedBodies& backed) {
  Finder finder(t, h, backed);
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    if (stiff[t.contacts.object[row]] != 0) finder.add(t.contacts.body[row]);
  }
  for (const CarriedForce& one : carried) finder.add(one.body);
  for (const std::uint32_t body : hooked) finder.add(body);
  finder.find_links();
  finder.eliminate();
  for (const CarriedForce& one : carried) {
    BackedBody* body = backed.find(one.body);
    if (body == nullptr) continue;
    for (std::size_t i = 0; i < 6; ++i) body->expected[i] = static_cast<double>(h) * one.force[i];
  }
}

void spread_impulses(BackedBodies& backed, Bodies& bodies) {
  std::vector<Six> changes(backed.bodies.size());
  auto link = backed.links.begin();
  std::vector<double> given;
  for (std::size_t i = 0; i < backed.bodies.size(); ++i) {
    BackedBody& body = backed.bodies[i];
    Six impulse = {};
    for (std::size_t k = 0; k < 6; ++k) impulse[k] = body.impulse[k] - body.expected[k];
    changes[i] = solved_six(body.factor, impulse);
    change_motion(changes[i], body.body, bodies);
    for (; link != backed.links.end() && link->parent == i; ++link) {
      if (link->child == BackingLink::kGround) continue;
      given.resize(link->count);
      for (std::size_t k = 0; k < link->count; ++k)
        given[k] = -product_six(backed.rows[link->first + k].of_parent, changes[i]);
      Finder::solve(&backed.numbers[link->factor], link->count, given);
      BackedBody& child = backed.bodies[link->child];
      for (std::size_t k = 0; k < link->count; ++k) {
        for (std::size_t l = 0; l < 6; ++l)
          child.impulse[l] += given[k] * backed.rows[link->first + k].of_child[l];
      }
    }
  }
}

}  // namespace hooke::solver
