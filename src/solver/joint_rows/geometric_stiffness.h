#pragma once

#include "math/symmetric.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/joint_rows/joint_rows_tuning.h"

/// \file
/// A force on a body at a lever turns the body back as it rotates. That is a spring, which light bodies
/// under load must carry implicitly. Equations: solver/joint/articulations.h.

namespace hooke::solver {

inline double trace(const math::Symmetric3<double>& m) {
  return m.xx + m.yy + m.zz;
}

inline math::Symmetric3<double> scaled(double s, const math::Symmetric3<double>& m) {
  return {s * m.xx, s * m.xy, s * m.xz, s * m.yy, s * m.yz, s * m.zz};
}

/// Stiffness of force `force` on `body` at lever r, in scaled coordinates times h^2.
inline math::Symmetric3<double> stiffness_of(DVec3 r, DVec3 force, const JointBody& body, double h) {
  const DVec3 s = normalize(r) + normalize(force);
  const double size = 0.25 * h * h * length(r) * length(force);
  const double square = length_squared(s);
  const math::Symmetric3<double> k = {size * (square - s.x * s.x), -size * s.x * s.y,  //
                                      -size * s.x * s.z,           size * (square - s.y * s.y),
                                      -size * s.y * s.z,           size * (square - s.z * s.z)};
  return math::symmetric_product(body.scale, k, body.scale);
}

/// The part of the stiffness that is not left explicit.
inline math::Symmetric3<double> excess_of(const math::Symmetric3<double>& stiffness) {
  const double size = trace(stiffness);
  return size > kStiffnessLeft ? scaled(1 - kStiffnessLeft / size, stiffness) : math::Symmetric3<double>{};
}

}  // namespace hooke::solver
