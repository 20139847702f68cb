#include "lab/methods/methods.h"

namespace hooke::lab {

/// Explicit Euler takes both slopes at the start of the step.
///
/// y' = y + h f(t, y)
///
/// It has order 1. An undamped oscillation grows at any step, |R|^2 = 1 + (omega h)^2; a damped one does
/// where omega h > 2 zeta (zeta < 1). Euler 1768, "Institutionum calculi integralis", I.2.7.
void step_euler(const System& f, double t, double h, State& y, Workspace&) {
  y += h * f(t, y);
}

double growth_euler(Oscillator o) {
  return growth_of_polynomial(o, {1, 1});
}

}  // namespace hooke::lab
