#pragma once

#include "hooke/math.h"

#include <algorithm>

/// \file
/// Points repel each other with a force that falls with the square of their distance d and ends at a range r:
///
///     F = s (1 / d^2 - 1 / r^2)    for d < r,    U = s (1 / d + d / r^2 - 2 / r)
///
/// s is in N m^2. Without the second term the force would jump where a pair leaves the range (docs/paper.md,
/// 3.5.2).

namespace hooke::elements {

/// Force F [N].
template <class T>
T repulsion_force(T strength, T range, T distance) {
  return distance < range ? strength * (1 / (distance * distance) - 1 / (range * range)) : T(0);
}

/// Energy U [J].
template <class T>
T repulsion_energy(T strength, T range, T distance) {
  return distance < range ? strength * (1 / distance + distance / (range * range) - 2 / range) : T(0);
}

/// Distance of two points after a substep [m], with the force of the substep's end. It is the root y of
///
///     y = free + a (1 / y^2 - 1 / r^2),    a = h^2 s (1 / m_1 + 1 / m_2) > 0
///
/// `free` [m] is the distance that they would have without the force, less than r and of any sign. y lies in
/// (0, r): the points never meet, however fast they approach and however long h is. Their energy falls, as
/// with any backward Euler step in a convex potential (Hairer and Wanner, Solving ODEs II, IV.12).
template <class T>
T repelled_distance(T free, T a, T range) {
  // y^3 - b y^2 - a = 0 has one positive root and is convex above it, so that Newton's method comes down to
  // it.
  constexpr int kMost = 64;
  constexpr T kClose = T(1e-6);
  const T b = free - a / (range * range);
  T y = range;
  for (int i = 0; i < kMost; ++i) {
    const T next = y - (y * y * (y - b) - a) / (y * (3 * y - 2 * b));
    if (!(next < y * (1 - kClose))) return std::min(y, range);
    y = next;
  }
  return y;
}

}  // namespace hooke::elements
