/// Tests the paper's "Runge-Kutta 4 is 40 times more stable than Euler, at 3 times the cost" by a table over
/// damping: the largest stable step of each, by bisection and by theory, on one mass and one spring. It
/// prints Markdown.
#include "hooke/lab.h"

#include <cstdio>

namespace {

/// Largest stable omega dt, measured and by theory; zeros if the laboratory refuses.
struct Limit {
  double measured = 0;
  double theory = 0;
};

Limit limit_of(const char* stepper, double zeta) {
  const auto measured = hooke::lab::largest_stable_step(stepper, zeta);
  const auto theory = hooke::lab::stable_step_in_theory(stepper, zeta);
  return {measured ? measured.value() : 0, theory ? theory.value() : 0};
}

}  // namespace

int main() {
  std::printf(
      "| zeta | euler omega dt | in theory | rk4 omega dt | in theory | ratio | 1.41 / zeta | paper | rk4 / "
      "paper |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (const double zeta : {0.005, 0.01, 0.02, 0.029, 0.035, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0}) {
    const Limit euler = limit_of("euler", zeta);
    const Limit rk4 = limit_of("rk4", zeta);
    const Limit paper = limit_of("paper", zeta);
    std::printf("| %g | %.5f | %.5f | %.4f | %.4f | %.1f | %.1f | %.4f | %.2f |\n", zeta, euler.measured,
                euler.theory, rk4.measured, rk4.theory, rk4.measured / euler.measured, 1.41421356 / zeta,
                paper.measured, rk4.measured / paper.measured);
  }
  const auto euler = hooke::lab::find_stepper("euler");
  const auto rk4 = hooke::lab::find_stepper("rk4");
  if (!euler || !rk4) return 1;
  std::printf("\nEvaluations of the forces per step: euler %d, rk4 %d.\n", euler.value().evaluations,
              rk4.value().evaluations);
  return 0;
}
