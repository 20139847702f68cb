#include "collision/distance/distance.h"

#include "base/assert.h"
#include "collision/distance/distance_tuning.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::collision {

namespace {

Vec3 support_of_capsule(const Convex& c, Vec3 d) {
  const Real h = c.shape.half_height;
  return c.center + (dot(c.axes.y, d) < Real(0) ? -h : h) * c.axes.y;
}

Vec3 support_of_box(const Convex& c, Vec3 d) {
  const auto along = [d](Vec3 axis, Real half) { return (dot(axis, d) < Real(0) ? -half : half) * axis; };
  const Vec3 h = c.shape.half_extents;
  return c.center + along(c.axes.x, h.x) + along(c.axes.y, h.y) + along(c.axes.z, h.z);
}

/// Support of the disc of `radius` across the unit vector `axis`.
Vec3 support_of_disc(Vec3 axis, Real radius, Vec3 d) {
  return radius * direction_across(axis, d, {});
}

Vec3 support_of_cylinder(const Convex& c, Vec3 d) {
  const Real end = dot(c.axes.y, d) < Real(0) ? -c.shape.half_height : c.shape.half_height;
  return c.center + end * c.axes.y + support_of_disc(c.axes.y, c.shape.radius, d);
}

Vec3 support_of_cone(const Convex& c, Vec3 d) {
  const Vec3 tip = c.shape.half_height * c.axes.y;
  const Vec3 rim = support_of_disc(c.axes.y, c.shape.radius, d) - tip;
  return c.center + (dot(tip, d) >= dot(rim, d) ? tip : rim);
}

Vec3 support_of_hull(const Convex& c, Vec3 d) {
  return c.center + c.axes * c.hull->vertices[geometry::support(*c.hull, transpose(c.axes) * d)];
}

Vec3 support_of_triangle(const Convex& c, Vec3 d) {
  const auto& [p, q, r] = c.corners;
  const Vec3 pq = dot(q - p, d) > Real(0) ? q : p;
  return dot(r - pq, d) > Real(0) ? r : pq;
}

/// A corner of the simplex: a point of the difference of the cores, and the two points that it comes from.
struct Corner {
  DVec3 w = {};
  DVec3 on_a = {};
  DVec3 on_b = {};
};

struct Simplex {
  std::array<Corner, 4> corner = {};
  std::array<double, 4> weight = {};
  int count = 0;

  /// The point nearest to the origin.
  [[nodiscard]] Corner nearest() const {
    Corner sum;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      sum.w += weight[i] * corner[i].w;
      sum.on_a += weight[i] * corner[i].on_a;
      sum.on_b += weight[i] * corner[i].on_b;
    }
    return sum;
  }
};

/// The corners that the point of a face nearest to the origin needs, with their weights.
struct Nearby {
  std::array<int, 3> of = {};
  std::array<double, 3> weight = {};
  DVec3 point = {};  ///< The nearest point.
};

Nearby near_on_segment(const Simplex& s) {
  const auto near = geometry::closest_on_segment(DVec3{}, s.corner[0].w, s.corner[1].w);
  return {{0, 1, 1}, {1 - near.fraction, near.fraction, 0}, near.point};
}

Nearby near_on_triangle(const Simplex& s, const std::array<int, 3>& of) {
  const auto near =
      geometry::closest_on_triangle(DVec3{}, s.corner[of[0]].w, s.corner[of[1]].w, s.corner[of[2]].w);
  return {of, {near.weights.x, near.weights.y, near.weights.z}, near.point};
}

void keep(const Nearby& near, Simplex& s) {
  // This works in place, because `of` ascends.
  s.count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(near.weight[i] > 0)) continue;
    s.corner[s.count] = s.corner[near.of[i]];
    s.weight[s.count++] = near.weight[i];
  }
}

/// Returns false if the origin is inside. A flat tetrahedron has all faces outside; `is_outside` says that
/// the origin is known to be outside, whatever rounding makes of a tetrahedron that is nearly flat.
bool reduce_tetrahedron(Simplex& s, bool is_outside) {
  constexpr std::array<std::array<int, 4>, 4> kFaces = {
      {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}};
  double least = std::numeric_limits<double>::infinity();
  Nearby best;
  for (const auto& [i, j, k, opposite] : kFaces) {
    const DVec3 p = s.corner[i].w;
    const DVec3 normal = cross(s.corner[j].w - p, s.corner[k].w - p);
    if (!is_outside && dot(normal, -p) * dot(normal, s.corner[opposite].w - p) > 0) continue;
    const Nearby face = near_on_triangle(s, {i, j, k});
    const double size = length_squared(face.point);
    if (!(size < least)) continue;
    least = size;
    best = face;
  }
  if (!(least < std::numeric_limits<double>::infinity())) return false;
  keep(best, s);
  return true;
}

