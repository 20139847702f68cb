#pragma once

#include "hooke/result.h"
#include "hooke/shape.h"

#include "geometry/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Solids of tetrahedra: from cubic cells, and from these for any closed surface.

namespace hooke::geometry {

/// Corners; 1, 2, 3 counter-clockwise seen from 0, so that the volume is positive.
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

/// The body-centered lattice over the filled cells: their corners and their centers. Four tetrahedra between
/// the centers of two neighbors, two on a face without a neighbor, whose diagonal alternates like a
/// checkerboard: 12 equal tetrahedra a cell inside, no direction preferred. Points: used corners in the
/// grid's order, then centers.
[[nodiscard]] TetrahedralMesh fill_cells(const CellGrid& grid);

/// The faces that only one tetrahedron has, counter-clockwise seen from outside, in order of tetrahedra.
[[nodiscard]] std::vector<Triangle> surface_of(std::span<const Tetrahedron> tetrahedra);

/// The solid inside a closed surface, in tetrahedra of cells of about `cell` [m]: cells of which half is
/// inside are kept (fill_cells), and the outer points moved onto the surface as far as no tetrahedron loses
/// more than nine tenths of its volume. What is thinner than a cell is lost. The same for the same mesh on
/// every machine.
///
/// Errors (`where` is like "mesh.triangles[12]" or "cell"): a mesh that validate_solid refuses, a cell that
/// is not positive, more than 2^22 cells in the mesh's box, no cell inside.
[[nodiscard]] Result<TetrahedralMesh> fill_solid(const MeshDesc& mesh, double cell);

/// A place inside a tetrahedron, or outside by continuation.
struct TetrahedronPlace {
  std::uint32_t tetrahedron = 0;
  std::array<double, 4> weights = {};  ///< Of the corners, with the sum 1.
};

/// For each place the tetrahedron that holds it or is nearest to doing so: whose least weight is largest, and
/// of equals the first. At least one tetrahedron with a volume.
[[nodiscard]] std::vector<TetrahedronPlace> locate(const TetrahedralMesh& mesh,
                                                   std::span<const DVec3> places);

}  // namespace hooke::geometry
