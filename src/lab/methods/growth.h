#pragma once

#include "lab/methods/method.h"

#include <array>
#include <complex>
#include <functional>
#include <initializer_list>
#include <span>

/// \file
/// How one step multiplies an oscillation, for each family of methods. Its eigenvalues times the step, z, are
/// the roots of z^2 + damping z + stiffness = 0.

namespace hooke::lab {

/// The larger root in size comes first.
[[nodiscard]] std::array<std::complex<double>, 2> eigenvalues(Oscillator oscillator);

/// One-step methods whose step of y' = lambda y is y R(z), R(z) = c_0 + c_1 z + c_2 z^2 + ...
[[nodiscard]] double growth_of_polynomial(Oscillator oscillator, std::initializer_list<double> c);

/// Position and velocity times h: what a step of a method does to them on the oscillator.
struct Phase {
  double x = 0, u = 0;
};
/// Methods that treat x and v differently: the matrix of the linear map `step`.
[[nodiscard]] double growth_of_map(const std::function<Phase(Phase)>& step);

/// h^2 x'' of the oscillator.
[[nodiscard]] inline double pull(Oscillator o, double x, double u) {
  return -o.stiffness * x - o.damping * u;
}

/// A linear multistep method, the newest first:
///     alpha_0 y_n+1 + alpha_1 y_n + ... = h (beta_0 f_n+1 + beta_1 f_n + ...)
struct Multistep {
  std::span<const double> alpha, beta;
};
/// The largest root xi of sum (alpha_j - z beta_j) xi^(k-j) = 0.
[[nodiscard]] double growth_of_multistep(Oscillator oscillator, Multistep method);

/// Largest factor s in (0, 1e9] for which oscillations with omega h = s omega, damping h = s damping do not
/// grow by more than rounding, the first that does being bisected; infinity if there is none. 0 if even the
/// smallest grow. `tolerated` is a growth per period that counts as none, for methods that always grow.
[[nodiscard]] double stable_scale(Growth growth, double omega, double damping, double tolerated = 1.0);

/// The oscillation does not grow, or by no more than `tolerated` per period.
[[nodiscard]] bool is_stable(Growth growth, Oscillator oscillator, double tolerated = 1.0);

}  // namespace hooke::lab
