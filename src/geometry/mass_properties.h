#pragma once

#include "hooke/math.h"
#include "hooke/shape.h"

#include "geometry/convex_hull.h"
#include "math/symmetric.h"

#include <array>
#include <cstdint>
#include <span>

namespace hooke::geometry {

/// Volume, center and inertia of a solid of density 1.
struct MassProperties {
  double volume = 0;                      ///< [m^3]
  DVec3 center = {};                      ///< [m]
  math::Symmetric3<double> inertia = {};  ///< About the center, in the axes it was asked in [m^5].
};

/// Of a sphere, capsule, box, cylinder or cone in its own frame. A half-space has none: zero.
[[nodiscard]] MassProperties mass_of(const Shape& shape);
[[nodiscard]] MassProperties mass_of(const ConvexHull& hull);
/// Of the solid bounded by a closed surface, by signed tetrahedra (the divergence theorem); negative for a
/// surface that is inside out, meaningless for an open one.
[[nodiscard]] MassProperties mass_of(std::span<const Vec3> positions,
                                     std::span<const std::array<std::uint32_t, 3>> triangles);

/// The same solid moved: rotated about the origin, then shifted.
[[nodiscard]] MassProperties moved(const MassProperties& solid, Quat rotation, DVec3 shift);
/// Two solids as one, each with its density as a factor.
[[nodiscard]] MassProperties joined(const MassProperties& a, double density_a, const MassProperties& b,
                                    double density_b);

struct PrincipalAxes {
  Quaternion<double> rotation = {};  ///< From the principal axes to the axes of the matrix.
  DVec3 moments = {};
};
/// Eigenvectors of a symmetric matrix by cyclic Jacobi rotations (fixed number of sweeps, + - * / sqrt only).
[[nodiscard]] PrincipalAxes principal_axes(const math::Symmetric3<double>& matrix);

}  // namespace hooke::geometry
