#include "lab/methods/methods.h"

namespace hooke::lab {

/// In symplectic Euler the new velocity moves the position.
///
/// v' = v + h a(t, x, v),   x' = x + h v'
///
/// It has order 1, and yet the energy of an undamped motion stays near its value for ever. It is stable for
/// omega h <= 2. De Vogelaere 1956; Hairer, Lubich, Wanner, "Geometric Numerical Integration", I.1.2.
void step_symplectic_euler(const System& f, double t, double h, State& y, Workspace&) {
  f.v(y) += h * f.acceleration(t, y);
  f.x(y) += h * f.v(y);
}

double growth_symplectic_euler(Oscillator o) {
  return growth_of_map([o](Phase p) {
    p.u += pull(o, p.x, p.u);
    p.x += p.u;
    return p;
  });
}

}  // namespace hooke::lab
