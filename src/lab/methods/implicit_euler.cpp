#include "lab/methods/implicit.h"
#include "lab/methods/methods.h"

namespace hooke::lab {

/// Implicit Euler: both slopes at the end of the step.
///
///     y' = y + h f(t + h, y')
///
/// Order 1. Stable at any step, R = 1 / (1 - z): damps every oscillation, |R|^2 = 1 / (1 + (omega h)^2).
/// Solved by Newton with the exact Jacobian (lab/methods/implicit.h). Hairer, Wanner, "Solving Ordinary
/// Differential Equations II", IV.3; in cloth Baraff, Witkin 1998.
void step_implicit_euler(const System& f, double t, double h, State& y, Workspace& work) {
  const State known = y;
  solve_implicit(f, t + h, h, known, y, work);
}

double growth_implicit_euler(Oscillator o) {
  double largest = 0;
  for (const std::complex<double> z : eigenvalues(o)) largest = std::max(largest, 1 / std::abs(1.0 - z));
  return largest;
}

}  // namespace hooke::lab
