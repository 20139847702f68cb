#include "collision/distance/shape_gap.h"

#include "base/assert.h"
#include "geometry/closest.h"
#include "geometry/convex/closest_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::collision {

namespace {

Gap gap_of(const geometry::SurfacePoint<Real>& surface) {
  return {surface.signed_distance, surface.normal};
}

}  // namespace

Gap gap_to_shape(const Shape& shape, Vec3 x) {
  switch (shape.kind) {
    case ShapeKind::kHalfSpace:
      return gap_of(geometry::closest_on_half_space(x));
    case ShapeKind::kSphere:
      return gap_of(geometry::closest_on_sphere(x, shape.radius));
    case ShapeKind::kBox:
      return gap_of(geometry::closest_on_box(x, shape.half_extents));
    case ShapeKind::kCapsule:
      return gap_of(geometry::closest_on_capsule(x, shape.radius, shape.half_height));
    case ShapeKind::kCylinder:
      return gap_of(geometry::closest_on_cylinder(x, shape.radius, shape.half_height));
    case ShapeKind::kCone:
      return gap_of(geometry::closest_on_cone(x, shape.radius, shape.half_height));
    case ShapeKind::kMesh:
    case ShapeKind::kHull:
    case ShapeKind::kCompound:
      break;
  }
  return {std::numeric_limits<Real>::infinity(), {Real(0), Real(1), Real(0)}};
}

Gap gap_to_shape(const state::ColliderShape& shape, Vec3 x) {
  if (shape.shape.kind == ShapeKind::kHull) return gap_of(geometry::closest_on_hull(x, *shape.hull));
  return gap_to_shape(shape.shape, x);
}

TriangleGap gap_to_triangle(const state::Mesh& mesh, std::uint32_t triangle, Vec3 x) {
  HOOKE_ASSERT(triangle < mesh.desc.triangles.size());
  const auto [ia, ib, ic] = mesh.desc.triangles[triangle];
  const Vec3 a = mesh.desc.positions[ia];
  const Vec3 b = mesh.desc.positions[ib];
  const Vec3 c = mesh.desc.positions[ic];
  const auto nearest = geometry::closest_on_triangle(x, a, b, c);
  const Vec3 front = normalize(cross(b - a, c - a));
  const Real height = dot(front, x - a);
  const Vec3 w = nearest.weights;
  TriangleGap result;
  result.unsigned_distance = std::sqrt(nearest.distance_squared);
  result.over_face = w.x > Real(0) && w.y > Real(0) && w.z > Real(0);
  if (result.over_face) {
    result.gap = {height, front};
    return result;
  }
  const bool in_front = height >= Real(0);
  result.gap.distance = in_front ? result.unsigned_distance : -result.unsigned_distance;
  const Vec3 away = geometry::direction_or(x - nearest.point, front);
  result.gap.normal = in_front ? away : -away;
  return result;
}

Gap gap_on_side(const TriangleGap& gap, std::optional<bool> is_inside) {
  const bool is_right = gap.over_face || !is_inside || (gap.gap.distance < Real(0)) == *is_inside;
  return is_right ? gap.gap : Gap{-gap.gap.distance, -gap.gap.normal};
}

std::optional<bool> is_inside(const state::Mesh& mesh, Vec3 x) {
  if (!mesh.is_solid()) return {};
  return is_solid_at(mesh.planes, vector_cast<double>(x));
}

void find_triangles_near(const state::Mesh& mesh, Vec3 x, Real reach, std::vector<std::uint32_t>& found) {
  const Vec3 r = {reach, reach, reach};
  geometry::find_triangles(mesh.bvh, {.lower = x - r, .upper = x + r}, found);
  std::erase_if(found, [&](std::uint32_t triangle) {
    const auto [a, b, c] = mesh.desc.triangles[triangle];
    const auto& p = mesh.desc.positions;
    return geometry::closest_on_triangle(x, p[a], p[b], p[c]).distance_squared > reach * reach;
  });
  if (!is_inside(mesh, x).value_or(false)) return;
  const std::uint32_t nearest = geometry::find_closest(mesh.bvh, x).value().triangle;
  const auto place = std::lower_bound(found.begin(), found.end(), nearest);
  if (place == found.end() || *place != nearest) found.insert(place, nearest);
}

Real distance_to_mesh(const state::Mesh& mesh, Vec3 x, Real reach) {
  const std::optional<bool> inside = is_inside(mesh, x);
  const Real farthest = inside.value_or(false) ? std::numeric_limits<Real>::infinity() : reach;
  const auto nearest = geometry::find_closest(mesh.bvh, x, farthest);
  if (!nearest) return reach;
  return gap_on_side(gap_to_triangle(mesh, nearest->triangle, x), inside).distance;
}

}  // namespace hooke::collision
