#pragma once

#include <cmath>

namespace hooke::math {

/// The cube root of x, to the last digit or two, with the same bits everywhere: std::cbrt is as each C
/// library has it. 0 for what is not positive.
inline double cube_root(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 0;
  int exponent = 0;
  double part = std::frexp(x, &exponent);  // in [0.5, 1)
  for (; exponent % 3 != 0; ++exponent) part *= 0.5;
  double root = 0.7;  // of [0.125, 1)
  for (int i = 0; i < 8; ++i) root -= (root - part / (root * root)) / 3;
  return std::ldexp(root, exponent / 3);
}

}  // namespace hooke::math
