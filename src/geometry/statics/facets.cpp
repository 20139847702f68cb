#include "geometry/statics/facets.h"

#include "geometry/convex/convex_hull.h"
#include "geometry/convex/mass_properties.h"
#include "geometry/mesh/winding_number.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace hooke::geometry {

namespace {

constexpr double kMarginMin = 1e-6;  // In units of the hull's outer radius.

DVec3 normal_of(const std::vector<DVec3>& corners) {
  DVec3 sum = {};
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    sum += cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
  }
  return normalize(sum);
}

Facet make_facet(const ConvexHull& hull, const ConvexHull::Face& face, DVec3 center) {
  Facet facet;
  for (std::size_t k = 0; k < face.count; ++k) {
    facet.corners.push_back(vector_cast<double>(hull.vertices[hull.loop[face.first + k]]));
  }
  facet.normal = normal_of(facet.corners);
  facet.height = -std::numeric_limits<double>::infinity();
  for (const DVec3& corner : facet.corners) {
    facet.height = std::max(facet.height, dot(facet.normal, corner - center));
  }
  double half_angles = 0;
  for (std::size_t k = 1; k + 1 < facet.corners.size(); ++k) {
    half_angles += half_solid_angle({facet.corners[0], facet.corners[k], facet.corners[k + 1]}, center);
  }
  facet.share = half_angles / (2 * std::numbers::pi);
  return facet;
}

/// Notes how far the center is inside a side of the facet that runs along `direction` from `corner`.
void note_side(Facet& facet, DVec3 corner, DVec3 direction, DVec3 center, std::uint32_t neighbor) {
  const double inside = dot(normalize(cross(direction, facet.normal)), corner - center);
  if (inside >= facet.margin) return;
  facet.margin = inside;
  facet.neighbor = neighbor;
}

std::vector<Facet> make_facets(const ConvexHull& hull, DVec3 center) {
  std::vector<Facet> facets;
  facets.reserve(hull.faces.size());
  for (const ConvexHull::Face& face : hull.faces) facets.push_back(make_facet(hull, face, center));
  for (const ConvexHull::Edge& edge : hull.edges) {
    const auto a = vector_cast<double>(hull.vertices[edge.vertex_a]);
    const auto b = vector_cast<double>(hull.vertices[edge.vertex_b]);
    note_side(facets[edge.face_a], a, b - a, center, edge.face_b);
    note_side(facets[edge.face_b], b, a - b, center, edge.face_a);
  }
  return facets;
}

/// The largest distance of a point outside the hull from it.
double outside_by(const std::vector<Vec3>& points, const std::vector<Facet>& facets) {
  double most = 0;
  for (const Vec3& point : points) {
    for (const Facet& facet : facets) {
      most = std::max(most, dot(facet.normal, vector_cast<double>(point) - facet.corners[0]));
    }
  }
  return most;
}

Result<DVec3> center_of(const MeshDesc& mesh) {
  if (const auto solid = validate_solid(mesh); !solid) {
    Error error = solid.error();
    error.message += "; mend the mesh (repair_solid, remesh_solid), or give the center of mass";
    return error;
  }
  return mass_of(mesh.positions, mesh.triangles).center;
}

/// The points that triangles use: others are no part of the surface.
std::vector<Vec3> points_of(const MeshDesc& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) used[v] = 1;
  }
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] != 0) points.push_back(mesh.positions[i]);
  }
  return points;
}

}  // namespace

Result<FacetedSolid> make_faceted_solid(const MeshDesc& mesh, std::optional<DVec3> center) {
  if (const auto usable = validate_mesh(mesh); !usable) return usable.error();
  if (!center) {
    const Result<DVec3> found = center_of(mesh);
    if (!found) return found.error();
    center = found.value();
  }
  if (!is_finite(*center)) return Error{ErrorCode::kOutOfRange, "center", "a coordinate is not finite"};
  const std::vector<Vec3> points = points_of(mesh);
  const Result<ConvexHull> hull = make_convex_hull(points);
  if (!hull) return hull.error();
  FacetedSolid solid = {.facets = make_facets(hull.value(), *center),
                        .center = *center,
                        .margin_min = kMarginMin * static_cast<double>(hull.value().outer_radius)};
  for (const Facet& facet : solid.facets) {
    if (facet.height > solid.margin_min) continue;
    return Error{ErrorCode::kOutOfRange, "center",
                 "the center of mass is not inside the convex hull: it is " + std::to_string(-facet.height) +
                     " m outside a facet; give one that is inside"};
  }
  solid.hull_error = outside_by(points, solid.facets);
  return solid;
}

Quaternion<double> turn_down(DVec3 normal) {
  const Quaternion<double> q = {normal.z, 0, -normal.x, 1 - normal.y};
  return q.w > 1e-12 ? normalize(q) : Quaternion<double>{1, 0, 0, 0};
}

}  // namespace hooke::geometry
