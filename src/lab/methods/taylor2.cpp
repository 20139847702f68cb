#include "lab/methods/methods.h"

namespace hooke::lab {

/// This is Taylor's series to second order for both, with the jerk j, the derivative of a along the solution.
///
/// x' = x + h v + h^2 a / 2,   v' = v + h a + h^2 j / 2
///
/// It has order 2 and is exact where a is constant. An undamped oscillation grows slowly, |R|^2 = 1 + (omega
/// h)^4 / 4. Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I", I.8.
void step_taylor2(const System& f, double t, double h, State& y, Workspace&) {
  const std::vector<State> d = f.acceleration_and_derivatives(t, y, 2);
  const State &a = d[0], &j = d[1];
  f.x(y) += h * f.v(y) + h * h / 2 * a;
  f.v(y) += h * a + h * h / 2 * j;
}

double growth_taylor2(Oscillator o) {
  return growth_of_polynomial(o, {1, 1, 1.0 / 2});
}

}  // namespace hooke::lab