/// Keeps the corners that the point nearest to the origin needs. Returns false if the origin is inside.
bool reduce(Simplex& s, bool is_outside) {
  if (s.count == 4) return reduce_tetrahedron(s, is_outside);
  if (s.count == 3) keep(near_on_triangle(s, {0, 1, 2}), s);
  if (s.count == 2) keep(near_on_segment(s), s);
  if (s.count == 1) s.weight[0] = 1;
  return true;
}

/// The corner that lies farthest along a direction.
Corner corner_along(const Convex& a, const Convex& b, DVec3 direction) {
  // The direction shrinks with the distance: its length must not underflow in Real.
  const Vec3 d = vector_cast<Real>(geometry::direction_or(direction, DVec3{0, 1, 0}));
  Corner corner;
  corner.on_a = vector_cast<double>(support_of(a, d));
  corner.on_b = vector_cast<double>(support_of(b, -d));
  corner.w = corner.on_a - corner.on_b;
  return corner;
}

bool holds(const Simplex& s, DVec3 w) {
  return std::any_of(s.corner.begin(), s.corner.begin() + s.count,
                     [w](const Corner& corner) { return corner.w == w; });
}

/// From a to the middle of b. A triangle may be large; for it the direction begins at its point nearest to
/// that middle.
Vec3 first_direction(const Convex& a, const Convex& b) {
  const Vec3 middle = middle_of(b);
  if (a.shape.kind != ShapeKind::kMesh) return middle - middle_of(a);
  const auto& [p, q, r] = a.corners;
  return middle - geometry::closest_on_triangle(middle, p, q, r).point;
}

/// The distance from the nearest points of the cores, which are apart.
Distance between_points(const Convex& a, const Convex& b, DVec3 on_a, DVec3 on_b) {
  Distance result;
  result.normal = vector_cast<Real>(geometry::direction_or(on_b - on_a, DVec3{}));
  result.distance = static_cast<Real>(length(on_b - on_a)) - skin_of(a) - skin_of(b);
  result.point_a = vector_cast<Real>(on_a) + skin_of(a) * result.normal;
  result.point_b = vector_cast<Real>(on_b) - skin_of(b) * result.normal;
  return result;
}

/// Finds the distance by the supports of the two; see distance_between.
Distance distance_by_supports(const Convex& a, const Convex& b, Real enough) {
  const Real skins = skin_of(a) + skin_of(b);
  const auto far = static_cast<double>(enough + skins);
  Simplex s;
  s.corner[0] = corner_along(a, b, vector_cast<double>(first_direction(a, b)));
  s.weight[0] = 1;
  s.count = 1;
  Corner nearest = s.corner[0];
  double scale = 0;
  for (int i = 0; i < kMostDistanceRounds; ++i) {
    const DVec3 v = nearest.w;
    const Corner next = corner_along(a, b, -v);
    scale = std::max({scale, length(next.on_a), length(next.on_b)});
    const double size = length(v);
    if (!(size > kDistanceRounding * scale)) return {.distance = -skins, .cores_overlap = true};
    // The distance is at least v.w / |v| and at most |v|: stop when these have met.
    const double along = dot(v, next.w);
    if (along > far * size) return {.distance = static_cast<Real>(along / size) - skins};
    if (size * size - along <= size * kDistanceRounding * scale || holds(s, next.w)) break;
    HOOKE_ASSERT(s.count > 0 && s.count < 4);
    s.corner[s.count++] = next;
    if (!reduce(s, along > 0)) return {.distance = -skins, .cores_overlap = true};
    const Corner nearer = s.nearest();
    if (length_squared(nearer.w) >= size * size) break;
    nearest = nearer;
  }
  return between_points(a, b, nearest.on_a, nearest.on_b);
}

/// The nearest of the pairs of points that are offered.
struct NearestPoints {
  DVec3 on_a = {};
  DVec3 on_b = {};
  double squared = std::numeric_limits<double>::infinity();

  void offer(DVec3 candidate_a, DVec3 candidate_b) {
    const double size = length_squared(candidate_b - candidate_a);
    if (!(size < squared)) return;
    on_a = candidate_a;
    on_b = candidate_b;
    squared = size;
  }
};

/// Offers the points where the lines of two segments are nearest, if these are inside both.
void offer_inside(const geometry::Segment<double>& a, const geometry::Segment<double>& b,
                  NearestPoints& nearest) {
  const DVec3 along_a = a.end - a.start;
  const DVec3 along_b = b.end - b.start;
  const DVec3 normal = cross(along_a, along_b);
  const double whole = length_squared(normal);
  const double part_a = dot(cross(along_b, a.start - b.start), normal);
  const double part_b = dot(cross(along_a, a.start - b.start), normal);
  if (!(part_a > 0 && part_a < whole && part_b > 0 && part_b < whole)) return;
  nearest.offer(a.start + (part_a / whole) * along_a, b.start + (part_b / whole) * along_b);
}

