#include "collision/manifold_axes.h"
#include "collision/manifold_features.h"
#include "collision/manifold_points.h"
#include "collision/shape_gap.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

constexpr Vec3 kUp = {Real(0), Real(1), Real(0)};

/// A place in the half plane of a body of revolution: distance from the axis, height along it.
struct Profile {
  Real out = Real(0);
  Real up = Real(0);
};

struct ProfileGap {
  Real distance = Real(0);
  Profile normal = {};
};

ProfileGap gap_between(Profile p, Profile surface, ProfileGap if_on_it) {
  const Profile d = {p.out - surface.out, p.up - surface.up};
  const Real size = std::sqrt(d.out * d.out + d.up * d.up);
  if (!(size > Real(0))) return if_on_it;
  return {size, {d.out / size, d.up / size}};
}

ProfileGap gap_to_cylinder(Profile p, Real radius, Real half_height) {
  const Real side = p.up < Real(0) ? Real(-1) : Real(1);
  const Real over_end = std::fabs(p.up) - half_height;
  const Real over_side = p.out - radius;
  if (over_end > Real(0) && over_side > Real(0)) {
    return gap_between(p, {radius, side * half_height}, {});
  }
  if (over_end >= over_side) return {over_end, {Real(0), side}};
  return {over_side, {Real(1), Real(0)}};
}

ProfileGap gap_to_cone(Profile p, Real radius, Real half_height) {
  const Real slant = std::sqrt(radius * radius + Real(4) * half_height * half_height);
  const ProfileGap side = {(Real(2) * half_height * (p.out - radius) + radius * (p.up + half_height)) / slant,
                           {Real(2) * half_height / slant, radius / slant}};
  const ProfileGap base = {-p.up - half_height, {Real(0), Real(-1)}};
  // Where along the side from the rim, 0, to the tip, 1.
  const Real along =
      (Real(2) * half_height * (p.up + half_height) - radius * (p.out - radius)) / (slant * slant);
  if (side.distance <= Real(0) && base.distance <= Real(0)) {
    return side.distance >= base.distance ? side : base;
  }
  if (base.distance > Real(0) && p.out <= radius) return base;
  if (along <= Real(0)) return gap_between(p, {radius, -half_height}, side);
  if (along >= Real(1)) return gap_between(p, {Real(0), half_height}, side);
  return side;
}

/// Signed distance and outward normal of a shape at `x`, in the shape's frame.
Gap gap_to(const Shape& shape, Vec3 x) {
  if (shape.kind == ShapeKind::kSphere || shape.kind == ShapeKind::kBox) return gap_to_shape(shape, x);
  if (shape.kind == ShapeKind::kCapsule) {
    const Vec3 tip = shape.half_height * kUp;
    const Vec3 from_axis = x - geometry::closest_on_segment(x, -tip, tip).point;
    return {geometry::safe_length(from_axis) - shape.radius,
            geometry::direction_or(from_axis, {Real(1), Real(0), Real(0)})};
  }
  const Vec3 across = {x.x, Real(0), x.z};
  const Vec3 out = geometry::direction_or(across, {Real(1), Real(0), Real(0)});
  const Profile p = {geometry::safe_length(across), x.y};
  const ProfileGap gap = shape.kind == ShapeKind::kCylinder
                             ? gap_to_cylinder(p, shape.radius, shape.half_height)
                             : gap_to_cone(p, shape.radius, shape.half_height);
  return {gap.distance, gap.normal.out * out + gap.normal.up * kUp};
}

/// A sphere and a shape that has its own closed form.
void meet_sphere(const Convex& sphere, const Convex& b, Meeting& meeting) {
  const Vec3 d = sphere.center - b.center;
  const Gap gap = gap_to(b.shape, {dot(b.axes.x, d), dot(b.axes.y, d), dot(b.axes.z, d)});
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
