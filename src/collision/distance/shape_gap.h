#pragma once

#include "hooke/shape.h"

#include "state/colliders.h"
#include "state/mesh.h"

#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// The distance of a point from a shape, in the shape's frame.

namespace hooke::collision {

/// Signed distance to a shape, negative inside, and the outward unit normal.
struct Gap {
  Real distance = Real(0);
  Vec3 normal = {};
};

/// For shapes that their sizes describe: all but hulls and meshes. Degenerate cases are as in
/// geometry/closest.h.
[[nodiscard]] Gap gap_to_shape(const Shape& shape, Vec3 x);
/// For those shapes and for hulls.
[[nodiscard]] Gap gap_to_shape(const state::ColliderShape& shape, Vec3 x);

/// The gap to one triangle of a mesh that is solid behind its fronts. Over the face the distance is signed.
/// Beside the face the nearest point is on the rim, and the distance is positive in front of the triangle's
/// plane.
struct TriangleGap {
  Gap gap;
  bool over_face = false;
  Real unsigned_distance = Real(0);
};

[[nodiscard]] TriangleGap gap_to_triangle(const state::Mesh& mesh, std::uint32_t triangle, Vec3 x);

/// Whether a mesh with MeshTree::kPlanes holds the point; nothing for other meshes, which cannot tell.
[[nodiscard]] std::optional<bool> is_inside(const state::Mesh& mesh, Vec3 x);

/// The gap of a point for which is_inside has given the side. Beside the face its sign comes from that side
/// and not from the triangle's plane.
[[nodiscard]] Gap gap_on_side(const TriangleGap& gap, std::optional<bool> is_inside);

/// Finds the triangles within `reach` of a point, in ascending order. For a point inside a mesh with
/// MeshTree::kPlanes the nearest one is included.
void find_triangles_near(const state::Mesh& mesh, Vec3 x, Real reach, std::vector<std::uint32_t>& found);

/// Signed distance to the nearest triangle, or `reach` if none is that near. With MeshTree::kPlanes it may
/// also be deeper inside than `reach`.
[[nodiscard]] Real distance_to_mesh(const state::Mesh& mesh, Vec3 x, Real reach);

}  // namespace hooke::collision
