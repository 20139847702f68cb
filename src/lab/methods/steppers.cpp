/// This is the table of methods, from which they are listed, refused and explained.

#include "base/float_environment.h"
#include "lab/methods/methods.h"

#include <cmath>
#include <limits>

namespace hooke::lab {

namespace {

Method fixed_step(std::string_view name, std::string_view title, int order, int evaluations, Step step,
                  Growth growth) {
  Method method;
  method.info = {.name = name, .title = title, .order = order, .evaluations = evaluations};
  method.info.implicit = evaluations == 0;
  method.info.imaginary_limit = stable_scale(growth, 1, 0);
  method.info.real_limit = stable_scale(growth, 0, 1);
  method.step = step;
  method.growth = growth;
  return method;
}

Method by_tolerance(std::string_view name, std::string_view title, bool implicit, Step step) {
  Method method;
  method.info = {
      .name = name, .title = title, .implicit = implicit, .adaptive = true, .available = kHasSundials};
  method.info.imaginary_limit = std::numeric_limits<double>::infinity();
  method.info.real_limit = std::numeric_limits<double>::infinity();
  method.step = step;
  return method;
}

std::vector<Method> make_methods() {
  return {
      fixed_step("euler", "Explicit Euler", 1, 1, step_euler, growth_euler),
      fixed_step("symplectic_euler", "Symplectic Euler", 1, 1, step_symplectic_euler,
                 growth_symplectic_euler),
      fixed_step("taylor2_paper", "The paper's eq. 5 to 7", 1, 1, step_taylor2_paper, growth_taylor2_paper),
      fixed_step("paper", "The paper's Listing 13", 1, 1, step_paper, growth_paper),
      fixed_step("taylor2", "Taylor 2", 2, 2, step_taylor2, growth_taylor2),
      fixed_step("taylor3", "Taylor 3", 3, 3, step_taylor3, growth_taylor3),
      fixed_step("heun", "Heun", 2, 2, step_heun, growth_heun),
      fixed_step("midpoint", "Midpoint", 2, 2, step_midpoint, growth_midpoint),
      fixed_step("verlet", "Velocity Verlet", 2, 1, step_verlet, growth_verlet),
      fixed_step("rk4", "Runge-Kutta 4", 4, 4, step_rk4, growth_rk4),
      fixed_step("ab2", "Adams-Bashforth 2", 2, 1, step_ab2, growth_ab2),
      fixed_step("ab3", "Adams-Bashforth 3", 3, 1, step_ab3, growth_ab3),
      fixed_step("ab4", "Adams-Bashforth 4", 4, 1, step_ab4, growth_ab4),
      fixed_step("implicit_euler", "Implicit Euler", 1, 0, step_implicit_euler, growth_implicit_euler),
      fixed_step("am2", "Adams-Moulton 2 (trapezoidal)", 2, 0, step_am2, growth_am2),
      fixed_step("am3", "Adams-Moulton 3", 3, 0, step_am3, growth_am3),
      fixed_step("am4", "Adams-Moulton 4", 4, 0, step_am4, growth_am4),
      fixed_step("bdf2", "Backward differentiation 2", 2, 0, step_bdf2, growth_bdf2),
      fixed_step("bdf3", "Backward differentiation 3", 3, 0, step_bdf3, growth_bdf3),
      fixed_step("bdf4", "Backward differentiation 4", 4, 0, step_bdf4, growth_bdf4),
      by_tolerance("adams_moulton", "Adams-Moulton, any order, by tolerance", true, step_adams_moulton),
      by_tolerance("bdf", "Backward differentiation, any order, by tolerance", true, step_bdf),
      by_tolerance("dormand_prince", "Dormand-Prince 5(4), by tolerance", false, step_dormand_prince),
  };
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> table = make_methods();
  return table;
}

const Method* find_method(std::string_view name) {
  for (const Method& method : methods()) {
    if (method.info.name == name) return &method;
  }
  return nullptr;
}

Error unknown_method(std::string_view name) {
  std::string message = "no stepper is called \"" + std::string(name) + "\"; there are auto";
  for (const Method& method : methods()) message += ", " + std::string(method.info.name);
  return {ErrorCode::kOutOfRange, "stepper", message};
}

std::span<const StepperInfo> steppers() {
  static const std::vector<StepperInfo> infos = [] {
    std::vector<StepperInfo> list;
    for (const Method& method : methods()) list.push_back(method.info);
    return list;
  }();
  return infos;
}

Result<StepperInfo> find_stepper(std::string_view name) {
  const Method* method = find_method(name);
  if (method == nullptr) return unknown_method(name);
  return method->info;
}

Result<double> growth_per_step(std::string_view stepper, double omega_dt, double zeta) {
  const base::FloatEnvironment environment;
  const Method* method = find_method(stepper);
  if (method == nullptr) return unknown_method(stepper);
  if (!(omega_dt >= 0 && zeta >= 0 && std::isfinite(omega_dt) && std::isfinite(zeta)))
    return Error{ErrorCode::kOutOfRange, "omega_dt, zeta", "must be finite and not negative"};
  if (method->growth == nullptr) return 0.0;
  return method->growth({omega_dt * omega_dt, 2 * zeta * omega_dt});
}

Result<double> growth_at(std::string_view stepper, std::complex<double> z) {
  const base::FloatEnvironment environment;
  const Method* method = find_method(stepper);
  if (method == nullptr) return unknown_method(stepper);
  if (!(std::isfinite(z.real()) && std::isfinite(z.imag())))
    return Error{ErrorCode::kOutOfRange, "z", "must be finite"};
  if (method->growth == nullptr) return 0.0;
  return method->growth({std::norm(z), -2 * z.real()});
}

}  // namespace hooke::lab
