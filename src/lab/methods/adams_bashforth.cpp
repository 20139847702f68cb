#include "lab/methods/implicit.h"
#include "lab/methods/methods.h"

#include <algorithm>

namespace hooke::lab {

namespace {

constexpr double kAb2[] = {3.0 / 2, -1.0 / 2};
constexpr double kAb3[] = {23.0 / 12, -16.0 / 12, 5.0 / 12};
constexpr double kAb4[] = {55.0 / 24, -59.0 / 24, 37.0 / 24, -9.0 / 24};

/// Adams-Bashforth of p steps integrates the polynomial through the last p slopes over the next step.
///
/// y' = y + h (beta_1 f_n + beta_2 f_n-1 + ... + beta_p f_n-p+1)
///
/// The order is p with one evaluation per step; rk4 makes the first p - 1 steps. There is little stability:
/// without damping ab2 grows slowly at any step, ab3 is stable for omega h <= 0.72, ab4 for 0.43; on a decay
/// |lambda| h <= 1, 6/11, 3/10. Bashforth, Adams 1883; Hairer, Norsett, Wanner I, III.1.
void step_adams_bashforth(std::span<const double> beta, const System& f, double t, double h, State& y,
                          Workspace& work) {
  work.history.insert(work.history.begin(), f(t, y));
  if (work.history.size() < beta.size()) return start_up(f, t, h, y, work);
  work.history.resize(beta.size());
  for (std::size_t i = 0; i < beta.size(); ++i) y += h * beta[i] * work.history[i];
}

double growth_adams_bashforth(Oscillator o, std::span<const double> beta) {
  const double alpha[5] = {1, -1, 0, 0, 0};
  double explicit_beta[5] = {};
  std::copy(beta.begin(), beta.end(), explicit_beta + 1);
  const std::size_t terms = beta.size() + 1;
  return growth_of_multistep(o, {std::span(alpha).first(terms), std::span(explicit_beta).first(terms)});
}

}  // namespace

void step_ab2(const System& f, double t, double h, State& y, Workspace& work) {
  step_adams_bashforth(kAb2, f, t, h, y, work);
}
void step_ab3(const System& f, double t, double h, State& y, Workspace& work) {
  step_adams_bashforth(kAb3, f, t, h, y, work);
}
void step_ab4(const System& f, double t, double h, State& y, Workspace& work) {
  step_adams_bashforth(kAb4, f, t, h, y, work);
}

double growth_ab2(Oscillator o) {
  return growth_adams_bashforth(o, kAb2);
}
double growth_ab3(Oscillator o) {
  return growth_adams_bashforth(o, kAb3);
}
double growth_ab4(Oscillator o) {
  return growth_adams_bashforth(o, kAb4);
}

}  // namespace hooke::lab
