#include "lab/rigid/impulses.h"

#include <algorithm>
#include <cmath>

namespace hooke::lab {

namespace {

constexpr int kMostSweeps = 20000;
constexpr double kConverged = 1e-14;  ///< Change of velocity in a sweep, as a share of the largest velocity.
constexpr double kNoChange = 1e-15;   ///< Change of an impulse in a sweep, as a share of itself.
constexpr int kMostImpactsOfPair = 200;
/// Speed that counts as closing, as a share of the largest velocity.
constexpr double kClosingSpeed = 1e-12;

DVec3 response(const ImpulseBody& body, DVec3 lever, DVec3 impulse) {
  return body.inverse_mass * impulse + cross(body.inverse_inertia * cross(lever, impulse), lever);
}

void push(ImpulseBody& body, DVec3 lever, DVec3 impulse) {
  body.velocity += body.inverse_mass * impulse;
  body.spin += body.inverse_inertia * cross(lever, impulse);
}

/// A Row is one contact point, with how its impulse changes its own velocity.
class Row {
 public:
  Row(std::span<ImpulseBody> bodies, ImpulsePoint& point)
      : point_(point), a_(bodies[point.a]), b_(bodies[point.b]) {
    const DVec3 n = point.contact.normal;
    lever_a_ = point.contact.point - a_.center;
    lever_b_ = point.contact.point - b_.center;
    normal_ = dot(n, answer(n));
    u_ = normalize(cross(n, std::abs(n.x) < 0.6 ? DVec3{1, 0, 0} : DVec3{0, 1, 0}));
    w_ = cross(n, u_);
    const DVec3 of_u = answer(u_);
    const double uu = dot(u_, of_u), uw = dot(w_, of_u), ww = dot(w_, answer(w_));
    const double apart = 0.5 * (uu - ww);
    // The larger eigenvalue of the response across the normal.
    across_ = 0.5 * (uu + ww) + std::sqrt(apart * apart + uw * uw);
  }

  /// Returns the last change of the impulse on b by solve() [N s].
  [[nodiscard]] DVec3 last_change() const { return change_; }
  /// Adds to the impulse without regard to its bounds; the next solve() restores these.
  void go_on(DVec3 impulse) {
    const double along = dot(point_.contact.normal, impulse);
    point_.lambda += along;
    point_.tangent += impulse - along * point_.contact.normal;
    apply(impulse);
  }

  /// Solves the point alone. \return The change of velocity [m/s], without that of rounding.
  double solve() {
    if (!(normal_ > 0)) return 0;
    const DVec3 n = point_.contact.normal;
    const double before = point_.lambda;
    const DVec3 old = point_.tangent;
    point_.lambda = std::max(0.0, before - (dot(n, velocity()) - point_.target) / normal_);
    apply((point_.lambda - before) * n);
    const DVec3 v = velocity();
    const DVec3 wish = old - (1 / across_) * (v - dot(n, v) * n);
    const double size = length(wish);
    const bool sticks = size <= point_.contact.static_friction * point_.lambda;
    point_.tangent = sticks ? wish : (size > 0 ? point_.contact.friction * point_.lambda / size : 0.0) * wish;
    apply(point_.tangent - old);
    change_ = (point_.lambda - before) * n + (point_.tangent - old);
    const double rounding = kNoChange * point_.lambda;
    return std::max(0.0, std::abs(point_.lambda - before) - rounding) * normal_ +
           std::max(0.0, length(point_.tangent - old) - rounding) * across_;
  }

 private:
  [[nodiscard]] DVec3 answer(DVec3 impulse) const {
    return response(a_, lever_a_, impulse) + response(b_, lever_b_, impulse);
  }
  [[nodiscard]] DVec3 velocity() const {
    return b_.velocity + cross(b_.spin, lever_b_) - a_.velocity - cross(a_.spin, lever_a_);
  }
  void apply(DVec3 impulse) {
    push(a_, lever_a_, -impulse);
    push(b_, lever_b_, impulse);
  }

  ImpulsePoint& point_;
  ImpulseBody& a_;
  ImpulseBody& b_;
  DVec3 lever_a_ = {}, lever_b_ = {}, u_ = {}, w_ = {};
  double normal_ = 0, across_ = 0;
  DVec3 change_ = {};
};

double largest_speed(std::span<const ImpulseBody> bodies, std::span<const ImpulsePoint> points) {
  double largest = 0;
  for (const ImpulsePoint& point : points) {
    for (const std::uint32_t i : {point.a, point.b}) {
      const ImpulseBody& body = bodies[i];
      largest = std::max(
          largest, length(body.velocity) + length(body.spin) * length(point.contact.point - body.center));
    }
  }
  return largest;
}

/// A Group is the points of one pair of bodies.
struct Group {
  std::size_t first = 0, count = 0;
  int impacts = 0;
};

std::vector<Group> groups_of(std::span<const ImpulsePoint> points) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool same = i > 0 && points[i].a == points[i - 1].a && points[i].b == points[i - 1].b;
    if (!same) groups.push_back({i, 0});
    ++groups.back().count;
  }
  return groups;
}

