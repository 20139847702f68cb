#pragma once

#include "hooke/math.h"

#include "geometry/triangle_mesh.h"

#include <span>
#include <vector>

namespace hooke::geometry {

/// What a flat face is to those who bend it.
struct FaceSection {
  double area = 0;     ///< [m^2]
  DVec3 center = {};   ///< Center of the area [m].
  DVec3 normal = {};   ///< Unit normal.
  double modulus = 0;  ///< FractureBond::section_modulus [m^3].
};

/// Measures a face made of triangles that lie in one plane.
[[nodiscard]] FaceSection measure_section(std::span<const DVec3> points, std::span<const Triangle> triangles);

}  // namespace hooke::geometry
