#include "lab/methods/methods.h"

namespace hooke::lab {

/// Heun's method takes the mean of the slopes at the start and at the end that Euler predicts.
///
/// k1 = f(t, y),   k2 = f(t + h, y + h k1),   y' = y + h (k1 + k2) / 2
///
/// It has order 2. An undamped oscillation grows slowly, |R|^2 = 1 + (omega h)^4 / 4. Heun 1900, Z. Math.
/// Phys. 45.
void step_heun(const System& f, double t, double h, State& y, Workspace&) {
  const State k1 = f(t, y);
  const State k2 = f(t + h, y + h * k1);
  y += h / 2 * (k1 + k2);
}

double growth_heun(Oscillator o) {
  return growth_of_polynomial(o, {1, 1, 1.0 / 2});
}

}  // namespace hooke::lab
