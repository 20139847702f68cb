/// Computes the eigenvalues of an object's small motions.

#include "lab/system/system.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

namespace hooke::lab {

namespace {

using Eigenvalues = std::vector<std::complex<double>>;

constexpr Eigen::Index kMostCoordinates = 300;  ///< The time grows with their third power.

Eigen::MatrixXd dense(const std::vector<Jacobian::Entry>& entries, Eigen::Index size) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (const Jacobian::Entry& e : entries) matrix(e.row, e.column) += e.value;
  return matrix;
}

/// Returns the roots of lambda^2 = mu for each eigenvalue mu of da/dx: nothing depends on velocities.
Eigenvalues without_damping(const Eigen::MatrixXd& by_position) {
  Eigenvalues list;
  const Eigen::VectorXcd values = by_position.eigenvalues();
  const double rounding = 1e-12 * values.cwiseAbs().maxCoeff();
  for (std::complex<double> mu : values) {
    // Forces with an energy give real mu; the roots would show rounding in it as growth.
    if (std::abs(mu.imag()) <= 1e3 * rounding) mu = mu.real();
    if (std::abs(mu) <= rounding) mu = 0;
    const std::complex<double> root = std::sqrt(mu);
    list.push_back(root);
    list.push_back(-root);
  }
  return list;
}

Eigenvalues with_damping(const Eigen::MatrixXd& by_position, const Eigen::MatrixXd& by_velocity) {
  const Eigen::Index size = by_position.rows();
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  whole.topRightCorner(size, size).setIdentity();
  whole.bottomLeftCorner(size, size) = by_position;
  whole.bottomRightCorner(size, size) = by_velocity;
  const Eigen::VectorXcd values = whole.eigenvalues();
  return {values.begin(), values.end()};
}

/// Returns the roots of lambda^2 + damping lambda + omega^2 = 0.
void append_roots(const Oscillation& o, Eigenvalues& list) {
  const double half = 0.5 * o.damping;
  const std::complex<double> root = std::sqrt(std::complex<double>(half * half - o.omega_squared));
  const std::complex<double> larger = -half - root;
  list.push_back(larger);
  list.push_back(std::abs(larger) > 0 ? o.omega_squared / larger : 0.0);
}

}  // namespace

Spectrum System::spectrum(double t, const State& y) const {
  Spectrum spectrum = {.kind = kind_, .slot = slot_};
  const std::vector<Oscillation> bounds = oscillations(t, y);
  const auto fastest = std::max_element(bounds.begin(), bounds.end(), [](const auto& a, const auto& b) {
    return a.omega_squared + a.damping * a.damping < b.omega_squared + b.damping * b.damping;
  });
  if (fastest != bounds.end()) spectrum.stiffest = row_name(fastest->row);
  spectrum.bounded = coordinates_ > kMostCoordinates;
  if (spectrum.bounded) {
    for (const Oscillation& o : bounds) append_roots(o, spectrum.eigenvalues);
  } else if (coordinates_ > 0) {
    const Jacobian derivatives = jacobian(t, y);
    const Eigen::MatrixXd by_position = dense(derivatives.by_position, coordinates_);
    spectrum.eigenvalues = derivatives.by_velocity.empty()
                               ? without_damping(by_position)
                               : with_damping(by_position, dense(derivatives.by_velocity, coordinates_));
  }
  std::stable_sort(spectrum.eigenvalues.begin(), spectrum.eigenvalues.end(),
                   [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  return spectrum;
}

}  // namespace hooke::lab
