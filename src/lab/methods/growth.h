#pragma once

#include "lab/methods/method.h"

#include <array>
#include <complex>
#include <functional>
#include <initializer_list>
#include <span>

/// \file
/// Tells by how much one step multiplies an oscillation, for each family of methods. The eigenvalues of the
/// oscillation times the step, z, are the roots of z^2 + damping z + stiffness = 0.

namespace hooke::lab {

/// Returns both z, the one of larger size first.
[[nodiscard]] std::array<std::complex<double>, 2> eigenvalues(Oscillator oscillator);

/// For one-step methods whose step of y' = lambda y is y R(z), with R(z) = c_0 + c_1 z + c_2 z^2 + ...
[[nodiscard]] double growth_of_polynomial(Oscillator oscillator, std::initializer_list<double> c);

/// These are the position, and the velocity times h, before or after a step on the oscillator.
struct Phase {
  double x = 0, u = 0;
};
/// For methods that treat x and v differently; `step` is one step on the oscillator, which is a linear map.
[[nodiscard]] double growth_of_map(const std::function<Phase(Phase)>& step);

/// Returns h^2 x'' of the oscillator.
[[nodiscard]] inline double pull(Oscillator o, double x, double u) {
  return -o.stiffness * x - o.damping * u;
}

/// This is a linear multistep method, with the newest coefficients first:
/// alpha_0 y_n+1 + alpha_1 y_n + ... = h (beta_0 f_n+1 + beta_1 f_n + ...)
struct Multistep {
  std::span<const double> alpha, beta;
};
/// Returns the largest |xi| of the roots of sum (alpha_j - z beta_j) xi^(k-j) = 0.
[[nodiscard]] double growth_of_multistep(Oscillator oscillator, Multistep method);

/// Returns the largest factor s in (0, 1e9] for which oscillations with omega h = s omega, damping h = s
/// damping do not grow by more than rounding. The limit of the first interval of stability is bisected. The
/// result is infinity if nothing grows, and 0 if even the smallest step grows. `tolerated` is a growth per
/// period that counts as none, for methods that always grow.
[[nodiscard]] double stable_scale(Growth growth, double omega, double damping, double tolerated = 1.0);

/// Tells whether the oscillation does not grow, or by no more than `tolerated` per period.
[[nodiscard]] bool is_stable(Growth growth, Oscillator oscillator, double tolerated = 1.0);

}  // namespace hooke::lab
