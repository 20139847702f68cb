#pragma once

#include "hooke/math.h"

#include <array>

namespace hooke::elements {

/// Weights K of the curvature vector q = sum K_i x_i of two triangles, from their shape at rest. They share
/// the edge from x0 to x1 and have the wings x2 and x3. The weights have the sum zero. q is zero if the
/// triangles are flat. After a fold by an angle theta about an edge of length l, |q| is 2 l sin(theta / 2).
///
///     K_0 = cot_03 + cot_04,  K_1 = cot_01 + cot_02,  K_2 = -(cot_01 + cot_03),  K_3 = -(cot_02 + cot_04)
///
/// cot_01 and cot_03 belong to the angles at x0 and x1 in the triangle of x2, cot_02 and cot_04 to those in
/// the triangle of x3. This is a quadratic model of bending for surfaces that keep their lengths (Bergou,
/// Wardetzky, Harmon, Zorin and Grinspun 2006). All weights are zero if a triangle or the edge has no extent.
template <class T>
std::array<T, 4> isometric_bend(Vector3<T> x0, Vector3<T> x1, Vector3<T> x2, Vector3<T> x3) {
  const auto cotangent = [](Vector3<T> a, Vector3<T> b) { return dot(a, b) / length(cross(a, b)); };
  const Vector3<T> e = x1 - x0;
  const Vector3<T> wings[2] = {x2 - x0, x3 - x0};
  for (const Vector3<T>& wing : wings) {
    if (!(length_squared(cross(e, wing)) > T(0))) return {};
  }
  T at_0[2], at_1[2];
  for (int i = 0; i < 2; ++i) {
    at_0[i] = cotangent(e, wings[i]);
    at_1[i] = cotangent(-e, wings[i] - e);
  }
  return {at_1[0] + at_1[1], at_0[0] + at_0[1], -(at_0[0] + at_1[0]), -(at_0[1] + at_1[1])};
}

/// Returns q = sum K_i x_i. It uses differences of positions, which keep their digits far from the origin.
template <class T>
Vector3<T> curvature(const std::array<double, 4>& weights, const std::array<Vector3<T>, 4>& x) {
  Vector3<T> q = weights[1] * (x[1] - x[0]);
  for (int i = 2; i < 4; ++i) q = q + weights[i] * (x[i] - x[0]);
  return q;
}

}  // namespace hooke::elements
