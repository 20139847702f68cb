#include "lab/rigid/dense.h"

#include "lab/shape/extrusion.h"
#include "math/rotation.h"

#include <algorithm>
#include <cmath>

namespace hooke::lab {

namespace {

constexpr int kMostRounds = 1000;
constexpr int kSamples = 16;

DVec3 coordinates(const State& values, Eigen::Index point) {
  return {values[3 * point], values[3 * point + 1], values[3 * point + 2]};
}

bool is_one_convex(const RigidBody& body) {
  return body.shapes.size() == 1 && body.shapes[0].mesh == nullptr;
}

/// Returns how far from the center of mass a point can be that rotation moves; a skin does not count.
double lever_of(const RigidBody& body) {
  double lever = 0;
  for (const RigidShape& shape : body.shapes) {
    if (shape.mesh != nullptr) return body.radius;
    for (const DVec3 v : shape.solid.vertices) lever = std::max(lever, length(v));
  }
  return lever;
}

}  // namespace

DVec3 DenseMotion::Cubic::at(double s, double h) const {
  const double r = 1 - s;
  return (r * r * (1 + 2 * s)) * from + (s * s * (1 + 2 * r)) * to + (h * s * r * r) * rate_from -
         (h * s * s * r) * rate_to;
}

DVec3 DenseMotion::Cubic::rate_at(double s, double h) const {
  const double r = 1 - s;
  const auto [first, middle, last] = rates(h);
  return (r * r) * first + (2 * r * s) * middle + (s * s) * last;
}

std::array<DVec3, 3> DenseMotion::Cubic::rates(double h) const {
  const DVec3 middle = h > 0 ? (3 / h) * (to - from) - rate_from - rate_to : rate_from;
  return {rate_from, middle, rate_to};
}

DenseMotion::DenseMotion(const BodyMotion& start, double seconds)
    : h_(seconds), spin_(length(start.spin)), start_(start) {
  rates_.fill(start.velocity);
}

DenseMotion::DenseMotion(const System& system, double t, double h, const State& y0, const State& y1)
    : system_(&system), told_(y0.size() == 0), t_(t), h_(h), start_(system.body(t, y0)) {
  if (told_) {
    rates_ = {start_.velocity, system.body(t + h / 2, y0).velocity, system.body(t + h, y0).velocity};
    spin_ = length(start_.spin);
    return;
  }
  const State x0 = system.x(y0), x1 = system.x(y1), v0 = system.v(y0), v1 = system.v(y1);
  center_ = {coordinates(x0, 0), coordinates(x1, 0), coordinates(v0, 0), coordinates(v1, 0)};
  rotation_ = {coordinates(x0, 1), coordinates(x1, 1), coordinates(v0, 1), coordinates(v1, 1)};
  rates_ = center_.rates(h);
  // Across p, |omega| = |p'| / sqrt(s) <= |p'|; along p, |omega| = |p'| / s.
  for (const DVec3 rate : rotation_.rates(h)) spin_ = std::max(spin_, length(rate));
}

BodyMotion DenseMotion::at(double share) const {
  if (system_ == nullptr) {
    BodyMotion now = start_;
    if (h_ > 0) {
      now.center += (share * h_) * start_.velocity;
      now.rotation = normalize(math::quaternion_of((share * h_) * start_.spin) * start_.rotation);
    }
    return now;
  }
  if (told_) return system_->body(t_ + share * h_, State(0));
  State y(2 * system_->coordinates());
  const DVec3 parts[] = {center_.at(share, h_), rotation_.at(share, h_), center_.rate_at(share, h_),
                         rotation_.rate_at(share, h_)};
  for (int i = 0; i < 4; ++i) y.segment<3>(3 * i) = Eigen::Vector3d(parts[i].x, parts[i].y, parts[i].z);
  return system_->body(t_ + share * h_, y);
}

std::array<DVec3, 4> DenseMotion::centers() const {
  if (system_ == nullptr || told_)
    return {start_.center, at(1.0 / 3).center, at(2.0 / 3).center, at(1).center};
  return {center_.from, center_.from + (h_ / 3) * center_.rate_from, center_.to - (h_ / 3) * center_.rate_to,
          center_.to};
}

BodyGap DensePair::gap(double share) const {
  // Meshes are searched as far as the bodies can get within the step.
  const double reach = motion_a.seconds() > 0 || motion_b.seconds() > 0
                           ? 0.1 + closing({}) * std::max(motion_a.seconds(), motion_b.seconds())
                           : 0.1;
  return gap_between(a, motion_a.at(share), b, motion_b.at(share), contact_search, reach);
}

double DensePair::closing(DVec3 n) const {
  const bool along_n = n != DVec3{} && is_one_convex(a) && is_one_convex(b);
  double centers = along_n ? -1e300 : 0;
  for (int i = 0; i < 3; ++i) {
    const DVec3 v = motion_a.velocities()[i] - motion_b.velocities()[i];
    centers = std::max(centers, along_n ? dot(n, v) : length(v));
  }
  const auto turning = [](const RigidBody& body, const DenseMotion& motion) {
    return motion.fastest_spin() > 0 ? motion.fastest_spin() * lever_of(body) : 0.0;
  };
  return centers + turning(a, motion_a) + turning(b, motion_b);
}

std::optional<double> first_contact(const DensePair& pair, double allowance) {
  const double h = std::max(pair.motion_a.seconds(), pair.motion_b.seconds());
  BodyGap gap = pair.gap(0);
  const double target = std::min(0.0, gap.distance) - allowance;
  double share = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const double closing = pair.closing(gap.normal);
    if (!(closing * h > 0)) return {};
    // The bodies advance until half of the allowance is left; from there on it counts as a contact.
    share += (gap.distance - target) / (closing * h);
    if (!(share < 1)) return {};
    gap = pair.gap(share);
    if (gap.distance - target <= 0.5 * allowance) return share;
  }
  return share;
}

