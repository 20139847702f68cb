#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"

#include <array>

/// \file
/// Moves vectors, quaternions and matrices to and from arrays of lanes.

namespace hooke::solver {

template <class T, class Lane, int kCount>
void put(Vector3<T> v, Lane (&to)[3][kCount], int lane) {
  to[0][lane] = static_cast<Lane>(v.x);
  to[1][lane] = static_cast<Lane>(v.y);
  to[2][lane] = static_cast<Lane>(v.z);
}
template <class T, class Lane, int kCount>
void put(Quaternion<T> q, Lane (&to)[4][kCount], int lane) {
  to[0][lane] = static_cast<Lane>(q.x);
  to[1][lane] = static_cast<Lane>(q.y);
  to[2][lane] = static_cast<Lane>(q.z);
  to[3][lane] = static_cast<Lane>(q.w);
}
template <class T, class Lane, int kCount>
void put(const math::Symmetric3<T>& m, Lane (&to)[6][kCount], int lane) {
  const std::array<T, 6> entries = {m.xx, m.xy, m.xz, m.yy, m.yz, m.zz};
  for (int k = 0; k < 6; ++k) to[k][lane] = static_cast<Lane>(entries[k]);
}
template <class Lane, int kCount>
Vector3<Lane> get(const Lane (&from)[3][kCount], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}
template <class Lane, int kCount>
math::Symmetric3<Lane> get6(const Lane (&from)[6][kCount], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane], from[3][lane], from[4][lane], from[5][lane]};
}

}  // namespace hooke::solver
