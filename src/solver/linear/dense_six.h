#pragma once

#include <array>
#include <cstddef>

/// \file
/// Vectors of six numbers, as motions and impulses of bodies, and symmetric matrices of six by six.

namespace hooke::solver {

[[nodiscard]] inline double product_six(const std::array<double, 6>& a, const std::array<double, 6>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

/// Factors L D L^T in place: L below the diagonal, 1 / D on it. What nearly nothing resists stays at rest.
inline void factorize_six(std::array<std::array<double, 6>, 6>& m) {
  constexpr double kLeastPivot = 1e-12;
  std::array<double, 6> d = {};
  for (std::size_t j = 0; j < 6; ++j) {
    const double whole = m[j][j];
    d[j] = whole;
    for (std::size_t k = 0; k < j; ++k) d[j] -= m[j][k] * m[j][k] * d[k];
    const double inverse = d[j] > kLeastPivot * whole ? 1 / d[j] : 0;
    for (std::size_t i = j + 1; i < 6; ++i) {
      for (std::size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k] * d[k];
      m[i][j] *= inverse;
    }
    m[j][j] = inverse;
  }
}

/// Solves with such factors.
[[nodiscard]] inline std::array<double, 6> solved_six(const std::array<std::array<double, 6>, 6>& factor,
                                                      std::array<double, 6> x) {
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= factor[i][k] * x[k];
  }
  for (std::size_t i = 6; i-- > 0;) {
    x[i] *= factor[i][i];
    for (std::size_t k = i + 1; k < 6; ++k) x[i] -= factor[k][i] * x[k];
  }
  return x;
}

}  // namespace hooke::solver
