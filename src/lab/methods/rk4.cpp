#include "lab/methods/methods.h"

namespace hooke::lab {

/// The classical Runge-Kutta method takes four slopes.
///
/// k1 = f(t, y),               k2 = f(t + h/2, y + h k1 / 2),
/// k3 = f(t + h/2, y + h k2 / 2),   k4 = f(t + h, y + h k3),
/// y' = y + h (k1 + 2 k2 + 2 k3 + k4) / 6
///
/// It has order 4. It is stable for omega h <= 2 sqrt(2) without damping, for |lambda| h <= 2.785 on a decay.
/// Kutta 1901, Z. Math. Phys. 46.
void step_rk4(const System& f, double t, double h, State& y, Workspace&) {
  const State k1 = f(t, y);
  const State k2 = f(t + h / 2, y + h / 2 * k1);
  const State k3 = f(t + h / 2, y + h / 2 * k2);
  const State k4 = f(t + h, y + h * k3);
  y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

double growth_rk4(Oscillator o) {
  return growth_of_polynomial(o, {1, 1, 1.0 / 2, 1.0 / 6, 1.0 / 24});
}

}  // namespace hooke::lab
