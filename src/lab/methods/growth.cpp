#include "lab/methods/growth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hooke::lab {

namespace {

constexpr double kRounding = 1e-10;

/// Growth without damping is of fourth order or higher, so that rounding hides it at smaller omega h.
constexpr double kVisible = 0.05;

}  // namespace

std::array<std::complex<double>, 2> eigenvalues(Oscillator o) {
  const double half = 0.5 * o.damping;
  const std::complex<double> root = std::sqrt(std::complex<double>(half * half - o.stiffness));
  const std::complex<double> larger = -half - root;
  // The form -half + root would cancel when the damping is strong.
  return {larger, std::abs(larger) > 0 ? o.stiffness / larger : 0.0};
}

double growth_of_polynomial(Oscillator oscillator, std::initializer_list<double> c) {
  double largest = 0;
  for (const std::complex<double> z : eigenvalues(oscillator)) {
    std::complex<double> sum = 0;
    for (const double* term = c.end(); term != c.begin();) sum = sum * z + *--term;
    largest = std::max(largest, std::abs(sum));
  }
  return largest;
}

double growth_of_map(const std::function<Phase(Phase)>& step) {
  const Phase a = step({1, 0});
  const Phase b = step({0, 1});
  const double half_trace = 0.5 * (a.x + b.u);
  const double determinant = a.x * b.u - a.u * b.x;
  const double discriminant = half_trace * half_trace - determinant;
  if (discriminant < 0) return std::sqrt(determinant);
  return std::abs(half_trace) + std::sqrt(discriminant);
}

double growth_of_multistep(Oscillator oscillator, Multistep method) {
  const auto degree = static_cast<Eigen::Index>(method.alpha.size()) - 1;
  double largest = 0;
  for (const std::complex<double> z : eigenvalues(oscillator)) {
    Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(degree, degree);
    const std::complex<double> leading = method.alpha[0] - z * method.beta[0];
    for (Eigen::Index j = 0; j < degree; ++j) {
      companion(0, j) = -(method.alpha[j + 1] - z * method.beta[j + 1]) / leading;
      if (j > 0) companion(j, j - 1) = 1;
    }
    largest = std::max(largest, companion.eigenvalues().cwiseAbs().maxCoeff());
  }
  return largest;
}

bool is_stable(Growth growth, Oscillator oscillator, double tolerated) {
  const double factor = growth(oscillator);
  if (factor <= 1 + kRounding) return true;
  if (!(tolerated > 1) || !(oscillator.stiffness > 0)) return false;
  return std::log(factor) * 2 * std::numbers::pi / std::sqrt(oscillator.stiffness) <= std::log(tolerated);
}

double stable_scale(Growth growth, double omega, double damping, double tolerated) {
  constexpr double kStart = 1e-3;
  constexpr double kEnd = 1e9;
  const double rate = std::max(omega, damping);
  if (!(rate > 0)) return std::numeric_limits<double>::infinity();
  const auto stable = [&](double s) {
    return is_stable(growth, {s * s * omega * omega, s * damping}, tolerated);
  };
  double low = kStart / rate;
  if (!stable(low) || (damping == 0 && !stable(kVisible / rate))) return 0;
  double high = low;
  while (stable(high)) {
    low = high;
    high *= 1.02;
    if (high * rate > kEnd) return std::numeric_limits<double>::infinity();
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace hooke::lab
