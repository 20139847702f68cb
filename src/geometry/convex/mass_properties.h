#pragma once

#include "hooke/math.h"
#include "hooke/shape.h"

#include "geometry/convex/convex_hull.h"
#include "math/symmetric.h"

#include <array>
#include <cstdint>
#include <span>

namespace hooke::geometry {

/// Volume, center and inertia of a solid of density 1. For joined solids: mass, center and inertia.
struct MassProperties {
  double volume = 0;  ///< Volume [m^3], or mass [kg].
  DVec3 center = {};  ///< [m]
  math::Symmetric3<double> inertia =
      {};  ///< Inertia about the center, in the requested axes [m^5], or [kg m^2].
};

/// For a sphere, capsule, box, cylinder or cone in its own frame. A half-space, a mesh and a hull have none:
/// the result is zero.
[[nodiscard]] MassProperties mass_of(const Shape& shape);
[[nodiscard]] MassProperties mass_of(const ConvexHull& hull);
/// For the solid bounded by a closed surface, by signed tetrahedra (the divergence theorem). The result is
/// negative for a surface that is inside out, meaningless for an open one, and zero without volume.
[[nodiscard]] MassProperties mass_of(std::span<const Vec3> positions,
                                     std::span<const std::array<std::uint32_t, 3>> triangles);

/// Whether matter can have these moments: they are positive, and none is above the sum of the others. A
/// surface that crosses itself counts space twice, or negative, and may bound nothing of the kind.
[[nodiscard]] bool is_physical(const MassProperties& solid);

/// The same solid moved: rotated about the origin, then shifted [m].
[[nodiscard]] MassProperties moved(const MassProperties& solid, Quat rotation, DVec3 shift);
/// Two solids as one, each with its density as a factor (parallel axes). Zero if they have no mass.
[[nodiscard]] MassProperties joined(const MassProperties& a, double density_a, const MassProperties& b,
                                    double density_b);

/// The mean of the vertices, the paper's center of mass (4.3.1). It lies where the vertices are dense, not
/// where the mass is. Zero without vertices.
[[nodiscard]] DVec3 vertex_average(std::span<const Vec3> positions);

struct PrincipalAxes {
  Quaternion<double> rotation = {};  ///< Rotation from the principal axes to the axes of the matrix; unit, w
                                     ///< >= 0.
  DVec3 moments = {};                ///< Moments about the three axes.
};
/// Eigenvectors of a symmetric matrix by cyclic Jacobi rotations (fixed number of sweeps, + - * / sqrt only).
/// The axes stay as near to those of the matrix as the method leaves them: a diagonal or isotropic matrix (to
/// 1e-13 of its trace) gives exactly the identity, so that an upright box stays upright to the bit.
[[nodiscard]] PrincipalAxes principal_axes(const math::Symmetric3<double>& matrix);

}  // namespace hooke::geometry
