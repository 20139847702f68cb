#include "hooke/statics.h"

#include "base/float_environment.h"
#include "geometry/convex/convex_hull.h"
#include "geometry/convex/mass_properties.h"
#include "geometry/mesh/winding_number.h"
#include "geometry/triangle_mesh.h"
#include "math/trig.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

namespace hooke {

namespace {

using geometry::ConvexHull;

constexpr double kMarginMin = 1e-6;  // In units of the hull's outer radius.

/// A facet of the hull, as the center of mass sees it.
struct Facet {
  DVec3 normal = {};
  std::vector<DVec3> corners = {};
  double height = 0;  ///< Distance of the center of mass from the facet's plane [m].
  /// Least distance of the center, seen along the normal, from a side [m]; negative beyond it.
  double margin = std::numeric_limits<double>::infinity();
  std::uint32_t neighbor = 0;  ///< The facet across that side.
  double share = 0;            ///< Solid angle over 4 pi, and what other facets passed on.
};

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
    half_angles +=
        geometry::half_solid_angle({facet.corners[0], facet.corners[k], facet.corners[k + 1]}, center);
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

/// Passes the shares of facets that cannot bear the center on, from the highest center down, and returns the
/// facets that keep theirs. A solid that rolls over a side which its center has passed lowers the center, so
/// that nothing goes in a circle. Where rounding says otherwise, the facet keeps its share.
std::vector<std::uint32_t> roll(std::vector<Facet>& facets, double margin_min) {
  std::vector<std::uint32_t> order(facets.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&facets](std::uint32_t a, std::uint32_t b) {
    return facets[a].height > facets[b].height;
  });
  std::vector<std::uint32_t> rest;
  for (const std::uint32_t i : order) {
    Facet& facet = facets[i];
    Facet& next = facets[facet.neighbor];
    if (facet.margin > margin_min || !(next.height < facet.height)) {
      rest.push_back(i);
      continue;
    }
    next.share += facet.share;
    facet.share = 0;
  }
  return rest;
}

/// The shortest rotation that turns a unit vector straight down.
Quaternion<double> turn_down(DVec3 normal) {
  const Quaternion<double> q = {normal.z, 0, -normal.x, 1 - normal.y};
  return q.w > 1e-12 ? normalize(q) : Quaternion<double>{1, 0, 0, 0};
}

StablePose pose_of(Facet& facet, DVec3 center) {
  StablePose pose;
  pose.normal = facet.normal;
  pose.support = std::move(facet.corners);
  pose.rotation = turn_down(facet.normal);
  pose.position = DVec3{0, facet.height, 0} - rotate(pose.rotation, center);
  pose.height = facet.height;
  pose.margin = std::max(facet.margin, 0.0);
  pose.tip_angle = math::atan2(pose.margin, pose.height);
  // This is sqrt(height^2 + margin^2) - height, without the difference of two near numbers.
  const double reach = std::sqrt(pose.height * pose.height + pose.margin * pose.margin);
  pose.tip_height = pose.margin * pose.margin / (reach + pose.height);
  pose.probability = facet.share;
  return pose;
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
  if (const auto solid = geometry::validate_solid(mesh); !solid) {
    Error error = solid.error();
    error.message += "; mend the mesh (repair_solid, remesh_solid), or give the center of mass";
    return error;
  }
  return geometry::mass_of(mesh.positions, mesh.triangles).center;
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

Result<StablePoses> find_stable_poses(const MeshDesc& mesh, std::optional<DVec3> center) {
  const base::FloatEnvironment environment;
  if (const auto usable = geometry::validate_mesh(mesh); !usable) return usable.error();
  if (!center) {
    const Result<DVec3> found = center_of(mesh);
    if (!found) return found.error();
    center = found.value();
  }
  if (!is_finite(*center)) return Error{ErrorCode::kOutOfRange, "center", "a coordinate is not finite"};
  const std::vector<Vec3> points = points_of(mesh);
  const Result<ConvexHull> hull = geometry::make_convex_hull(points);
  if (!hull) return hull.error();
  std::vector<Facet> facets = make_facets(hull.value(), *center);
  const double margin_min = kMarginMin * static_cast<double>(hull.value().outer_radius);
  for (const Facet& facet : facets) {
    if (facet.height > margin_min) continue;
    return Error{ErrorCode::kOutOfRange, "center",
                 "the center of mass is not inside the convex hull: it is " + std::to_string(-facet.height) +
                     " m outside a facet; give one that is inside"};
  }
  StablePoses result = {.center = *center, .hull_error = outside_by(points, facets)};
  double sum = 0;
  for (const std::uint32_t i : roll(facets, margin_min)) {
    result.poses.push_back(pose_of(facets[i], *center));
    sum += result.poses.back().probability;
  }
  // The solid angles of a closed hull make 4 pi up to rounding.
  for (StablePose& pose : result.poses) pose.probability /= sum;
  std::stable_sort(result.poses.begin(), result.poses.end(),
                   [](const StablePose& a, const StablePose& b) { return a.probability > b.probability; });
  return result;
}

}  // namespace hooke
