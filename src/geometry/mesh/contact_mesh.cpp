#include "geometry/mesh/contact_mesh.h"

#include "base/assert.h"
#include "geometry/closest.h"
#include "math/trig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace hooke::geometry {

namespace {

constexpr double kCoordinateMax = 1e9;
constexpr double kBoundRounding = 1e-12;  ///< Error that a bound may have, over the sizes involved.

constexpr double kFlat = 1e-9;  ///< Sine of the angle below which an edge is flat.

std::string triangle_name(std::size_t index) {
  return std::string("mesh.triangles[").append(std::to_string(index)).append("]");
}

void make_normals_and_edges(ContactMesh& solid) {
  solid.edge_normals.assign(solid.topology.edges.size(), {});
  solid.vertex_normals.assign(solid.positions.size(), {});
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const DTriangle corner = solid.view().corners(t);
    const DVec3 n = solid.face_normals[t];
    for (std::size_t k = 0; k < 3; ++k) {
      solid.edge_normals[solid.topology.triangle_edges[t][k]] += n;
      const DVec3 to_next = corner[(k + 1) % 3] - corner[k];
      const DVec3 to_last = corner[(k + 2) % 3] - corner[k];
      const double angle = math::atan2(length(cross(to_next, to_last)), dot(to_next, to_last));
      solid.vertex_normals[solid.triangles[t][k]] += angle * n;
    }
  }
  for (std::size_t e = 0; e < solid.topology.edges.size(); ++e) {
    const EdgeSides& sides = solid.topology.edge_sides[e];
    HOOKE_ASSERT(sides.triangle_count == 2);  // it is closed
    const DVec3 across = solid.positions[sides.opposite[1]] - solid.positions[solid.topology.edges[e][0]];
    const double sine = dot(solid.face_normals[sides.triangles[0]], direction_or(across, {}));
    solid.is_convex_edge.push_back(sine < -kFlat ? 1 : 0);
  }
}

/// Calls `visit` with the triangles whose boxes may be within the distance that `reach` returns at that time
/// [m], near ones first.
template <class Reach, class Visit>
void visit_near(const ContactMesh& solid, DVec3 p, const Reach& reach, const Visit& visit) {
  const OrientedBoxTree& tree = solid.tree;
  if (tree.nodes.empty()) return;
  const double slack = kBoundRounding * (solid.size + length(p));
  const auto distance = [&](std::uint32_t node) {
    return std::sqrt(distance_squared(tree.nodes[node].volume, p)) - slack;
  };
  struct Open {
    std::uint32_t node = 0;
    double distance = 0;
  };
  std::array<Open, 64> open;  // one of each pair for each level of a tree that halving keeps below 25
  std::size_t count = 0;
  open[count++] = {0, distance(0)};
  while (count > 0) {
    const Open top = open[--count];
    if (top.distance > reach()) continue;
    const auto& node = tree.nodes[top.node];
    if (tree.is_leaf(top.node)) {
      for (std::uint32_t i = 0; i < node.count; ++i) visit(tree.order[node.first + i]);
      continue;
    }
    Open near = {top.node + 1, distance(top.node + 1)};
    Open far = {tree.nodes[near.node].next, distance(tree.nodes[near.node].next)};
    if (far.distance < near.distance) std::swap(near, far);
    HOOKE_ASSERT(count + 2 <= open.size());
    open[count++] = far;
    open[count++] = near;
  }
}

template <class Visit>
void visit_all(const ContactMesh& solid, const Visit& visit) {
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) visit(t);
}

DVec3 normal_at(const ContactMesh& solid, const SolidPoint& place) {
  switch (place.feature) {
    case SurfaceFeature::kEdge:
      return solid.edge_normals[place.index];
    case SurfaceFeature::kVertex:
      return solid.vertex_normals[place.index];
    case SurfaceFeature::kFace:
      break;
  }
  return solid.face_normals[place.index];
}

