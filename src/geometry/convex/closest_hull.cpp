#include "geometry/convex/closest_hull.h"

#include "base/assert.h"

#include <cstddef>

namespace hooke::geometry {

namespace {

Real height_over(const ConvexHull::Face& face, Vec3 p) {
  return dot(face.normal, p) - face.offset;
}

/// Whether `p`, seen along the normal, is over the polygon.
bool is_over(const ConvexHull& hull, const ConvexHull::Face& face, Vec3 p) {
  HOOKE_ASSERT(face.count >= 3 && face.first + face.count <= hull.loop.size());
  Vec3 from = hull.vertices[hull.loop[face.first + face.count - std::size_t{1}]];
  for (std::size_t i = 0; i < face.count; ++i) {
    const Vec3 to = hull.vertices[hull.loop[face.first + i]];
    if (dot(face.normal, cross(to - from, p - from)) < Real(0)) return false;
    from = to;
  }
  return true;
}

/// Finds the surface point for a `p` that is over no face: on the edges between a face that it is in front of
/// and another.
SurfacePoint<Real> closest_on_edges(Vec3 p, const ConvexHull& hull, Vec3 normal_on_edge) {
  SegmentPoint<Real> best = {.distance_squared = std::numeric_limits<Real>::infinity()};
  for (const ConvexHull::Edge& edge : hull.edges) {
    const bool is_in_front = height_over(hull.faces[edge.face_a], p) > Real(0) ||
                             height_over(hull.faces[edge.face_b], p) > Real(0);
    if (!is_in_front) continue;
    const auto near = closest_on_segment(p, hull.vertices[edge.vertex_a], hull.vertices[edge.vertex_b]);
    if (near.distance_squared < best.distance_squared) best = near;
  }
  const Vec3 out = p - best.point;
  return {best.point, safe_length(out), direction_or(out, normal_on_edge)};
}

}  // namespace

SurfacePoint<Real> closest_on_hull(Vec3 p, const ConvexHull& hull) {
  HOOKE_ASSERT(!hull.faces.empty());
  std::size_t highest = 0;
  for (std::size_t i = 0; i < hull.faces.size(); ++i) {
    const ConvexHull::Face& face = hull.faces[i];
    const Real height = height_over(face, p);
    if (height > Real(0) && is_over(hull, face, p)) return {p - height * face.normal, height, face.normal};
    if (height > height_over(hull.faces[highest], p)) highest = i;
  }
  const ConvexHull::Face& face = hull.faces[highest];
  const Real height = height_over(face, p);
  if (height > Real(0)) return closest_on_edges(p, hull, face.normal);
  return {p - height * face.normal, height, face.normal};
}

}  // namespace hooke::geometry
