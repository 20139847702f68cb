#pragma once

#include "hooke/math.h"
#include "hooke/shape.h"

#include "geometry/convex/convex_hull.h"
#include "math/symmetric.h"

#include <array>
#include <cstdint>
#include <span>

namespace hooke::geometry {

/// Volume, center and inertia of a solid of density 1. Of joined solids: mass, center and inertia.
struct MassProperties {
  double volume = 0;  ///< [m^3], or [kg]
  DVec3 center = {};  ///< [m]
  math::Symmetric3<double> inertia =
      {};  ///< About the center, in the axes it was asked in [m^5], or [kg m^2].
};

/// Of a sphere, capsule, box, cylinder or cone in its own frame. A half-space, a mesh and a hull have none:
/// zero.
[[nodiscard]] MassProperties mass_of(const Shape& shape);
[[nodiscard]] MassProperties mass_of(const ConvexHull& hull);
/// Of the solid bounded by a closed surface, by signed tetrahedra (the divergence theorem); negative for a
/// surface that is inside out, meaningless for an open one. Without volume: zero.
[[nodiscard]] MassProperties mass_of(std::span<const Vec3> positions,
                                     std::span<const std::array<std::uint32_t, 3>> triangles);

/// Whether matter can be so: the moments are positive, none above the sum of the others. A surface that
/// crosses itself counts space twice, or negative, and may bound nothing of the kind.
[[nodiscard]] bool is_physical(const MassProperties& solid);

/// The same solid moved: rotated about the origin, then shifted [m].
[[nodiscard]] MassProperties moved(const MassProperties& solid, Quat rotation, DVec3 shift);
/// Two solids as one, each with its density as a factor (parallel axes). Without mass: zero.
[[nodiscard]] MassProperties joined(const MassProperties& a, double density_a, const MassProperties& b,
                                    double density_b);

/// The mean of the vertices, the paper's center of mass (4.3.1): it goes where the vertices are dense, not
/// where the mass is. Zero without any.
[[nodiscard]] DVec3 vertex_average(std::span<const Vec3> positions);

struct PrincipalAxes {
  Quaternion<double> rotation = {};  ///< From the principal axes to the axes of the matrix; unit, w >= 0.
  DVec3 moments = {};                ///< About the three axes.
};
/// Eigenvectors of a symmetric matrix by cyclic Jacobi rotations (fixed number of sweeps, + - * / sqrt only).
/// The axes stay as near to those of the matrix as the method leaves them: a diagonal or isotropic matrix (to
/// 1e-13 of its trace) gives exactly the identity, so that an upright box stays upright to the bit.
[[nodiscard]] PrincipalAxes principal_axes(const math::Symmetric3<double>& matrix);

}  // namespace hooke::geometry