/// Whether the segment goes through the triangle.
bool passes_through(const geometry::Segment<double>& s, const std::array<DVec3, 3>& corners) {
  const auto& [p, q, r] = corners;
  const DVec3 normal = cross(q - p, r - p);
  const double start = dot(normal, s.start - p);
  const double end = dot(normal, s.end - p);
  if (!(start * end < 0)) return false;
  const DVec3 at = s.start + (start / (start - end)) * (s.end - s.start);
  const auto is_inside = [&](DVec3 from, DVec3 to) { return dot(cross(to - from, at - from), normal) >= 0; };
  return is_inside(p, q) && is_inside(q, r) && is_inside(r, p);
}

/// The most frequent test of people on terrain. It compares all points that can be nearest, in a third of the
/// time.
Distance between_triangle_and_capsule(const Convex& a, const Convex& b) {
  const DVec3 half = vector_cast<double>(b.shape.half_height * b.axes.y);
  const DVec3 center = vector_cast<double>(b.center);
  const geometry::Segment<double> axis = {center - half, center + half};
  std::array<DVec3, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = vector_cast<double>(a.corners[i]);
  const auto& [p, q, r] = corners;
  NearestPoints nearest;
  for (const DVec3 end : {axis.start, axis.end})
    nearest.offer(geometry::closest_on_triangle(end, p, q, r).point, end);
  for (const DVec3 corner : corners)
    nearest.offer(corner, geometry::closest_on_segment(corner, axis.start, axis.end).point);
  offer_inside({p, q}, axis, nearest);
  offer_inside({q, r}, axis, nearest);
  offer_inside({r, p}, axis, nearest);
  const double touching = kDistanceRounding * std::max(length(nearest.on_a), length(nearest.on_b));
  if (!(nearest.squared > touching * touching) || passes_through(axis, corners))
    return {.distance = -skin_of(b), .cores_overlap = true};
  return between_points(a, b, nearest.on_a, nearest.on_b);
}

}  // namespace

Vec3 direction_across(Vec3 axis, Vec3 d, Vec3 otherwise) {
  const Vec3 across = d - dot(axis, d) * axis;
  const Real size = length(across);
  if (!(size > Real(1e-6) * length(d))) return otherwise;
  // The rounding error along the axis has grown with the rest.
  const Vec3 scaled = Real(1) / size * across;
  return scaled - dot(axis, scaled) * axis;
}

Real skin_of(const Convex& convex) {
  const ShapeKind kind = convex.shape.kind;
  return kind == ShapeKind::kSphere || kind == ShapeKind::kCapsule ? convex.shape.radius : Real(0);
}

Vec3 middle_of(const Convex& c) {
  if (c.shape.kind == ShapeKind::kMesh)
    return Real(1) / Real(3) * (c.corners[0] + c.corners[1] + c.corners[2]);
  return c.shape.kind == ShapeKind::kHull ? c.center + c.axes * c.hull->center : c.center;
}

Real thinness_of(const Convex& c) {
  switch (c.shape.kind) {
    case ShapeKind::kSphere:
    case ShapeKind::kCapsule:
      return c.shape.radius;
    case ShapeKind::kBox:
      return std::min({c.shape.half_extents.x, c.shape.half_extents.y, c.shape.half_extents.z});
    case ShapeKind::kCylinder:
    case ShapeKind::kCone:
      return std::min(c.shape.radius, c.shape.half_height);
    case ShapeKind::kHull:
      return c.hull->inner_radius;
    case ShapeKind::kMesh:
    case ShapeKind::kHalfSpace:
    case ShapeKind::kCompound:
      break;
  }
  return Real(0);
}

Vec3 support_of(const Convex& convex, Vec3 direction) {
  switch (convex.shape.kind) {
    case ShapeKind::kCapsule:
      return support_of_capsule(convex, direction);
    case ShapeKind::kBox:
      return support_of_box(convex, direction);
    case ShapeKind::kCylinder:
      return support_of_cylinder(convex, direction);
    case ShapeKind::kCone:
      return support_of_cone(convex, direction);
    case ShapeKind::kHull:
      return support_of_hull(convex, direction);
    case ShapeKind::kMesh:
      return support_of_triangle(convex, direction);
    case ShapeKind::kSphere:
    case ShapeKind::kHalfSpace:
    case ShapeKind::kCompound:
      break;
  }
  return convex.center;
}

Real separation_along(const Convex& a, const Convex& b, Vec3 n) {
  return dot(n, support_of(b, -n) - support_of(a, n)) - skin_of(a) - skin_of(b);
}

Distance distance_between(const Convex& a, const Convex& b, Real enough) {
  if (a.shape.kind == ShapeKind::kMesh && b.shape.kind == ShapeKind::kCapsule)
    return between_triangle_and_capsule(a, b);
  return distance_by_supports(a, b, enough);
}

}  // namespace hooke::collision
