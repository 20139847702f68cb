#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"

#include <cmath>
#include <limits>

namespace hooke::elements {

/// |dev A|^2, the sum of the squares of all elements after the mean is taken from the diagonal.
template <class T>
constexpr T deviator_squared(const math::Symmetric3<T>& a) {
  const T mean = (a.xx + a.yy + a.zz) / T(3);
  const T x = a.xx - mean, y = a.yy - mean, z = a.zz - mean;
  return x * x + y * y + z * z + T(2) * (a.xy * a.xy + a.xz * a.xz + a.yz * a.yz);
}

/// Value of |dev C|^2, with C = F^T F, at which a NeoHookean material of shear modulus mu yields. There the
/// von Mises stress sqrt(3/2) |dev tau| of its Kirchhoff stress is sigma_y. Its law is dev tau = mu dev F
/// F^T, and F F^T has the eigenvalues of C. At small strain C = 1 + 2 e, and a bar pulled by its end yields
/// at e = sigma_y / E.
template <class T>
constexpr T yield_limit(T yield_stress, T shear_modulus) {
  const T ratio = yield_stress / shear_modulus;
  return T(2) / T(3) * ratio * ratio;
}

/// Returns C' = m 1 + share dev C with det C' = det C. `share` of the shear stress is left, 0 <= share <= 1,
/// and all of the change of volume. This is the radial return of Simo and Hughes 1998, box 9.1, who keep the
/// trace instead, so that the volume drifts. m is the largest root of a cubic that is convex between it and
/// mean(C), where Newton's method begins. So the method comes from above and never jumps over the root. The
/// energy falls with the share, because m does: dm / dshare >= 0, since the harmonic mean of the eigenvalues
/// of C' is at most their mean.
template <class T>
math::Symmetric3<T> returned(const math::Symmetric3<T>& c, T share) {
  const T mean = (c.xx + c.yy + c.zz) / T(3);
  const math::Symmetric3<T> d = {share * (c.xx - mean), share * c.xy, share * c.xz,
                                 share * (c.yy - mean), share * c.yz, share * (c.zz - mean)};
  const T half_square = T(0.5) * deviator_squared(d);
  const T target = determinant(c) - determinant(d);
  T m = mean;
  for (int i = 0; i < 100; ++i) {  // det (m 1 + d) = m^3 - m |d|^2 / 2 + det d
    const T change = (m * (m * m - half_square) - target) / (T(3) * m * m - half_square);
    m -= change;
    if (!(change > T(8) * std::numeric_limits<T>::epsilon() * m)) break;
  }
  return {m + d.xx, d.xy, d.xz, m + d.yy, d.yz, m + d.zz};
}

/// Returns the lower triangular X of determinant 1 that takes the gradients b of shape functions at rest to
/// those after the flow. With X b in place of b, F^T F is `after` in place of `before`, up to a rotation,
/// which no isotropic material feels. X = L' L^-1 of the Cholesky factors before = L L^T and after = L' L'^T.
/// Both matrices are positive definite.
template <class T>
Matrix3<T> flow_between(const math::Symmetric3<T>& before, const math::Symmetric3<T>& after) {
  const Matrix3<T> l = cholesky(before);
  const Matrix3<T> k = cholesky(after);
  const T xx = k.x.x / l.x.x;
  const T yy = k.y.y / l.y.y;
  const T zz = T(1) / (xx * yy);  // k.z.z / l.z.z, but with a determinant of exactly 1 if `after` is rounded.
  const T yx = (k.x.y - yy * l.x.y) / l.x.x;
  const T zy = (k.y.z - zz * l.y.z) / l.y.y;
  const T zx = (k.x.z - zy * l.x.y - zz * l.x.z) / l.x.x;
  return {{xx, yx, zx}, {T(0), yy, zy}, {T(0), T(0), zz}};
}

}  // namespace hooke::elements
