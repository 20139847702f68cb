#include "collision/manifold/manifold_axes.h"

#include "collision/manifold/manifold_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

Real preference(Real full, const Convex& a, const Convex& b) {
  return std::min(full, Real(0.05) * std::min(thinness_of(a), thinness_of(b)));
}

Real axis_tolerance(const Convex& a, const Convex& b) {
  return Real(2e-5) * (length(middle_of(b) - middle_of(a)) + thinness_of(a) + thinness_of(b));
}

Nearest improve_axis(const Convex& a, const Convex& b, Real tolerance, Axis& axis) {
  // The shapes are far enough apart that rounding does not change the direction, and near enough that it is
  // that of the surface.
  const Real clearance = Real(0.25) * std::max(thinness_of(a), thinness_of(b)) + Real(16) * tolerance;
  Nearest nearest;
  for (int i = 0; i < kMostAxisPushes; ++i) {
    const Real core_separation = axis.separation + skin_of(a) + skin_of(b);
    // If the cores are apart anyway, the first direction is the right one.
    const bool apart = core_separation > Real(16) * tolerance;
    const Vec3 push = (apart ? Real(0) : clearance - core_separation) * axis.n;
    Convex pushed = b;
    pushed.center += push;
    for (Vec3& corner : pushed.corners) corner += push;
    const Distance d = distance_between(a, pushed);
    if (d.cores_overlap) break;
    const Real separation = separation_along(a, b, d.normal);
    const bool gains = separation > axis.separation + tolerance;
    // The push moves the nearest points against each other, unless it is along the direction between them.
    if (gains || !nearest.known || dot(d.normal, axis.n) > Real(0.999)) {
      nearest = {d.point_a, d.point_b - push, true};
    }
    if (!gains) break;
    axis = {d.normal, separation, kFreeAxis};
  }
  return nearest;
}

Nearest improve_axis(const Convex& a, const Convex& b, const Distance& apart, Real tolerance, Axis& axis) {
  const bool tells_direction = apart.distance + skin_of(a) + skin_of(b) > Real(16) * tolerance;
  if (apart.cores_overlap || !tells_direction) return improve_axis(a, b, tolerance, axis);
  const Real separation = separation_along(a, b, apart.normal);
  if (separation > axis.separation + tolerance) axis = {apart.normal, separation, kFreeAxis};
  return {apart.point_a, apart.point_b, true};
}

void complete_points(const Nearest& nearest, Real tolerance, ContactResult& result) {
  const auto begin = result.point.begin();
  const auto end = std::remove_if(begin, begin + result.count, [&](const ContactResultPoint& p) {
    return p.separation < result.separation - tolerance;
  });
  result.count = static_cast<int>(end - begin);
  if (deepest_of(result) <= result.separation + tolerance || !nearest.known) return;
  const Vec3 middle = Real(0.5) * (nearest.on_a + nearest.on_b);
  const Vec3 half = Real(0.5) * result.separation * result.normal;
  result.add({middle - half, middle + half, result.separation, kNearest});
}

}  // namespace hooke::collision
