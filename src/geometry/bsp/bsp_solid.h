#pragma once

#include "hooke/geometry.h"
#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include "geometry/bsp/bsp_build.h"
#include "geometry/bsp/bsp_space.h"
#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <span>
#include <vector>

/// \file
/// Solids given by their surfaces: what a mesh must be to have an inside, and solids joined by their trees.

namespace hooke::geometry {

/// A surface in double: a corner where planes meet is known more exactly than float can hold.
struct SolidMesh {
  std::vector<DVec3> positions = {};  ///< [m]
  std::vector<Triangle> triangles = {};
};

[[nodiscard]] SolidMesh solid_mesh_of(const MeshDesc& mesh);

/// The grid that meshes are moved to. Its step is a power of two, and the longest side of the box around them
/// has 2^32 to 2^33 steps. So a corner moves by less than 2^-32 of that side (0.2 nm on 1 m); coordinates in
/// float mostly do not move at all.
struct Lattice {
  DVec3 origin = {};
  double step = 1;  ///< [m]
  [[nodiscard]] DVec3 place_of(DVec3 in_steps) const { return origin + step * in_steps; }
  /// The point of the lattice nearest to a position within its box.
  [[nodiscard]] LatticePoint point_of(DVec3 place) const;
};

/// The lattice of one or of two meshes. Errors: a coordinate is not finite or beyond 1e9 m, a box that is
/// less than 1e-9 m wide.
Result<Lattice> make_lattice(std::span<const SolidMesh* const> meshes);

/// The triangles as pieces, moved to the lattice, which is that of this mesh. Changes that leave the solid
/// the same are made silently: triangles without area are removed, and so are as many of a triangle as of its
/// back; a mesh that is inside out is turned over. A mesh that needs more is for repair_solid of
/// hooke/geometry.h, which reports what it does. Errors name the triangles: a mesh without triangles, indices
/// out of range, a surface that is not closed (a T-junction is), triangles that face opposite sides, a shell
/// wound the same way as one around it.
Result<std::vector<BspPiece>> make_solid_pieces(BspSpace& space, const Lattice& lattice,
                                                const SolidMesh& mesh);

/// The tree of a solid. In addition to the errors of build_pieces: every triangle must have only solid on its
/// inner side and none on its outer. Where it does not, the surface passes through itself or lies on itself.
Result<BspPieces> build_solid_tree(BspSpace& space, const std::vector<BspPiece>& pieces);

/// Combines two solids: what is in `a` or in `b`, in both, or in `a` and not in `b`. The triangles of each
/// are sorted down the tree of the other (Thibault and Naylor 1987, Set operations on polyhedra using binary
/// space partitioning trees). The mesh is closed, each of its edges has two triangles, and the triangles at a
/// vertex form one fan; where solids touch, vertices are doubled. The result is exact except for the rounding
/// of the corners to double; it has no triangles if nothing is left. Errors as above, with "a." or "b."
/// before "mesh".
Result<SolidMesh> combine_solids(const SolidMesh& a, const SolidMesh& b, SolidOperation operation);

}  // namespace hooke::geometry
