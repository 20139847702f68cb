#include "lab/methods/methods.h"

namespace hooke::lab {

/// Velocity Verlet makes half a kick, a drift and half a kick.
///
/// v_m = v + h a / 2,   x' = x + h v_m,   a' = a(t + h, x', v + h a),   v' = v_m + h a' / 2
///
/// It has order 2, also with forces that depend on velocity, which use the velocity predicted for the end of
/// the step. Without such forces it is symplectic, a' serves the next step as a, and it is stable for omega h
/// <= 2. Verlet 1967, Phys. Rev. 159; Swope et al. 1982, J. Chem. Phys. 76.
void step_verlet(const System& f, double t, double h, State& y, Workspace& work) {
  const State a = work.carried ? *work.carried : f.acceleration(t, y);
  const State v_middle = f.v(y) + h / 2 * a;
  f.x(y) += h * v_middle;
  f.v(y) += h * a;
  const State a_end = f.acceleration(t + h, y);
  f.v(y) = v_middle + h / 2 * a_end;
  if (!f.velocity_dependent()) work.carried = a_end;
}

double growth_verlet(Oscillator o) {
  return growth_of_map([o](Phase p) {
    const double a = pull(o, p.x, p.u);
    const double middle = p.u + a / 2;
    p.x += middle;
    return Phase{p.x, middle + pull(o, p.x, p.u + a) / 2};
  });
}

}  // namespace hooke::lab
