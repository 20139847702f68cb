#pragma once

#include "hooke/math.h"
#include "hooke/result.h"

#include "geometry/bsp/bsp_solid.h"
#include "geometry/fracture/convex_cell.h"
#include "geometry/fracture/fracture_seeds.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::geometry {

/// What of a solid is nearer to one seed than to any other.
struct VoronoiCell {
  /// The cell, about the solid's origin; of a solid that is not convex before it is cut to the solid. Cuts
  /// are numbered by the seed on their other side.
  ConvexCell polyhedron = {};
  SolidMesh solid = {};  ///< The cell cut to a solid that is not convex, about its origin.
  double volume = 0;     ///< Of what is inside the solid [m^3].
  std::vector<std::uint32_t> neighbors =
      {};  ///< Seeds that have a face in common with the polyhedron, ascending.
};

/// The plane halfway between two seeds; its normal points from `from` to `to`. It has the same bits, but for
/// the sign, the other way around if the seeds are numbered.
[[nodiscard]] Plane bisector_of(std::span<const DVec3> seeds, std::uint32_t from, std::uint32_t to);

/// Cells of a solid; those of seeds that were given up have no volume.
struct VoronoiCells {
  std::vector<VoronoiCell> cells = {};  ///< One for each seed.
  std::uint32_t merged = 0;             ///< Number of seeds that were given up.
};

/// Divides a solid among the seeds, which are about its origin. Seeds at one place, those of empty cells, and
/// of cells with less than `least` [m^3], are given up, the smallest first. Errors: what combine_solids says
/// of a cell of a solid that is not convex.
[[nodiscard]] Result<VoronoiCells> divide(const FractureSolid& solid, std::span<const DVec3> seeds,
                                          double least);

/// Six times the signed volume that the triangles enclose.
[[nodiscard]] double six_volumes(std::span<const DVec3> points, std::span<const Triangle> triangles);

/// All faces of a polyhedron in triangles.
[[nodiscard]] std::vector<Triangle> triangles_of(const ConvexCell& cell);

}  // namespace hooke::geometry
