#pragma once

#include "hooke/model_io.h"

#include "render/draw_list.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hooke::app {

/// The drawn triangles of a cloth or solid. Several drawn vertices may follow one simulated point: where a
/// texture has a seam they share the normal, where the model has a crease each side keeps its own.
struct ClothSurface {
  std::shared_ptr<render::MeshGeometry> geometry;
  std::vector<std::uint32_t> point_of;  ///< For each vertex.
  std::vector<std::uint32_t> group_of;  ///< For each vertex: those with the same number share a normal.
  std::vector<Vec3> group_normals;      ///< Scratch of update_surface.
};

/// A grid of `columns` x `rows` points, point 0 being the top left corner of the texture.
ClothSurface make_grid_surface(std::uint32_t columns, std::uint32_t rows,
                               std::span<const std::array<std::uint32_t, 3>> triangles);

/// A model whose simulated vertices are the cloth's points.
ClothSurface make_model_surface(const Model& model);

/// The outer points of a solid, with an edge wherever triangles at rest meet at an angle of a right one or
/// more.
ClothSurface make_solid_surface(std::span<const Vec3> points,
                                std::span<const std::array<std::uint32_t, 3>> triangles);

/// The model as it stands in its file.
std::shared_ptr<render::MeshGeometry> geometry_of(const Model& model);

/// Moves the vertices to `points` and recomputes the normals. Points that are missing leave their vertices
/// where they are.
void update_surface(ClothSurface& surface, std::span<const Vec3> points);

}  // namespace hooke::app
