#pragma once

#include "hooke/bsp.h"

#include "geometry/bsp/bsp_solid.h"

/// \file
/// The tree of hooke/bsp.h from a surface in double. See bsp_build.h for how planes are chosen.

namespace hooke::geometry {

/// The tree of the solid that the mesh bounds. The mesh may be inside out, have double or flat triangles and
/// T-junctions; cavities and several shells are fine.
/// Errors name the triangles of a mesh that is open, faces opposite sides, goes through itself or lies on
/// itself, or say what limit is exceeded. The same tree on every machine.
Result<BspTree> build_bsp(const SolidMesh& mesh);

/// The tree of any triangles, open or through each other, for order_back_to_front alone: its leaves say
/// nothing. Those without area are left out. Precondition: indices in range. Errors: those of make_lattice
/// and build_pieces.
Result<BspTree> build_painters_bsp(const SolidMesh& mesh);

}  // namespace hooke::geometry
