#include "geometry/statics/eigen6.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hooke::geometry {

namespace {

constexpr int kSweeps = 12;  // It converges with the square: five or six suffice.

/// Turns rows and columns p and q so that the entry between them vanishes (Golub, Van Loan, Matrix
/// Computations, 8.5).
void rotate_pair(Matrix6& m, std::array<Vector6, 6>& vectors, std::size_t p, std::size_t q) {
  if (m[p][q] == 0) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = (theta >= 0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  for (std::size_t k = 0; k < 6; ++k) {
    const double kp = m[k][p];
    const double kq = m[k][q];
    m[k][p] = c * kp - s * kq;
    m[k][q] = s * kp + c * kq;
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const double pk = m[p][k];
    const double qk = m[q][k];
    m[p][k] = c * pk - s * qk;
    m[q][k] = s * pk + c * qk;
    const double vp = vectors[p][k];
    const double vq = vectors[q][k];
    vectors[p][k] = c * vp - s * vq;
    vectors[q][k] = s * vp + c * vq;
  }
}

}  // namespace

Eigen6 eigen_of(Matrix6 matrix) {
  std::array<Vector6, 6> vectors = {};
  for (std::size_t k = 0; k < 6; ++k) vectors[k][k] = 1;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t p = 0; p < 6; ++p) {
      for (std::size_t q = p + 1; q < 6; ++q) rotate_pair(matrix, vectors, p, q);
    }
  }
  std::array<std::size_t, 6> order = {};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return matrix[a][a] < matrix[b][b]; });
  Eigen6 result;
  for (std::size_t k = 0; k < 6; ++k) {
    result.values[k] = matrix[order[k]][order[k]];
    result.vectors[k] = vectors[order[k]];
  }
  return result;
}

}  // namespace hooke::geometry
