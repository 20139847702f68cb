#include "lab/methods/methods.h"

namespace hooke::lab {

/// The midpoint rule takes the slope in the middle, where half a step of Euler leads.
///
/// k1 = f(t, y),   k2 = f(t + h/2, y + h k1 / 2),   y' = y + h k2
///
/// It has order 2. An undamped oscillation grows slowly, |R|^2 = 1 + (omega h)^4 / 4. Runge 1895, Math. Ann.
/// 46.
void step_midpoint(const System& f, double t, double h, State& y, Workspace&) {
  const State k1 = f(t, y);
  const State k2 = f(t + h / 2, y + h / 2 * k1);
  y += h * k2;
}

double growth_midpoint(Oscillator o) {
  return growth_of_polynomial(o, {1, 1, 1.0 / 2});
}

}  // namespace hooke::lab
