#pragma once

#include "hooke/model_io.h"

#include "render/draw_list.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hooke::app {

/// A ClothSurface is the drawn triangles of a cloth or solid. Several drawn vertices may follow one simulated
/// point. Where a texture has a seam they share the normal; where the model has a crease each side keeps its
/// own.
struct ClothSurface {
  std::shared_ptr<render::MeshGeometry> geometry;
  std::vector<std::uint32_t> point_of;  ///< Simulated point of each vertex.
  std::vector<std::uint32_t> group_of;  ///< Group of each vertex; vertices of one group share a normal.
  std::vector<Vec3> group_normals;      ///< Scratch memory of update_surface.
};

/// Makes a grid of `columns` x `rows` points; point 0 is the top left corner of the texture.
ClothSurface make_grid_surface(std::uint32_t columns, std::uint32_t rows,
                               std::span<const std::array<std::uint32_t, 3>> triangles);

/// Parts the surface of a cloth or a solid where it has torn. `triangles` are those of the object, in the
/// order in which the surface was made from them, and `splits` is World::splits. New vertices have the
/// texture coordinates of those that they split from. More triangles than the surface has are faces of a
/// solid that have come open; they are appended.
void tear_surface(std::span<const std::array<std::uint32_t, 3>> triangles,
                  std::span<const std::uint32_t> splits, ClothSurface& surface);

/// The triangles as they were before the cloth tore; it was made with `points` points.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> untorn(
    std::vector<std::array<std::uint32_t, 3>> triangles, std::span<const std::uint32_t> splits,
    std::size_t points);

/// Makes the surface of a model whose simulated vertices are the cloth's points.
ClothSurface make_model_surface(const Model& model);

/// Makes the surface of a solid from its outer points, with an edge wherever triangles at rest meet at a
/// right angle or more.
ClothSurface make_solid_surface(std::span<const Vec3> points,
                                std::span<const std::array<std::uint32_t, 3>> triangles);

/// Returns the model as it stands in its file.
std::shared_ptr<render::MeshGeometry> geometry_of(const Model& model);

/// Moves the vertices to `points` and recomputes the normals. Vertices whose points are missing stay where
/// they are.
void update_surface(ClothSurface& surface, std::span<const Vec3> points);

}  // namespace hooke::app
