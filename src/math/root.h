#pragma once

#include <cmath>

namespace hooke::math {

/// Returns the cube root of x, to the last digit or two. It gives the same bits everywhere, which std::cbrt
/// does not. The result is 0 if x is not positive or not finite.
inline double cube_root(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 0;
  int exponent = 0;
  double part = std::frexp(x, &exponent);  // In [0.5, 1).
  for (; exponent % 3 != 0; ++exponent) part *= 0.5;
  double root = 0.7;  // First guess for a number in [0.125, 1).
  for (int i = 0; i < 8; ++i) root -= (root - part / (root * root)) / 3;
  return std::ldexp(root, exponent / 3);
}

}  // namespace hooke::math