std::optional<double> contact_root(const DensePair& pair, double epsilon) {
  double low = 0;
  double at_low = pair.gap(0).distance;
  for (int i = 1; i <= kSamples; ++i) {
    double high = static_cast<double>(i) / kSamples;
    double at_high = pair.gap(high).distance;
    // Where the bodies already touch or overlap at the start, the root is sought at a depth of half of
    // epsilon.
    const double target = at_low > 0 ? 0 : -0.5 * epsilon;
    if (!(at_high < target && at_low > target)) {
      low = high;
      at_low = at_high;
      continue;
    }
    double f_low = at_low - target, f_high = at_high - target;
    for (int round = 0; round < 200 && high - low > 1e-16; ++round) {
      double share = (low * f_high - high * f_low) / (f_high - f_low);
      if (!(share > low && share < high)) share = 0.5 * (low + high);
      const double f = pair.gap(share).distance - target;
      if (f == 0) return share;
      if (f > 0) {
        if (share == low) break;
        low = share;
        f_low = f;
        f_high *= 0.5;
      } else {
        if (share == high) break;
        high = share;
        f_high = f;
        f_low *= 0.5;
      }
    }
    return high;
  }
  return {};
}

bool may_collide(const DensePair& pair, double reach) {
  if (!is_one_convex(pair.a) || !is_one_convex(pair.b)) return true;
  const auto swept = [&](const RigidBody& body, const DenseMotion& motion, DVec3 displacement) {
    const BodyMotion start = motion.at(0);
    geometry::ConvexSolid solid = geometry::placed(body.shapes[0].solid, start.rotation, start.center);
    solid = geometry::extruded(solid, displacement);
    const double half = std::min(0.5 * motion.largest_rotation(), 1.57);
    if (half > 0) solid.skin += 2 * lever_of(body) * half;
    return solid;
  };
  if (pair.a.shapes[0].solid.vertices.empty() || pair.b.shapes[0].solid.vertices.empty()) return true;
  // In this frame B does not move. A leaves the straight path by less than its control points do.
  const std::array<DVec3, 4> of_a = pair.motion_a.centers(), of_b = pair.motion_b.centers();
  const DVec3 displacement = (of_a[3] - of_a[0]) - (of_b[3] - of_b[0]);
  double aside = 0;
  for (int i = 1; i < 3; ++i) {
    const DVec3 passed = (of_a[i] - of_a[0]) - (of_b[i] - of_b[0]);
    const double s = length_squared(displacement) > 0
                         ? std::clamp(dot(passed, displacement) / length_squared(displacement), 0.0, 1.0)
                         : 0;
    aside = std::max(aside, length(passed - s * displacement));
  }
  const geometry::ConvexSolid a = swept(pair.a, pair.motion_a, displacement);
  const geometry::ConvexSolid b = swept(pair.b, pair.motion_b, {});
  return geometry::gap_between(a, b).distance <= reach + aside;
}

}  // namespace hooke::lab
