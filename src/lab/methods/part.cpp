#include "lab/methods/part.h"

#include "lab/methods/growth.h"
#include "lab/methods/methods.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hooke::lab {

namespace {

/// Growth per period that a method without any stable step may show before it is refused.
constexpr double kToleratedGrowth = 1.1;

double tolerated(const Method& method) {
  return method.info.imaginary_limit > 0 ? 1.0 : kToleratedGrowth;
}

bool is_stable(const Method& method, const Oscillation& o, double h) {
  if (method.growth == nullptr) return true;
  return is_stable(method.growth, {o.omega_squared * h * h, o.damping * h}, tolerated(method));
}

/// Returns the unstable oscillation that the method would let grow fastest, if there is one.
std::optional<Oscillation> worst(const System& system, const Method& method, double t, double h) {
  std::optional<Oscillation> result;
  double most = 0;
  for (const Oscillation& o : system.oscillations(t, system.initial_state())) {
    if (is_stable(method, o, h)) continue;
    const double growth = method.growth({o.omega_squared * h * h, o.damping * h});
    if (!(growth > most)) continue;
    most = growth;
    result = o;
  }
  return result;
}

Error diverges(const System& system, const Method& method, const Oscillation& o, double h) {
  const double omega = std::sqrt(o.omega_squared);
  const double limit = stable_scale(method.growth, omega, o.damping, tolerated(method));
  char text[320];
  const std::string name(method.info.name);
  if (limit > 0) {
    std::snprintf(text, sizeof(text), "%s is stable below dt = %.3g s with %s; dt is %.3g s",
                  system.row_name(o.row).c_str(), limit, name.c_str(), h);
  } else {
    std::snprintf(text, sizeof(text), "%s diverges at any dt with %s", system.row_name(o.row).c_str(),
                  name.c_str());
  }
  return {ErrorCode::kLimitExceeded, "stepper", text};
}

Error not_finite(const Part& part) {
  char text[160];
  std::snprintf(text, sizeof(text), "%s diverged: not finite after t = %.6g s", part.system.name().c_str(),
                part.time());
  return {ErrorCode::kLimitExceeded, std::string(part.method->info.name), text};
}

/// Coordinates of rotations (turn.h) can follow a step of up to about a radian.
Result<void> rotates_slowly(const Part& part) {
  if (!part.system.is_body()) return {};
  const double angle = length(part.system.body(part.start_time, part.y).spin) * part.h;
  if (!(angle > 1) || part.y.size() == 0) return {};
  char text[160];
  std::snprintf(text, sizeof(text), "turns by %.3g rad in a step of %.3g s; at most 1 can be followed", angle,
                part.h);
  return Error{ErrorCode::kOutOfRange, part.system.name(), text};
}

}  // namespace

Result<void> advance(Part& part) {
  if (part.y.size() == 0) {  // This happens when all points are held.
    ++part.outputs;
    return {};
  }
  const State before = part.y;
  const double start = part.time();
  for (int i = 0; i < part.steps_per_output; ++i) {
    if (const auto moved = take_steps(part, start + i * part.h, part.h, part.y); !moved) {
      part.y = before;
      part.steps -= static_cast<std::uint64_t>(i);
      part.work.reset();
      return moved.error();
    }
    if (push_out(part.system, part.bodies, part.y)) part.work.reset();
    if (part.system.lay_chart(part.y)) part.work.reset();
    ++part.steps;
  }
  ++part.outputs;
  return {};
}

Result<void> take_steps(Part& part, double t, double seconds, State& y) {
  if (y.size() == 0) return {};
  const double count = std::max(1.0, std::ceil(std::abs(seconds) / part.h * (1 - 1e-12)));
  const bool whole = seconds == count * part.h;
  if (!whole) part.work.reset();
  const double h = seconds / count;
  for (double i = 0; i < count; ++i) {
    part.method->step(part.system, t + i * h, h, y, part.work);
    if (!part.work.error && !(y.allFinite() && part.system.rotation_is_known(y)))
      part.work.error = not_finite(part);
    if (!part.work.error) continue;
    const Error error = *part.work.error;
    part.work.reset();
    part.work.error.reset();
    return error;
  }
  if (!whole) part.work.reset();
  return {};
}

Result<void> check(const Part& part, const Options& options) {
  const StepperInfo& info = part.method->info;
  const std::string name(info.name);
  if (!info.available) {
    return Error{ErrorCode::kUnsupported, "stepper",
                 name + " needs SUNDIALS, which this build does not have (Debian: libsundials-dev)"};
  }
  const bool taylor = part.method->step == step_taylor2 || part.method->step == step_taylor3;
  if (taylor && !part.system.differentiable()) {
    return Error{
        ErrorCode::kUnsupported, "stepper",
        name + " needs derivatives, which force laws and gusts of wind do not have: " + part.system.name()};
  }
  if (options.force || info.adaptive) return {};
  if (const Result<void> slow = rotates_slowly(part); !slow) return slow.error();
  if (info.implicit) return {};
  const auto grows = worst(part.system, *part.method, part.start_time, part.h);
  if (grows) return diverges(part.system, *part.method, *grows, part.h);
  return {};
}

const Method* automatic_method(const System& system, double start_time, double h) {
  if (system.ballistic()) return find_method("taylor2");
  if (worst(system, *find_method("rk4"), start_time, h)) return find_method("implicit_euler");
  double omega_squared = 0;
  for (const Oscillation& o : system.oscillations(start_time, system.initial_state()))
    omega_squared = std::max(omega_squared, o.omega_squared);
  const bool slow = omega_squared * h * h <= 0.25;
  return find_method(slow && !system.velocity_dependent() ? "verlet" : "rk4");
}

}  // namespace hooke::lab
