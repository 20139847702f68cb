#include "lab/methods/implicit.h"
#include "lab/methods/methods.h"

namespace hooke::lab {

/// Implicit Euler takes both slopes at the end of the step.
///
/// y' = y + h f(t + h, y')
///
/// It has order 1. It is stable at any step, R = 1 / (1 - z), and damps every oscillation, |R|^2 = 1 / (1 +
/// (omega h)^2). Newton's method solves it with the exact Jacobian (lab/methods/implicit.h). Hairer, Wanner,
/// "Solving Ordinary Differential Equations II", IV.3; in cloth Baraff, Witkin 1998.
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
