#include "collision/distance/shape_gap.h"
#include "collision/manifold/manifold_axes.h"
#include "collision/manifold/manifold_features.h"
#include "collision/manifold/manifold_points.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

/// Handles a sphere and a shape that has its own closed form.
void collide_sphere(const Convex& sphere, const Convex& b, ContactResult& result) {
  const Vec3 d = sphere.center - b.center;
  const Gap gap = gap_to_shape(b.shape, {dot(b.axes.x, d), dot(b.axes.y, d), dot(b.axes.z, d)});
  const Vec3 outward = b.axes * gap.normal;
  const Real radius = sphere.shape.radius;
  result.normal = -outward;
  result.separation = gap.distance - radius;
  result.add({sphere.center - radius * outward, sphere.center - gap.distance * outward, result.separation,
              kNearest});
}

geometry::Segment<Real> core_of(const Convex& capsule) {
  const Vec3 end = capsule.shape.half_height * capsule.axes.y;
  return {capsule.center - end, capsule.center + end};
}

void collide_capsules(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result) {
  const auto pair = geometry::closest_between_segments(core_of(a), core_of(b));
  // Cores that cross separate across both; cores on one line separate across it, in some direction.
  const Vec3 across = cross(a.axes.y, b.axes.y);
  const Vec3 sideways = geometry::direction_or(across, a.axes.x);
  const Vec3 otherwise = dot(sideways, b.center - a.center) < Real(0) ? -sideways : sideways;
  const Real size = std::sqrt(pair.distance_squared);
  const bool crossing = size <= Real(1e-6) * (a.shape.radius + b.shape.radius);
  result.normal = crossing ? otherwise : geometry::direction_or(pair.point_b - pair.point_a, otherwise);
  result.separation = size - a.shape.radius - b.shape.radius;
  if (result.separation > query.margin) return;
  overlap_features(feature_along(a, result.normal), feature_along(b, -result.normal), a.shape.radius,
                   b.shape.radius, result);
  const Nearest nearest = {pair.point_a + a.shape.radius * result.normal,
                           pair.point_b - b.shape.radius * result.normal, true};
  complete_points(nearest, axis_tolerance(a, b), result);
}

bool has_closed_form(ShapeKind kind) {
  return kind != ShapeKind::kHull && kind != ShapeKind::kMesh && kind != ShapeKind::kHalfSpace;
}

}  // namespace

bool is_round_pair(ShapeKind a, ShapeKind b) {
  return (a == ShapeKind::kSphere && has_closed_form(b)) || (b == ShapeKind::kSphere && has_closed_form(a)) ||
         (a == ShapeKind::kCapsule && b == ShapeKind::kCapsule);
}

void collide_round(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result) {
  if (a.shape.kind == ShapeKind::kCapsule && b.shape.kind == ShapeKind::kCapsule) {
    collide_capsules(a, b, query, result);
  } else if (a.shape.kind == ShapeKind::kSphere) {
    collide_sphere(a, b, result);
  } else {
    collide_sphere(b, a, result);
    swap_sides(result);
  }
}

}  // namespace hooke::collision