/// Names the part of the triangle that has these weights of its corners.
void name_feature(const ContactMesh& solid, const DVec3& weights, SolidPoint& place) {
  const std::array<double, 3> weight = {weights.x, weights.y, weights.z};
  const auto zeros = std::count(weight.begin(), weight.end(), 0.0);
  place.feature = SurfaceFeature::kFace;
  place.index = place.triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    if (zeros == 2 && weight[k] != 0) {
      place.feature = SurfaceFeature::kVertex;
      place.index = solid.triangles[place.triangle][k];
    } else if (zeros == 1 && weight[k] == 0) {
      place.feature = SurfaceFeature::kEdge;
      place.index = solid.topology.triangle_edges[place.triangle][(k + 1) % 3];
    }
  }
}

TrianglePoint<double> closest_in(const ContactMesh& solid, std::uint32_t triangle, DVec3 p) {
  const auto [a, b, c] = solid.view().corners(triangle);
  return closest_on_triangle(p, a, b, c);
}

SolidPoint place_on(const ContactMesh& solid, std::uint32_t triangle, const TrianglePoint<double>& near,
                    DVec3 p) {
  SolidPoint place = {.point = near.point, .triangle = triangle};
  name_feature(solid, near.weights, place);
  const double distance = std::sqrt(near.distance_squared);
  const bool is_inside = dot(normal_at(solid, place), p - near.point) < 0;
  place.signed_distance = is_inside ? -distance : distance;
  return place;
}

}  // namespace

Result<ContactMesh> make_contact_mesh(const MeshDesc& mesh) {
  if (Result<void> valid = validate_solid(mesh); !valid) return valid.error();
  ContactMesh solid;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto p = vector_cast<double>(mesh.positions[i]);
    const double size = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    if (size > kCoordinateMax) {
      return Error{.code = ErrorCode::kOutOfRange,
                   .where = std::string("mesh.positions[").append(std::to_string(i)).append("]"),
                   .message = "a coordinate is beyond 1e9 m"};
    }
    solid.size = std::max(solid.size, size);
    solid.positions.push_back(p);
  }
  solid.triangles = mesh.triangles;
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const auto [a, b, c] = solid.view().corners(t);
    // Edges are scaled to one length: a sliver has a direction where squares of its sides would be zero.
    const DVec3 normal = normalize(cross(direction_or(b - a, {}), direction_or(c - a, {})));
    if (normal == DVec3{}) {
      return Error{.code = ErrorCode::kOutOfRange, .where = triangle_name(t), .message = "has no area"};
    }
    solid.face_normals.push_back(normal);
  }
  solid.topology = compute_topology(solid.positions.size(), solid.triangles);
  make_normals_and_edges(solid);
  solid.sphere = minimum_sphere(solid.positions);
  solid.tree = build_volume_tree<OrientedBox>(solid.view());
  return solid;
}

SolidPoint closest_on_face(const ContactMesh& solid, std::uint32_t triangle, DVec3 p) {
  return place_on(solid, triangle, closest_in(solid, triangle, p), p);
}

SolidPoint closest_on_solid(const ContactMesh& solid, DVec3 p, Search search) {
  std::uint32_t best = 0;
  TrianglePoint<double> nearest = {.distance_squared = std::numeric_limits<double>::infinity()};
  const auto visit = [&](std::uint32_t t) {
    const TrianglePoint<double> near = closest_in(solid, t, p);
    const bool is_nearer = near.distance_squared < nearest.distance_squared ||
                           (near.distance_squared == nearest.distance_squared && t < best);
    if (!is_nearer) return;
    nearest = near;
    best = t;
  };
  if (search == Search::kAll) {
    visit_all(solid, visit);
  } else {
    visit_near(
        solid, p, [&] { return std::sqrt(nearest.distance_squared); }, visit);
  }
  return place_on(solid, best, nearest, p);
}

void find_near_faces(const ContactMesh& solid, DVec3 p, double distance, Search search,
                     std::vector<std::uint32_t>& found) {
  found.clear();
  const auto visit = [&](std::uint32_t t) {
    if (closest_in(solid, t, p).distance_squared <= distance * distance) found.push_back(t);
  };
  if (search == Search::kAll) {
    visit_all(solid, visit);
  } else {
    visit_near(
        solid, p, [&] { return distance; }, visit);
  }
  std::sort(found.begin(), found.end());
}

}  // namespace hooke::geometry
