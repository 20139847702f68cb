#include "collision/distance/shape_gap.h"
#include "collision/manifold/manifold_axes.h"
#include "collision/manifold/manifold_features.h"
#include "collision/manifold/manifold_points.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

/// A sphere and a shape that has its own closed form.
void meet_sphere(const Convex& sphere, const Convex& b, Meeting& meeting) {
  const Vec3 d = sphere.center - b.center;
  const Gap gap = gap_to_shape(b.shape, {dot(b.axes.x, d), dot(b.axes.y, d), dot(b.axes.z, d)});
  const Vec3 outward = b.axes * gap.normal;
  const Real radius = sphere.shape.radius;
  meeting.normal = -outward;
  meeting.separation = gap.distance - radius;
  meeting.add({sphere.center - radius * outward, sphere.center - gap.distance * outward, meeting.separation,
               kNearest});
}

geometry::Segment<Real> core_of(const Convex& capsule) {
  const Vec3 end = capsule.shape.half_height * capsule.axes.y;
  return {capsule.center - end, capsule.center + end};
}

void meet_capsules(const Convex& a, const Convex& b, const MeetingQuery& query, Meeting& meeting) {
  const auto pair = geometry::closest_between_segments(core_of(a), core_of(b));
  // Cores that cross separate across both; cores on one line across them, in some direction.
  const Vec3 across = cross(a.axes.y, b.axes.y);
  const Vec3 sideways = geometry::direction_or(across, a.axes.x);
  const Vec3 otherwise = dot(sideways, b.center - a.center) < Real(0) ? -sideways : sideways;
  const Real size = std::sqrt(pair.distance_squared);
  const bool crossing = size <= Real(1e-6) * (a.shape.radius + b.shape.radius);
  meeting.normal = crossing ? otherwise : geometry::direction_or(pair.point_b - pair.point_a, otherwise);
  meeting.separation = size - a.shape.radius - b.shape.radius;
  if (meeting.separation > query.margin) return;
  overlap_features(feature_along(a, meeting.normal), feature_along(b, -meeting.normal), a.shape.radius,
                   b.shape.radius, meeting);
  const Nearest nearest = {pair.point_a + a.shape.radius * meeting.normal,
                           pair.point_b - b.shape.radius * meeting.normal, true};
  complete_points(nearest, axis_tolerance(a, b), meeting);
}

bool has_closed_form(ShapeKind kind) {
  return kind != ShapeKind::kHull && kind != ShapeKind::kMesh && kind != ShapeKind::kHalfSpace;
}

}  // namespace

bool is_round_pair(ShapeKind a, ShapeKind b) {
  return (a == ShapeKind::kSphere && has_closed_form(b)) || (b == ShapeKind::kSphere && has_closed_form(a)) ||
         (a == ShapeKind::kCapsule && b == ShapeKind::kCapsule);
}

void meet_round(const Convex& a, const Convex& b, const MeetingQuery& query, Meeting& meeting) {
  if (a.shape.kind == ShapeKind::kCapsule && b.shape.kind == ShapeKind::kCapsule) {
    meet_capsules(a, b, query, meeting);
  } else if (a.shape.kind == ShapeKind::kSphere) {
    meet_sphere(a, b, meeting);
  } else {
    meet_sphere(b, a, meeting);
    swap_sides(meeting);
  }
}

}  // namespace hooke::collision
