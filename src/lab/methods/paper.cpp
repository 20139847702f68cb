#include "lab/methods/methods.h"

namespace hooke::lab {

/// In the paper's Listing 13 the new velocity moves the position, and h^2 a / 2 moves it once more.
///
/// v' = v + h a(t, x, v),   x' = x + h v' + h^2 a / 2
///
/// It has order 1: in free fall it is g t h too far. It damps oscillations, det = 1 - (omega h)^2 / 2, and is
/// stable for omega h <= sqrt(2): one mass on one spring up to k = 2 m / h^2, 7200 N/m for 1 kg at 60 Hz.
void step_paper(const System& f, double t, double h, State& y, Workspace&) {
  const State a = f.acceleration(t, y);
  f.v(y) += h * a;
  f.x(y) += h * f.v(y) + h * h / 2 * a;
}

double growth_paper(Oscillator o) {
  return growth_of_map([o](Phase p) {
    const double a = pull(o, p.x, p.u);
    p.u += a;
    p.x += p.u + a / 2;
    return p;
  });
}

}  // namespace hooke::lab
