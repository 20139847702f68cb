#pragma once

#include "hooke/result.h"
#include "hooke/shape.h"

#include "geometry/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Solids of tetrahedra: made from cubic cells, and by means of these from any closed surface.

namespace hooke::geometry {

/// Corners of a tetrahedron; 1, 2, 3 are clockwise seen from 0, so that the volume is positive.
using Tetrahedron = std::array<std::uint32_t, 4>;

struct TetrahedralMesh {
  std::vector<DVec3> points = {};  ///< [m]
  std::vector<Tetrahedron> tetrahedra = {};
};

/// Six times the volume [m^3] of the tetrahedron, negative if it is inside out.
[[nodiscard]] inline double volume6(const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
  return dot(b - a, cross(c - a, d - a));
}

/// Cells of a grid of counts[0] x counts[1] x counts[2] boxes of size `cell` [m], x fastest.
struct CellGrid {
  std::array<int, 3> counts = {1, 1, 1};
  DVec3 corner = {};  ///< The least corner of the first cell [m].
  DVec3 cell = {1, 1, 1};
  std::vector<std::uint8_t> filled = {};  ///< One per cell; 0: empty.

  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * counts[1] + y) * counts[0] + x;
  }
};

/// Makes the body-centered lattice over the filled cells: their corners and their centers. There are four
/// tetrahedra between the centers of two neighbors, and two on a face without a neighbor, whose diagonal
/// alternates like a checkerboard. So there are 12 equal tetrahedra a cell inside, and no direction is
/// preferred. Points: used corners in the grid's order, then centers.
[[nodiscard]] TetrahedralMesh fill_cells(const CellGrid& grid);

/// The faces that only one tetrahedron has, counter-clockwise seen from outside, in order of tetrahedra.
[[nodiscard]] std::vector<Triangle> surface_of(std::span<const Tetrahedron> tetrahedra);

/// What was added to the cells of which half lies inside a mesh, so that the solid holds together.
struct CellAdditions {
  std::uint32_t thin = 0;     ///< Number of cells that thin parts pass through, away from all others.
  std::uint32_t pieces = 0;   ///< Number of pieces before they were joined.
  std::uint32_t bridges = 0;  ///< Number of cells between pieces.
};

/// Fills a closed surface with tetrahedra of cells of about `cell` [m]. Cells of which half is inside are
/// kept (fill_cells), and the outer points are moved onto the surface as far as no tetrahedron loses more
/// than nine tenths of its volume. Parts thinner than a cell are lost. The result for a mesh is the same on
/// every machine.
///
/// Errors (`where` is like "mesh.triangles[12]" or "cell"): a mesh that validate_solid refuses, a cell that
/// is not positive, more than 2^22 cells in the mesh's box.
[[nodiscard]] Result<TetrahedralMesh> fill_solid(const MeshDesc& mesh, double cell);

/// Says what fill_solid adds to the cells inside, at the cost of its cells alone. Errors: as fill_solid.
[[nodiscard]] Result<CellAdditions> measure_additions(const MeshDesc& mesh, double cell);

/// A position inside a tetrahedron, or outside by continuation.
struct TetrahedronPlace {
  std::uint32_t tetrahedron = 0;
  std::array<double, 4> weights = {};  ///< Weights of the corners, with the sum 1.
};

/// Finds for each position the tetrahedron that contains it or comes nearest to that: the one whose least
/// weight is largest, and of equals the first. Needs at least one tetrahedron with a volume.
[[nodiscard]] std::vector<TetrahedronPlace> locate(const TetrahedralMesh& mesh,
                                                   std::span<const DVec3> places);

}  // namespace hooke::geometry
