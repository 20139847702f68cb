#pragma once

#include "hooke/bsp.h"
#include "hooke/fracture.h"
#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <vector>

namespace hooke::geometry {

/// A solid that is to be divided.
struct FractureSolid {
  const MeshDesc& mesh;
  DVec3 origin = {};        ///< Middle of the box around it; all below is about it [m].
  DVec3 half_extents = {};  ///< Of that box [m].
  double diagonal = 0;      ///< Of that box [m].
  double volume = 0;        ///< [m^3]
  bool is_convex = false;
  BspTree tree = {};  ///< Its tree, in the mesh's frame; only if it is not convex.
};

/// Checks the mesh and measures it. Errors: those of validate_solid and build_bsp, no volume.
[[nodiscard]] Result<FractureSolid> make_fracture_solid(const MeshDesc& mesh);

/// Whether a closed surface is that of one convex body, within 1e-6 of its extent.
[[nodiscard]] bool is_convex_solid(const MeshDesc& mesh);

/// The seeds that the description gives or asks for, about the solid's origin. Errors: an impact so far away
/// that too few places that are drawn to it lie in the solid.
[[nodiscard]] Result<std::vector<DVec3>> place_seeds(const FractureSolid& solid, const FractureDesc& desc);

}  // namespace hooke::geometry