/// Returns the group with the point that closes fastest, if faster than `enough` [m/s], else null.
Group* find_fastest(std::span<const ImpulseBody> bodies, std::span<const ImpulsePoint> points, double enough,
                    std::vector<Group>& groups) {
  Group* next = nullptr;
  double fastest = -enough;
  for (Group& group : groups) {
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      const double speed = normal_speed(bodies, points[i]);
      if (!(speed < fastest)) continue;
      fastest = speed;
      next = &group;
    }
  }
  return next;
}

}  // namespace

ImpulseBody impulse_body(const RigidBody& body, const BodyMotion& at) {
  ImpulseBody result = {.center = at.center, .velocity = at.velocity, .spin = at.spin};
  if (!body.is_free) return result;
  if (body.axle) {
    result.inverse_inertia = math::axial(body.axle->axis, 1 / body.axle->inertia, 0.0);
    return result;
  }
  result.inverse_mass = 1 / body.mass;
  const DVec3 x = rotate(at.rotation, DVec3{1, 0, 0});
  const DVec3 y = rotate(at.rotation, DVec3{0, 1, 0});
  const DVec3 z = rotate(at.rotation, DVec3{0, 0, 1});
  result.inverse_inertia = math::axial(x, 1 / body.inertia.x, 0.0) + math::axial(y, 1 / body.inertia.y, 0.0) +
                           math::axial(z, 1 / body.inertia.z, 0.0);
  return result;
}

DVec3 relative_velocity(std::span<const ImpulseBody> bodies, const ImpulsePoint& point) {
  const ImpulseBody& a = bodies[point.a];
  const ImpulseBody& b = bodies[point.b];
  return b.velocity + cross(b.spin, point.contact.point - b.center) - a.velocity -
         cross(a.spin, point.contact.point - a.center);
}

bool solve_impulses(std::span<ImpulseBody> bodies, std::span<ImpulsePoint> points) {
  std::vector<Row> rows;
  rows.reserve(points.size());
  for (ImpulsePoint& point : points) {
    point.lambda = 0;
    point.tangent = {};
    rows.emplace_back(bodies, point);
  }
  const double enough = kConverged * largest_speed(bodies, points);
  std::vector<DVec3> momentum(points.size());  // Sum of the changes of earlier sweeps, as impulses on b.
  double size = 0;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    const double before = size;
    double change = 0;
    size = 0;
    for (Row& row : rows) {
      change = std::max(change, row.solve());
      size += length_squared(row.last_change());
    }
    if (!(change > enough)) return true;
    // The end is a sweep, because it leaves impulses within their bounds.
    if (sweep + 1 == kMostSweeps) break;
    const double beta = size < before ? size / before : 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const DVec3 on = beta * momentum[i];
      rows[i].go_on(on);
      momentum[i] = on + rows[i].last_change();
    }
  }
  return false;
}

int resolve_impacts(std::span<ImpulseBody> bodies, std::span<ImpulsePoint> points,
                    std::span<const double> rest_speed) {
  std::vector<Group> groups = groups_of(points);
  double scale = largest_speed(bodies, points);
  for (const double speed : rest_speed) scale = std::max(scale, std::isfinite(speed) ? speed : 0);
  const double closing_speed = kClosingSpeed * scale;
  int impacts = 0;
  for (;;) {
    Group* const next = find_fastest(bodies, points, closing_speed, groups);
    if (next == nullptr) return impacts;
    if (++next->impacts > kMostImpactsOfPair) break;
    const auto own = points.subspan(next->first, next->count);
    bool any_bounces = false;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const double speed = normal_speed(bodies, own[i]);
      const bool bounces = speed < -rest_speed[next->first + i];
      any_bounces = any_bounces || bounces;
      own[i].target = bounces ? -own[i].contact.restitution * speed : 0;
    }
    impacts += any_bounces ? 1 : 0;
    solve_impulses(bodies, own);
  }
  for (ImpulsePoint& point : points) point.target = 0;
  solve_impulses(bodies, points);
  return impacts;
}

}  // namespace hooke::lab
