#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"

#include <array>

/// \file
/// Vectors, quaternions and matrices to and from arrays of lanes.

namespace hooke::solver {

template <int kCount>
void put(DVec3 v, double (&to)[3][kCount], int lane) {
  to[0][lane] = v.x;
  to[1][lane] = v.y;
  to[2][lane] = v.z;
}
template <class T, int kCount>
void put(Quaternion<T> q, double (&to)[4][kCount], int lane) {
  to[0][lane] = static_cast<double>(q.x);
  to[1][lane] = static_cast<double>(q.y);
  to[2][lane] = static_cast<double>(q.z);
  to[3][lane] = static_cast<double>(q.w);
}
template <int kCount>
void put(const math::Symmetric3<double>& m, double (&to)[6][kCount], int lane) {
  const std::array<double, 6> entries = {m.xx, m.xy, m.xz, m.yy, m.yz, m.zz};
  for (int k = 0; k < 6; ++k) to[k][lane] = entries[k];
}
template <int kCount>
DVec3 get(const double (&from)[3][kCount], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}
template <int kCount>
math::Symmetric3<double> get6(const double (&from)[6][kCount], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane], from[3][lane], from[4][lane], from[5][lane]};
}

}  // namespace hooke::solver
