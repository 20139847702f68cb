#pragma once

#include "hooke/math.h"

#include <array>

namespace hooke::elements {

/// Moduli of the material below [Pa].
template <class T>
struct NeoHookean {
  T shear = T(0);   ///< mu = E / (2 (1 + nu))
  T volume = T(0);  ///< lambda = mu / (1 - 2 nu): Lamé's first number plus mu, see below.
};

/// From Young's modulus E [Pa] > 0 and Poisson's ratio -1 < nu < 1/2.
///
/// At small strain the stress of the energy below is 2 mu e + (lambda - mu) tr(e) 1. So lambda of Hooke's law
/// is lambda - mu here, and lambda = E nu / ((1 + nu) (1 - 2 nu)) + mu = mu / (1 - 2 nu).
template <class T>
constexpr NeoHookean<T> neo_hookean(T young_modulus, T poisson_ratio) {
  const T shear = young_modulus / (T(2) * (T(1) + poisson_ratio));
  return {shear, shear / (T(1) - T(2) * poisson_ratio)};
}

/// Gradients of the four shape functions of a tetrahedron at rest [1/m], with b[0] = -(b[1] + b[2] + b[3]),
/// and its volume [m^3]. The volume is negative if x1, x2, x3 run counter-clockwise seen from x0. If it is
/// zero, so is all else.
template <class T>
struct TetrahedronRest {
  std::array<Vector3<T>, 4> b = {};
  T volume = T(0);
};

template <class T>
TetrahedronRest<T> tetrahedron_rest(const std::array<Vector3<T>, 4>& x) {
  const Matrix3<T> edges = {x[1] - x[0], x[2] - x[0], x[3] - x[0]};
  const Matrix3<T> rows = transpose(inverse(edges));
  return {{-(rows.x + rows.y + rows.z), rows.x, rows.y, rows.z}, determinant(edges) / T(6)};
}

/// Returns sum x_i b_i^T: the deformation gradient F if x are positions, its rate if they are velocities.
template <class T>
Matrix3<T> gradient_of(const std::array<Vector3<T>, 4>& x, const std::array<Vector3<T>, 4>& b) {
  // Differences are used, because a common part of the four would cost digits.
  const Vector3<T> d1 = x[1] - x[0], d2 = x[2] - x[0], d3 = x[3] - x[0];
  const auto column = [&](T b1, T b2, T b3) { return b1 * d1 + b2 * d2 + b3 * d3; };
  return {column(b[1].x, b[2].x, b[3].x), column(b[1].y, b[2].y, b[3].y), column(b[1].z, b[2].z, b[3].z)};
}

/// Gradient of det F by F: [f2 x f3, f3 x f1, f1 x f2].
template <class T>
constexpr Matrix3<T> cofactors(const Matrix3<T>& f) {
  return {cross(f.y, f.z), cross(f.z, f.x), cross(f.x, f.y)};
}

/// A : B, the sum of the products of all elements.
template <class T>
constexpr T contract(const Matrix3<T>& a, const Matrix3<T>& b) {
  return dot(a.x, b.x) + dot(a.y, b.y) + dot(a.z, b.z);
}

/// Energy per volume at rest [J/m^3] of Smith, de Goes and Kim 2018, "Stable neo-Hookean flesh simulation",
/// in the form of Macklin and Müller 2021, "A constraint-based formulation of stable neo-Hookean materials":
///
///     psi = mu / 2 tr(F^T F) + lambda / 2 (det F - 1 - mu / lambda)^2,  less its value at F = 1
///
/// The energy is finite for every F, also for inverted ones, and least at rotations.
template <class T>
T energy_density(const Matrix3<T>& f, const NeoHookean<T>& material) {
  const T shift = material.shear / material.volume;
  const T c = determinant(f) - T(1) - shift;
  return T(0.5) * (material.shear * (contract(f, f) - T(3)) + material.volume * (c * c - shift * shift));
}

/// Gradient of that energy by F, the first Piola-Kirchhoff stress [Pa]: mu F + (lambda (det F - 1) - mu) cof
/// F.
template <class T>
Matrix3<T> stress(const Matrix3<T>& f, const NeoHookean<T>& material) {
  const T pressure = material.volume * (determinant(f) - T(1)) - material.shear;
  return material.shear * f + pressure * cofactors(f);
}

}  // namespace hooke::elements
