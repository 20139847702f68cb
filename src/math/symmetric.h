#pragma once

#include "hooke/math.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace hooke::math {

/// A symmetric 3x3 matrix is stored by the six entries of its upper triangle.
template <class T>
struct Symmetric3 {
  T xx = T(0), xy = T(0), xz = T(0), yy = T(0), yz = T(0), zz = T(0);

  static constexpr Symmetric3 diagonal(T s) { return {s, T(0), T(0), s, T(0), s}; }
};

template <class T>
constexpr Symmetric3<T> operator+(const Symmetric3<T>& a, const Symmetric3<T>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
template <class T>
constexpr Vector3<T> operator*(const Symmetric3<T>& m, Vector3<T> v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

/// Returns along n n^T + across (1 - n n^T) for a unit vector n.
template <class T>
constexpr Symmetric3<T> axial(Vector3<T> n, T along, T across) {
  const T d = along - across;
  return {across + d * n.x * n.x, d * n.x * n.y, d * n.x * n.z,
          across + d * n.y * n.y, d * n.y * n.z, across + d * n.z * n.z};
}

/// Inertia about the origin of a point of this mass at r.
template <class T>
constexpr Symmetric3<T> inertia_of_point(T mass, Vector3<T> r) {
  return {mass * (r.y * r.y + r.z * r.z), -mass * r.x * r.y, -mass * r.x * r.z,
          mass * (r.x * r.x + r.z * r.z), -mass * r.y * r.z, mass * (r.x * r.x + r.y * r.y)};
}

/// Returns a power of two that brings x to about 1. Products of three numbers scaled by it neither overflow
/// nor vanish.
constexpr float power_to_one(float x) {
  constexpr std::uint32_t kExponent = 0x7F80'0000;
  const std::uint32_t exponent = std::bit_cast<std::uint32_t>(x) & kExponent;
  return std::bit_cast<float>(std::clamp(0x7F00'0000 - exponent, 0x0080'0000U, 0x7F00'0000U));
}
constexpr double power_to_one(double /*x*/) {
  return 1;  // The range of double is wide enough.
}

/// Returns the inverse by cofactors, for positive definite matrices. It is not finite if the determinant is
/// zero.
template <class T>
constexpr Symmetric3<T> inverse(const Symmetric3<T>& matrix) {
  const T unit = power_to_one(std::max({matrix.xx, matrix.yy, matrix.zz}));
  const Symmetric3<T> m = {unit * matrix.xx, unit * matrix.xy, unit * matrix.xz,
                           unit * matrix.yy, unit * matrix.yz, unit * matrix.zz};
  const T xx = m.yy * m.zz - m.yz * m.yz;
  const T xy = m.xz * m.yz - m.xy * m.zz;
  const T xz = m.xy * m.yz - m.xz * m.yy;
  const T s = unit / (m.xx * xx + m.xy * xy + m.xz * xz);
  return {s * xx,
          s * xy,
          s * xz,
          s * (m.xx * m.zz - m.xz * m.xz),
          s * (m.xy * m.xz - m.xx * m.yz),
          s * (m.xx * m.yy - m.xy * m.xy)};
}

template <class T>
constexpr T determinant(const Symmetric3<T>& m) {
  return m.xx * (m.yy * m.zz - m.yz * m.yz) - m.xy * (m.xy * m.zz - m.yz * m.xz) +
         m.xz * (m.xy * m.yz - m.yy * m.xz);
}

/// Returns the lower triangular L with L L^T = m. It is not finite unless m is positive definite.
template <class T>
Matrix3<T> cholesky(const Symmetric3<T>& m) {
  const T xx = std::sqrt(m.xx);
  const T yx = m.xy / xx;
  const T zx = m.xz / xx;
  const T yy = std::sqrt(m.yy - yx * yx);
  const T zy = (m.yz - zx * yx) / yy;
  return {{xx, yx, zx}, {T(0), yy, zy}, {T(0), T(0), std::sqrt(m.zz - zx * zx - zy * zy)}};
}

/// Returns the symmetric part of the product a b c.
template <class T>
constexpr Symmetric3<T> symmetric_product(const Symmetric3<T>& a, const Symmetric3<T>& b,
                                          const Symmetric3<T>& c) {
  const Vector3<T> x = a * (b * Vector3<T>{c.xx, c.xy, c.xz});
  const Vector3<T> y = a * (b * Vector3<T>{c.xy, c.yy, c.yz});
  const Vector3<T> z = a * (b * Vector3<T>{c.xz, c.yz, c.zz});
  return {x.x, T(0.5) * (x.y + y.x), T(0.5) * (x.z + z.x), y.y, T(0.5) * (y.z + z.y), z.z};
}

template <class T>
Symmetric3<double> in_double(const Symmetric3<T>& m) {
  return {static_cast<double>(m.xx), static_cast<double>(m.xy), static_cast<double>(m.xz),
          static_cast<double>(m.yy), static_cast<double>(m.yz), static_cast<double>(m.zz)};
}

}  // namespace hooke::math
