#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// Solids divided into pieces, the Voronoi cells of seeds inside them, along which they are to break. Nothing
/// here needs a World.

namespace hooke {

/// How a solid is divided. All places are in the frame of its mesh.
struct FractureDesc {
  int cells = 16;          ///< Number of seeds that are spread at random. [1, 4096]
  std::uint32_t seed = 1;  ///< Seed of the random numbers; any value.
  /// Places of the seeds [m], in place of `cells` random ones: 1 to 4096. They may lie outside the solid;
  /// what cell is empty then counts as merged.
  std::vector<DVec3> seeds = {};
  /// A place in or on the solid, about which the random seeds crowd [m]: cells are small there, and grow in
  /// proportion to the distance from it.
  std::optional<DVec3> impact = {};
  /// Distance from `impact` within which cells grow no smaller, as a share of the diagonal of the box around
  /// the solid. [0.001, 1]
  double impact_radius = 0.02;
  /// Cells of less than this share of the mean volume (that of the solid over the number of seeds) give their
  /// volume to their neighbors. [0, 0.5]
  double least_share = 0.05;
};

/// A piece of a solid.
struct FractureCell {
  /// Marks a triangle that is part of the surface of the whole solid.
  static constexpr std::uint32_t kSurface = 0xFFFFFFFF;

  MeshDesc mesh = {};  ///< Closed surface of the piece, about `center`.
  DVec3 center = {};   ///< Center of its volume in the frame of the whole [m].
  double volume = 0;   ///< Its volume, found before corners were rounded for `mesh` [m^3].
  /// For each triangle of `mesh` the cell on its other side, or kSurface: what is not kSurface is an inner
  /// face, which is seen only when the solid breaks.
  std::vector<std::uint32_t> across = {};
  std::uint32_t seed = 0;  ///< Index of the seed that the cell belongs to.
  bool is_convex = true;   ///< Whether the piece is convex, as all pieces of a convex solid are.
};

/// The face that two cells share.
struct FractureBond {
  std::uint32_t a = 0;  ///< The one cell; `a` is less than `b`.
  std::uint32_t b = 0;  ///< The other cell.
  double area = 0;      ///< Area of the face [m^2].
  DVec3 center = {};    ///< Center of the area, in the frame of the whole [m].
  DVec3 normal = {};    ///< Unit normal of the face, from `a` to `b`.
  /// Section modulus of the face [m^3]: I / c, the second moment of area about an axis through the center
  /// over the distance of the farthest corner from it; of the two principal axes the smaller value. A
  /// rectangle has b h^2 / 6, with h the shorter side.
  double section_modulus = 0;
};

/// A solid divided into cells.
struct Fracture {
  std::vector<FractureCell> cells = {};  ///< The cells, ordered by their seeds.
  std::vector<FractureBond> bonds = {};  ///< The faces between them, ordered by (a, b).
  std::uint32_t merged =
      0;  ///< Number of seeds whose cell was empty or too small, and went to its neighbors.
  /// Number of pieces below FractureDesc::least_share that are left: parts of a cell that a concave surface
  /// cuts off.
  std::uint32_t small_pieces = 0;
};

/// Divides a solid into the Voronoi cells of seeds: each cell has the points that are nearer to its seed than
/// to any other. The same mesh and description give the same bits on every machine.
///
/// - A convex solid is cut by planes in double: the cells are convex, share their faces, and their volumes
///   sum to that of the solid to 1e-12 of it.
/// - Of any other solid each cell is the exact intersection with the solid (combine_solids), and what that
///   leaves in several pieces are several cells. Volumes sum to 1e-10. The time grows with the number of
///   seeds times that of the triangles.
/// - A cell that is too small (FractureDesc::least_share) loses its seed, and everything is divided anew.
///
/// 1000 cells of a box take 0.1 s.
///
/// Errors: a mesh that is open, inside out or crosses itself, or that has no volume (repair_solid and
/// remesh_solid help); a number out of range or not finite; an `impact` so far from the solid that no seed
/// falls into it.
[[nodiscard]] Result<Fracture> fracture(const MeshDesc& mesh, const FractureDesc& desc);

}  // namespace hooke
