#include "geometry/triangle_mesh.h"

#include "base/assert.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace hooke::geometry {

namespace {

Error mesh_error(ErrorCode code, const std::string& where, std::string message) {
  return {.code = code, .where = std::string("mesh.").append(where), .message = std::move(message)};
}

std::string element(const char* name, std::size_t index) {
  return std::string(name).append("[").append(std::to_string(index)).append("]");
}

std::string as_text(const Triangle& t) {
  std::string text = "{";
  text.append(std::to_string(t[0])).append(", ").append(std::to_string(t[1])).append(", ");
  return text.append(std::to_string(t[2])).append("}");
}

void list_triangles_by_vertex(std::size_t vertex_count, std::span<const Triangle> triangles,
                              MeshTopology& topology) {
  std::vector<std::uint32_t>& begin = topology.vertex_triangle_begin;
  begin.assign(vertex_count + 1, 0);
  for (const Triangle& t : triangles) {
    HOOKE_ASSERT(std::max({t[0], t[1], t[2]}) < vertex_count);
    for (const std::uint32_t vertex : t) ++begin[vertex + 1];
  }
  for (std::size_t v = 0; v < vertex_count; ++v) begin[v + 1] += begin[v];
  topology.vertex_triangles.resize(3 * triangles.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t vertex : triangles[t]) topology.vertex_triangles[next[vertex]++] = t;
  }
}

/// One triangle's side of an edge, seen from the edge's first vertex.
struct Side {
  std::uint32_t other = 0;  // the edge's second vertex
  std::uint32_t triangle = 0;
  std::uint32_t number = 0;  // number of the edge in the triangle
  bool is_forward = false;   // the triangle runs from the first to the second vertex
};

/// All sides of edges whose first vertex is `vertex`, by second vertex, then by triangle.
void collect_sides(std::uint32_t vertex, std::span<const Triangle> triangles, const MeshTopology& topology,
                   std::vector<Side>& sides) {
  sides.clear();
  for (const std::uint32_t t : topology.triangles_at(vertex)) {
    const Triangle& triangle = triangles[t];
    const std::uint32_t corner = triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
    HOOKE_ASSERT(triangle[corner] == vertex);
    const std::uint32_t after = (corner + 1) % 3;
    const std::uint32_t before = (corner + 2) % 3;
    if (triangle[after] > vertex) sides.push_back({triangle[after], t, corner, true});
    if (triangle[before] > vertex) sides.push_back({triangle[before], t, before, false});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.other, a.triangle) < std::tie(b.other, b.triangle);
  });
}

/// Makes the edge of `sides`, which all belong to it.
EdgeSides make_edge_sides(std::span<const Side> sides, std::span<const Triangle> triangles) {
  EdgeSides edge;
  edge.triangle_count = static_cast<std::uint32_t>(sides.size());
  for (std::size_t i = 0; i < std::min<std::size_t>(sides.size(), 2); ++i) {
    HOOKE_ASSERT(sides[i].number < 3);
    edge.triangles[i] = sides[i].triangle;
    edge.opposite[i] = triangles[sides[i].triangle][(sides[i].number + 2) % 3];
  }
  edge.has_same_winding = sides.size() < 2 || sides[0].is_forward != sides[1].is_forward;
  return edge;
}

/// Appends the edges whose sides these are; the sides of one edge are next to each other.
void append_edges(std::uint32_t vertex, std::span<const Side> sides, std::span<const Triangle> triangles,
                  MeshTopology& topology) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    const auto edge = static_cast<std::uint32_t>(topology.edges.size());
    for (end = begin; end < sides.size() && sides[end].other == sides[begin].other; ++end) {
      topology.triangle_edges[sides[end].triangle][sides[end].number] = edge;
    }
    topology.edges.push_back({vertex, sides[begin].other});
    topology.edge_sides.push_back(make_edge_sides(sides.subspan(begin, end - begin), triangles));
  }
}

void count_kinds_of_edges(MeshTopology& topology) {
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const EdgeSides& sides = topology.edge_sides[e];
    if (sides.triangle_count == 1) {
      ++topology.border_edge_count;
      for (const std::uint32_t vertex : topology.edges[e]) topology.is_border_vertex[vertex] = 1;
    }
    if (sides.triangle_count > 2) ++topology.branching_edge_count;
    if (sides.triangle_count == 2 && !sides.has_same_winding) ++topology.opposite_winding_edge_count;
  }
}

}  // namespace

