#include "lab/methods/methods.h"

namespace hooke::lab {

/// This is Taylor's series to third order, with jerk j and snap s.
///
/// x' = x + h v + h^2 a / 2 + h^3 j / 6,   v' = v + h a + h^2 j / 2 + h^3 s / 6
///
/// It has order 3 and is stable for omega h <= sqrt(3). Its source is that of taylor2.
void step_taylor3(const System& f, double t, double h, State& y, Workspace&) {
  const std::vector<State> d = f.acceleration_and_derivatives(t, y, 3);
  const State &a = d[0], &j = d[1], &s = d[2];
  f.x(y) += h * f.v(y) + h * h / 2 * a + h * h * h / 6 * j;
  f.v(y) += h * a + h * h / 2 * j + h * h * h / 6 * s;
}

double growth_taylor3(Oscillator o) {
  return growth_of_polynomial(o, {1, 1, 1.0 / 2, 1.0 / 6});
}

}  // namespace hooke::lab
