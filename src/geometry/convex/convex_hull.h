#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::geometry {

/// A convex polyhedron: vertices, polygonal faces, edges.
struct ConvexHull {
  struct Face {
    Vec3 normal = {};       ///< Outward unit normal.
    Real offset = Real(0);  ///< dot(normal, x) = offset on the face [m].
    std::uint16_t first =
        0;  ///< The face's vertices are loop[first, first + count), counter-clockwise from outside.
    std::uint16_t count = 0;
  };
  struct Edge {
    std::uint16_t vertex_a = 0, vertex_b = 0;  ///< vertex_a < vertex_b.
    std::uint16_t face_a = 0, face_b = 0;      ///< face_a runs from vertex_a to vertex_b, face_b back.
    Vec3 direction = {};                       ///< Unit vector from vertex_a to vertex_b.
  };

  static constexpr int kMaxVertices = 256;
  static constexpr int kMaxEdges = 3 * kMaxVertices - 6;  ///< Euler's number for a hull of triangles alone.
  static constexpr int kMaxFaces = 2 * kMaxVertices - 4;
  static constexpr double kTolerance = 2e-5;     ///< In units of the extent (the longest side of the bounds).
  static constexpr double kThicknessMin = 1e-4;  ///< In units of the extent.

  std::vector<Vec3> vertices;
  std::vector<Face> faces;
  std::vector<std::uint16_t> loop;
  std::vector<Edge> edges;
  Vec3 center = {};             ///< Center of the volume.
  Real inner_radius = Real(0);  ///< Distance from the center to the nearest face [m].
  Real outer_radius = Real(0);  ///< Distance from the center to the farthest vertex [m].
};

/// The convex hull of points. Only corners are left: points within the tolerance of a face or an edge count
/// as on it, and coplanar triangles are one polygon. The vertices are some of the points, in ascending order
/// of position; the hull does not depend on the order of the points. If there are more corners than
/// `vertex_limit` (4 to kMaxVertices), those that stand out most are kept, and the hull lies inside the true
/// one (256 vertices of a sphere lose 2.5 % of its volume).
///
/// Errors: fewer than four points, one that is not finite, extents outside 1e-9 to 1e9 m, and a hull thinner
/// than kThicknessMin.
[[nodiscard]] Result<ConvexHull> make_convex_hull(std::span<const Vec3> points,
                                                  int vertex_limit = ConvexHull::kMaxVertices);

/// The hull of a box about the origin.
[[nodiscard]] ConvexHull make_box_hull(Vec3 half_extents);

/// The surface in triangles.
[[nodiscard]] MeshDesc mesh_of(const ConvexHull& hull);

/// The vertex farthest along `direction` (any length); the first of equally far ones. It scans all, at 0.8 ns
/// a vertex: climbing along edges gains nothing below 24 vertices, and a quarter at 64, unless it begins near
/// the end.
[[nodiscard]] inline std::uint16_t support(const ConvexHull& hull, Vec3 direction) {
  std::size_t best = 0;
  Real farthest = dot(direction, hull.vertices[0]);
  for (std::size_t i = 1; i < hull.vertices.size(); ++i) {
    const Real along = dot(direction, hull.vertices[i]);
    if (!(along > farthest)) continue;
    farthest = along;
    best = i;
  }
  return static_cast<std::uint16_t>(best);
}

}  // namespace hooke::geometry
