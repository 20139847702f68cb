#include "lab/methods/methods.h"

namespace hooke::lab {

/// This is the paper's eq. 5 to 7, which it calls Heun: the position to second order, the velocity to first.
///
/// x' = x + h v + h^2 a / 2,   v' = v + h a,   a = a(t, x, v)
///
/// It has order 1. An undamped oscillation grows at any step, |R|^2 = 1 + (omega h)^2 / 2: half as fast as
/// Euler's.
void step_taylor2_paper(const System& f, double t, double h, State& y, Workspace&) {
  const State a = f.acceleration(t, y);
  f.x(y) += h * f.v(y) + h * h / 2 * a;
  f.v(y) += h * a;
}

double growth_taylor2_paper(Oscillator o) {
  return growth_of_map([o](Phase p) {
    const double a = pull(o, p.x, p.u);
    return Phase{p.x + p.u + a / 2, p.u + a};
  });
}

}  // namespace hooke::lab
