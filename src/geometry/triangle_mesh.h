#pragma once

#include "hooke/result.h"
#include "hooke/shape.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hooke::geometry {

using Triangle = std::array<std::uint32_t, 3>;  ///< Vertices, counter-clockwise seen from outside.
using Edge = std::array<std::uint32_t, 2>;      ///< Vertices, the smaller index first.

inline constexpr std::uint32_t kNone = 0xFFFFFFFF;
inline constexpr std::size_t kVertexLimit = std::size_t{1} << 24;
inline constexpr std::size_t kTriangleLimit = std::size_t{1} << 25;

/// The triangles at an edge. Of more than two, the two with the smallest indices are kept.
struct EdgeSides {
  std::array<std::uint32_t, 2> triangles = {kNone, kNone};  ///< Ascending; kNone for a missing one.
  std::array<std::uint32_t, 2> opposite = {kNone, kNone};   ///< The corner of each triangle that is not on
                                                            ///< the edge.
  std::uint32_t triangle_count = 0;  ///< 1 at a border, 2 inside, more where the surface branches.
  bool has_same_winding = true;      ///< The two kept triangles run along the edge in opposite directions.
};

/// Neighbors in a triangle mesh. It depends on the triangles only, not on positions.
struct MeshTopology {
  std::vector<Edge> edges = {};            ///< Each once, in ascending order of (first, second) vertex.
  std::vector<EdgeSides> edge_sides = {};  ///< One for each edge.
  /// Edges of each triangle: number k joins corners k and k + 1.
  std::vector<std::array<std::uint32_t, 3>> triangle_edges = {};
  /// Triangles at vertex v, ascending: vertex_triangles[vertex_triangle_begin[v] .. vertex_triangle_begin[v +
  /// 1]).
  std::vector<std::uint32_t> vertex_triangle_begin = {};
  std::vector<std::uint32_t> vertex_triangles = {};
  std::vector<std::uint8_t> is_border_vertex = {};  ///< 1 where an edge with a single triangle ends.
  std::uint32_t border_edge_count = 0;
  std::uint32_t branching_edge_count = 0;         ///< Edges with more than two triangles.
  std::uint32_t opposite_winding_edge_count = 0;  ///< Inner edges whose two triangles face opposite sides.

  /// The triangles at `vertex`, ascending.
  [[nodiscard]] std::span<const std::uint32_t> triangles_at(std::uint32_t vertex) const {
    const std::uint32_t begin = vertex_triangle_begin[vertex];
    return {vertex_triangles.data() + begin, vertex_triangle_begin[vertex + 1] - begin};
  }
  /// Whether the surface has an inside and an outside everywhere.
  [[nodiscard]] bool is_closed() const {
    return border_edge_count == 0 && branching_edge_count == 0 && opposite_winding_edge_count == 0;
  }
};

/// Checks that the mesh is usable: within the limits, finite, indices in range, three different corners, and
/// at least one triangle. Vertices that no triangle uses and triangles of no area are accepted. `where` of
/// the Error is like "mesh.triangles[12]".
Result<void> validate_mesh(const MeshDesc& mesh);

/// Checks that the mesh is the surface of a solid: a usable mesh, every edge with two triangles that run
/// along it in opposite directions, and the inside on the inner side of most. Vertices at the same position
/// are not the same vertex: weld them first. `where` of the Error is like "mesh.triangles[12]".
Result<void> validate_solid(const MeshDesc& mesh);

/// Precondition: a mesh that validate_mesh accepts (or no triangles at all).
MeshTopology compute_topology(std::size_t vertex_count, std::span<const Triangle> triangles);

/// One third of the areas of the triangles at each vertex [m^2]; 0 at a vertex without any.
std::vector<Real> compute_vertex_areas(std::span<const Vec3> positions, std::span<const Triangle> triangles);

/// Lengths of the edges [m].
std::vector<Real> compute_edge_lengths(std::span<const Vec3> positions, std::span<const Edge> edges);

/// The volume inside [m^3], negative if the triangles face inward. If the mesh is not closed, the volume
/// between it and the first corner of its first triangle. 0 without triangles.
double compute_signed_volume(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace hooke::geometry
