#pragma once

#include "hooke/math.h"

namespace hooke::elements {

/// A damped Hooke spring with stiffness k, damping c and rest length L.
struct Spring {
  double stiffness = 0;    ///< k [N/m]
  double damping = 0;      ///< c [N s/m]
  double rest_length = 0;  ///< L [m]
  bool isotropic = false;  ///< The damper acts on the whole relative velocity, as in the paper.
};

/// Force on the first point [N]; the second gets the opposite. With d = x_a - x_b, dv = v_a - v_b, n = d /
/// |d|:
///
///     F = -[k (|d| - L) + c dv.n] n          isotropic:  F = -k (|d| - L) n - c dv
///
/// These are eq. 1 to 3 of the paper, with a direction. At zero length there is no direction, and no force.
template <class T>
Vector3<T> spring_force(const Spring& spring, Vector3<T> d, Vector3<T> dv) {
  const T l = length(d);
  if (!(l > T(0))) return {};
  const Vector3<T> n = (T(1) / l) * d;
  const Vector3<T> elastic = (-spring.stiffness * (l - spring.rest_length)) * n;
  return spring.isotropic ? elastic - spring.damping * dv : elastic - (spring.damping * dot(dv, n)) * n;
}

}  // namespace hooke::elements
