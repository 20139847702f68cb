#include "geometry/mesh/protrusions.h"

#include "geometry/mesh/mesh_clean.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr double kLeastBend = 0.01;  ///< Sine of the angle between the two sides of a ridge.

/// The mesh with the vertices at one position united. Triangles that lose their area by that are left out.
struct WeldedMesh {
  std::vector<DVec3> positions;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> triangle_of;  ///< Triangle of the given mesh, for each of `triangles`.
  std::vector<std::uint32_t> vertex_of;    ///< Vertex of the given mesh, for each of `positions`.
  MeshTopology topology;
};

WeldedMesh weld_mesh(const MeshDesc& mesh) {
  std::vector<DVec3> points;
  points.reserve(mesh.positions.size());
  for (const Vec3 p : mesh.positions) points.push_back(vector_cast<double>(p));
  Weld welded = weld(points, weld_distance(points));
  WeldedMesh result;
  for (const std::uint32_t point : welded.first) result.positions.push_back(points[point]);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle corners = mesh.triangles[t];
    for (std::uint32_t& corner : corners) corner = welded.welded_of[corner];
    const auto [a, b, c] = corners;
    if (a == b || b == c || c == a) continue;
    result.triangles.push_back(corners);
    result.triangle_of.push_back(t);
  }
  result.vertex_of = std::move(welded.first);
  result.topology = compute_topology(result.positions.size(), result.triangles);
  return result;
}

DVec3 normal_of(const WeldedMesh& mesh, std::uint32_t triangle) {
  const auto [a, b, c] = mesh.triangles[triangle];
  const DVec3 across = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
  const double size = length(across);
  return size > 0 ? (1 / size) * across : DVec3{};
}

/// An edge that ends or branches, or whose front is not known, may protrude as well.
bool is_ridge(const WeldedMesh& mesh, std::size_t edge) {
  const EdgeSides& sides = mesh.topology.edge_sides[edge];
  if (sides.triangle_count != 2 || !sides.has_same_winding) return true;
  const DVec3 start = mesh.positions[mesh.topology.edges[edge][0]];
  const DVec3 along = mesh.positions[mesh.topology.edges[edge][1]] - start;
  const DVec3 beyond = mesh.positions[sides.opposite[1]] - start;
  const double across = length(cross(along, beyond));
  return dot(normal_of(mesh, sides.triangles[0]), beyond) * length(along) < -kLeastBend * across;
}

/// A protrusion before it has its row in the table.
struct Found {
  std::uint32_t triangle = 0;  ///< Triangle of the given mesh.
  Edge ends = {};
  std::vector<std::uint32_t> neighbors;
};

std::vector<Found> find_all(const WeldedMesh& mesh) {
  const MeshTopology& topology = mesh.topology;
  std::vector<std::vector<std::uint32_t>> joined(mesh.positions.size());
  std::vector<std::uint8_t> is_peak(mesh.positions.size(), 0);
  std::vector<Found> found;
  for (std::size_t edge = 0; edge < topology.edges.size(); ++edge) {
    const auto [a, b] = topology.edges[edge];
    joined[a].push_back(b);
    joined[b].push_back(a);
    if (!is_ridge(mesh, edge)) continue;
    is_peak[a] = is_peak[b] = 1;
    const EdgeSides& sides = topology.edge_sides[edge];
    found.push_back({sides.triangles[0], {a, b}, {sides.opposite[0]}});
    if (sides.opposite[1] != kNone) found.back().neighbors.push_back(sides.opposite[1]);
  }
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (is_peak[v] != 0) found.push_back({topology.triangles_at(v).front(), {v, v}, std::move(joined[v])});
  }
  for (Found& one : found) {
    one.triangle = mesh.triangle_of[one.triangle];
    for (std::uint32_t& vertex : one.ends) vertex = mesh.vertex_of[vertex];
    for (std::uint32_t& vertex : one.neighbors) vertex = mesh.vertex_of[vertex];
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& x, const Found& y) { return x.triangle < y.triangle; });
  return found;
}

}  // namespace

Protrusions find_protrusions(const MeshDesc& mesh) {
  Protrusions result;
  result.neighbor_begin.push_back(0);
  result.triangle_begin.push_back(0);
  for (const Found& one : find_all(weld_mesh(mesh))) {
    while (result.triangle_begin.size() <= one.triangle)
      result.triangle_begin.push_back(static_cast<std::uint32_t>(result.ends.size()));
    result.ends.push_back(one.ends);
    result.neighbors.insert(result.neighbors.end(), one.neighbors.begin(), one.neighbors.end());
    result.neighbor_begin.push_back(static_cast<std::uint32_t>(result.neighbors.size()));
  }
  result.triangle_begin.resize(mesh.triangles.size() + 1, static_cast<std::uint32_t>(result.ends.size()));
  return result;
}

}  // namespace hooke::geometry
