#pragma once

#include "hooke/bsp.h"

#include "geometry/bsp/bsp_solid.h"

/// \file
/// Makes the tree of hooke/bsp.h from a surface in double. geometry/bsp/bsp_build.h says how planes are
/// chosen.

namespace hooke::geometry {

/// Builds the tree of the solid that the mesh bounds. The mesh may be inside out, have double or flat
/// triangles and T-junctions; cavities and several shells are fine. Errors name the triangles of a mesh that
/// is open, faces opposite sides, passes through itself or lies on itself, or say what limit is exceeded. The
/// tree is the same on every machine.
Result<BspTree> build_bsp(const SolidMesh& mesh);

/// Builds the tree of any triangles, which may be open or pass through each other. It is for
/// order_back_to_front alone: its leaves have no meaning. Triangles without area are left out. Precondition:
/// indices in range. Errors: those of make_lattice and build_pieces.
Result<BspTree> build_painters_bsp(const SolidMesh& mesh);

}  // namespace hooke::geometry
