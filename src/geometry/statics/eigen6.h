#pragma once

#include <array>
#include <cstddef>

namespace hooke::geometry {

using Vector6 = std::array<double, 6>;
using Matrix6 = std::array<Vector6, 6>;  ///< By rows.

/// Eigenvalues of a symmetric matrix, the least first, and its unit eigenvectors in the same order.
struct Eigen6 {
  Vector6 values = {};
  std::array<Vector6, 6> vectors = {};
};

/// Finds them by cyclic Jacobi rotations, with + - * / and sqrt only.
[[nodiscard]] Eigen6 eigen_of(Matrix6 matrix);

}  // namespace hooke::geometry
