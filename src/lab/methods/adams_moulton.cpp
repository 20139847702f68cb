#include "lab/methods/implicit.h"
#include "lab/methods/methods.h"

namespace hooke::lab {

namespace {

constexpr double kAm2[] = {1.0 / 2, 1.0 / 2};
constexpr double kAm3[] = {5.0 / 12, 8.0 / 12, -1.0 / 12};
constexpr double kAm4[] = {9.0 / 24, 19.0 / 24, -5.0 / 24, 1.0 / 24};

/// Adams-Moulton of order p integrates the polynomial through the last p - 1 slopes and the unknown one.
///
/// y' = y + h (beta_0 f(t + h, y') + beta_1 f_n + ... + beta_p-1 f_n-p+2)
///
/// rk4 makes the first p - 2 steps, and Newton's method all others (lab/methods/implicit.h). am2 is the
/// trapezoidal rule: stable at any step, |R| = 1 without damping. am3 and am4 grow slowly without damping; on
/// a decay they are stable for |lambda| h <= 6 and 3. Moulton 1926; Hairer, Norsett, Wanner I, III.1.
void step_adams_moulton_of(std::span<const double> beta, const System& f, double t, double h, State& y,
                           Workspace& work) {
  work.history.insert(work.history.begin(), f(t, y));
  if (work.history.size() + 1 < beta.size()) return start_up(f, t, h, y, work);
  work.history.resize(beta.size() - 1);
  State known = y;
  for (std::size_t i = 1; i < beta.size(); ++i) known += h * beta[i] * work.history[i - 1];
  solve_implicit(f, t + h, h * beta[0], known, y, work);
}

double growth_adams_moulton(Oscillator o, std::span<const double> beta) {
  const double alpha[4] = {1, -1, 0, 0};
  return growth_of_multistep(o, {std::span(alpha).first(beta.size()), beta});
}

}  // namespace

void step_am2(const System& f, double t, double h, State& y, Workspace& work) {
  step_adams_moulton_of(kAm2, f, t, h, y, work);
}
void step_am3(const System& f, double t, double h, State& y, Workspace& work) {
  step_adams_moulton_of(kAm3, f, t, h, y, work);
}
void step_am4(const System& f, double t, double h, State& y, Workspace& work) {
  step_adams_moulton_of(kAm4, f, t, h, y, work);
}

double growth_am2(Oscillator o) {
  return growth_adams_moulton(o, kAm2);
}
double growth_am3(Oscillator o) {
  return growth_adams_moulton(o, kAm3);
}
double growth_am4(Oscillator o) {
  return growth_adams_moulton(o, kAm4);
}

}  // namespace hooke::lab