Result<void> validate_mesh(const MeshDesc& mesh) {
  const std::size_t vertex_count = mesh.positions.size();
  if (vertex_count > kVertexLimit) {
    return mesh_error(ErrorCode::kLimitExceeded, "positions",
                      std::to_string(vertex_count) + " positions; at most " + std::to_string(kVertexLimit));
  }
  if (mesh.triangles.size() > kTriangleLimit) {
    return mesh_error(
        ErrorCode::kLimitExceeded, "triangles",
        std::to_string(mesh.triangles.size()) + " triangles; at most " + std::to_string(kTriangleLimit));
  }
  if (mesh.triangles.empty()) {
    return mesh_error(ErrorCode::kOutOfRange, "triangles", "a mesh needs at least one triangle");
  }
  for (std::size_t i = 0; i < vertex_count; ++i) {
    if (is_finite(mesh.positions[i])) continue;
    return mesh_error(ErrorCode::kOutOfRange, element("positions", i), "a coordinate is not finite");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (std::max({t[0], t[1], t[2]}) >= vertex_count) {
      return mesh_error(
          ErrorCode::kOutOfRange, element("triangles", i),
          as_text(t) + " names a vertex beyond the " + std::to_string(vertex_count) + " positions");
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      return mesh_error(ErrorCode::kOutOfRange, element("triangles", i),
                        as_text(t) + " names a vertex twice; a triangle has three different corners");
    }
  }
  return {};
}

Result<void> validate_solid(const MeshDesc& mesh) {
  if (Result<void> usable = validate_mesh(mesh); !usable) return usable;
  const MeshTopology topology = compute_topology(mesh.positions.size(), mesh.triangles);
  for (const EdgeSides& sides : topology.edge_sides) {
    const std::string where = element("triangles", sides.triangles[0]);
    if (sides.triangle_count == 1) {
      return mesh_error(ErrorCode::kOutOfRange, where,
                        "has an edge without a neighbor, one of " +
                            std::to_string(topology.border_edge_count) + "; a solid's surface is closed");
    }
    if (sides.triangle_count > 2) {
      return mesh_error(ErrorCode::kOutOfRange, where,
                        "has an edge with " + std::to_string(sides.triangle_count) +
                            " triangles; a solid's surface has two at each");
    }
    if (!sides.has_same_winding) {
      return mesh_error(ErrorCode::kOutOfRange, where,
                        "and triangle " + std::to_string(sides.triangles[1]) + " face opposite sides");
    }
  }
  const double volume = compute_signed_volume(mesh.positions, mesh.triangles);
  if (!(volume > 0)) {
    return mesh_error(ErrorCode::kOutOfRange, "triangles",
                      "enclose " + std::to_string(volume) +
                          " m^3; a solid's triangles are counter-clockwise seen from outside");
  }
  return {};
}

MeshTopology compute_topology(std::size_t vertex_count, std::span<const Triangle> triangles) {
  MeshTopology topology;
  list_triangles_by_vertex(vertex_count, triangles, topology);
  topology.triangle_edges.resize(triangles.size());
  topology.is_border_vertex.assign(vertex_count, 0);
  std::vector<Side> sides;
  for (std::uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
    collect_sides(vertex, triangles, topology, sides);
    append_edges(vertex, sides, triangles, topology);
  }
  count_kinds_of_edges(topology);
  return topology;
}

std::vector<Real> compute_vertex_areas(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::vector<double> sums(positions.size(), 0.0);
  for (const Triangle& t : triangles) {
    const DVec3 a = vector_cast<double>(positions[t[0]]);
    const DVec3 ab = vector_cast<double>(positions[t[1]]) - a;
    const DVec3 ac = vector_cast<double>(positions[t[2]]) - a;
    const double third = length(cross(ab, ac)) / 6.0;
    for (const std::uint32_t vertex : t) sums[vertex] += third;
  }
  std::vector<Real> areas(positions.size());
  std::transform(sums.begin(), sums.end(), areas.begin(), [](double sum) { return static_cast<Real>(sum); });
  return areas;
}

std::vector<Real> compute_edge_lengths(std::span<const Vec3> positions, std::span<const Edge> edges) {
  std::vector<Real> lengths(edges.size());
  std::transform(edges.begin(), edges.end(), lengths.begin(), [&](const Edge& edge) {
    const DVec3 a = vector_cast<double>(positions[edge[0]]);
    return static_cast<Real>(length(vector_cast<double>(positions[edge[1]]) - a));
  });
  return lengths;
}

double compute_signed_volume(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  if (triangles.empty()) return 0.0;
  // Tetrahedra reach to a point of the mesh, not to the frame's origin: a small mesh far away keeps its
  // digits.
  const DVec3 apex = vector_cast<double>(positions[triangles[0][0]]);
  double sum = 0.0;
  for (const Triangle& t : triangles) {
    const DVec3 a = vector_cast<double>(positions[t[0]]) - apex;
    const DVec3 b = vector_cast<double>(positions[t[1]]) - apex;
    const DVec3 c = vector_cast<double>(positions[t[2]]) - apex;
    sum += dot(a, cross(b, c));
  }
  return sum / 6.0;
}

}  // namespace hooke::geometry
