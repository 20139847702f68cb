#pragma once

#include "geometry/mesh/volume_tree.h"
#include "geometry/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Finds what is wrong with triangles that come from outside, and repairs what can be repaired: welding,
/// triangles of no height, which side is outside, triangles that cross. All functions are pure; the same
/// input gives the same output everywhere. repair_solid of hooke/geometry.h combines them.

namespace hooke::geometry {

struct Weld {
  std::vector<std::uint32_t> welded_of;  ///< For each point, its welded point.
  std::vector<std::uint32_t> first;      ///< For each welded point, the first point that made it.
};

/// Points closer than this are united: 1e-6 of the bounding box's diagonal. 0 for no points.
[[nodiscard]] double weld_distance(std::span<const DVec3> points);

/// Unites each point with the earliest welded point within `distance` per axis, or makes it a new one.
[[nodiscard]] Weld weld(std::span<const DVec3> points, double distance);

/// Whether two corners coincide or the height over the longest side is at most `distance`: such a triangle
/// has no direction.
[[nodiscard]] bool is_degenerate(std::span<const DVec3> points, const Triangle& triangle, double distance);

/// A flag for each triangle that must be turned over to face outward. A surface without border is made
/// consistent and gets a positive volume. One inside another such surface is turned with the outermost around
/// it, so that a cavity stays a cavity. A surface with a border is made consistent with the majority of its
/// triangles.
[[nodiscard]] std::vector<std::uint8_t> find_flipped(std::span<const DVec3> points,
                                                     std::span<const Triangle> triangles);

/// Whether two triangles of a mesh have more in common than the corners they share: they cross, or lie on
/// each other. Exact.
[[nodiscard]] bool triangles_cross(const MeshView& mesh, std::uint32_t a, std::uint32_t b);

/// Replaces `found` by all pairs of triangles that cross, the smaller index first, in ascending order.
void find_crossings(const MeshView& mesh, std::vector<TrianglePair>& found);

}  // namespace hooke::geometry
