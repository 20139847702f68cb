#include "lab/methods/implicit.h"
#include "lab/methods/methods.h"

namespace hooke::lab {

namespace {

constexpr double kBdf2[] = {3.0 / 2, -2, 1.0 / 2};
constexpr double kBdf3[] = {11.0 / 6, -3, 3.0 / 2, -1.0 / 3};
constexpr double kBdf4[] = {25.0 / 12, -4, 3, -4.0 / 3, 1.0 / 4};

/// In backward differentiation of order p the slope at the end is that of the polynomial through the last p
/// states and the unknown one.
///
/// alpha_0 y' + alpha_1 y_n + ... + alpha_p y_n-p+1 = h f(t + h, y')
///
/// rk4 makes the first p - 1 steps, and Newton's method all others (lab/methods/implicit.h). It suits stiff
/// and damped motion: bdf2 is stable at any step; bdf3 and bdf4 let undamped oscillations of medium omega h
/// grow. Order 1 is implicit_euler. Curtiss, Hirschfelder 1952; Hairer, Wanner II, V.1.
void step_bdf_of(std::span<const double> alpha, const System& f, double t, double h, State& y,
                 Workspace& work) {
  work.history.insert(work.history.begin(), y);
  if (work.history.size() + 1 < alpha.size()) return start_up(f, t, h, y, work);
  work.history.resize(alpha.size() - 1);
  State known = State::Zero(y.size());
  for (std::size_t i = 1; i < alpha.size(); ++i) known -= alpha[i] / alpha[0] * work.history[i - 1];
  solve_implicit(f, t + h, h / alpha[0], known, y, work);
}

double growth_bdf_of(Oscillator o, std::span<const double> alpha) {
  const double beta[5] = {1, 0, 0, 0, 0};
  return growth_of_multistep(o, {alpha, std::span(beta).first(alpha.size())});
}

}  // namespace

void step_bdf2(const System& f, double t, double h, State& y, Workspace& work) {
  step_bdf_of(kBdf2, f, t, h, y, work);
}
void step_bdf3(const System& f, double t, double h, State& y, Workspace& work) {
  step_bdf_of(kBdf3, f, t, h, y, work);
}
void step_bdf4(const System& f, double t, double h, State& y, Workspace& work) {
  step_bdf_of(kBdf4, f, t, h, y, work);
}

double growth_bdf2(Oscillator o) {
  return growth_bdf_of(o, kBdf2);
}
double growth_bdf3(Oscillator o) {
  return growth_bdf_of(o, kBdf3);
}
double growth_bdf4(Oscillator o) {
  return growth_bdf_of(o, kBdf4);
}

}  // namespace hooke::lab
