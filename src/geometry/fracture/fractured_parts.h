#pragma once

#include "hooke/math.h"

#include "geometry/fracture/voronoi.h"
#include "geometry/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// The connected parts of which the cells of a solid consist that is not convex, and the faces between them.

namespace hooke::geometry {

/// A connected part of a cell.
struct FracturedPart {
  std::vector<DVec3> points = {};
  std::vector<Triangle> triangles = {};
  std::vector<std::uint32_t> across = {};  ///< FractureCell::across.
  std::uint32_t seed = 0;                  ///< The seed of its cell.
};

/// Where two parts meet.
struct PartFace {
  std::uint32_t a = 0, b = 0;            ///< The parts; a < b.
  std::vector<Triangle> triangles = {};  ///< Of a, among its points.
};

struct FracturedParts {
  std::vector<FracturedPart> parts = {};  ///< Ordered by seed.
  std::vector<PartFace> faces = {};       ///< Ordered by (a, b).
};

/// Finds the parts of all cells. Lengths are judged in diagonals [m] of the box around the solid.
[[nodiscard]] FracturedParts find_parts(const VoronoiCells& cells, std::span<const DVec3> seeds,
                                        double diagonal);

/// Center of the volume that the triangles enclose.
[[nodiscard]] DVec3 center_of(std::span<const DVec3> points, std::span<const Triangle> triangles);

}  // namespace hooke::geometry
