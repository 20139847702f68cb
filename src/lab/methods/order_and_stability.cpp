/// Measures orders and limits of stability, by experiment and by theory.

#include "base/float_environment.h"
#include "lab/methods/growth.h"
#include "lab/methods/method.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hooke::lab {

namespace {

Error out_of_range(const char* name, const char* accepted) {
  return {ErrorCode::kOutOfRange, name, std::string("must be ") + accepted};
}

Result<std::vector<DVec3>> end_of_run(const World& world, const Options& options, long long steps) {
  Result<Run> run = Run::create(world, options);
  if (!run) return run.error();
  for (long long i = 0; i < steps; ++i) {
    if (const Result<void> moved = run.value().advance(); !moved) return moved.error();
  }
  return run.value().positions();
}

double largest_distance(const std::vector<DVec3>& a, const std::vector<DVec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, length(a[i] - b[i]));
  return largest;
}

/// A straight chain in empty space, whose last mass was pushed along it so lightly that it stays linear.
struct Line {
  Chain chain;
  double stiffness = 0;  ///< [N/m]
  double damping = 0;    ///< [N s/m]
};

Result<World> make_world(const Line& line) {
  Result<World> world = World::create({.gravity = {}, .wind = {.air_density = Real(0)}});
  if (!world) return world;
  ParticlesDesc desc;
  desc.pins = {{}};
  for (int i = 0; i <= line.chain.springs; ++i) {
    ParticleDesc particle;
    particle.position = {static_cast<double>(i), 0, 0};
    particle.mass = static_cast<Real>(line.chain.mass);
    desc.particles.push_back(particle);
  }
  desc.particles.back().velocity = {static_cast<Real>(1e-6 / line.chain.dt), Real(0), Real(0)};
  for (int i = 0; i < line.chain.springs; ++i) {
    desc.springs.push_back({.a = static_cast<std::uint32_t>(i),
                            .b = static_cast<std::uint32_t>(i + 1),
                            .stiffness = static_cast<Real>(line.stiffness),
                            .damping = static_cast<Real>(line.damping)});
  }
  const Result<ParticlesId> added = world.value().add_particles(desc);
  if (!added) return added.error();
  return world;
}

constexpr double kMostGrowth = 1e8;  ///< Largest growth of the energy that is followed.

/// Returns the logarithm of the growth of the largest energy from the first quarter of a run to its last.
Result<double> growth_of_run(std::string_view stepper, const Line& line, int steps) {
  const Result<World> world = make_world(line);
  if (!world) return world.error();
  Result<Run> run =
      Run::create(world.value(), {.stepper = std::string(stepper), .dt = line.chain.dt, .force = true});
  if (!run) return run.error();
  double first = 0;
  double last = 0;
  // The run ends before the masses pass one another and the chain is no longer linear.
  const double most = kMostGrowth * run.value().energy().total();
  for (int i = 0; i < steps; ++i) {
    if (!run.value().advance()) return std::numeric_limits<double>::infinity();
    const double energy = run.value().energy().total();
    if (!(energy < most)) return std::numeric_limits<double>::infinity();
    if (i < steps / 4) first = std::max(first, energy);
    if (i >= steps - steps / 4) last = std::max(last, energy);
  }
  return first > 0 ? std::log(last / first) : 0.0;
}

/// Returns the largest value for which `grows` says no. It doubles from `start` up to `end`, then bisects in
/// the logarithm. The result is 0 if already `start` grows, and infinity if nothing does.
template <class Grows>
Result<double> bisect(double start, double end, Grows&& grows) {
  double low = start;
  double high = start;
  while (true) {
    const Result<bool> answer = grows(high);
    if (!answer) return answer.error();
    if (answer.value()) break;
    low = high;
    high *= 2;
    if (high > end) return std::numeric_limits<double>::infinity();
  }
  if (high == start) return 0.0;
  for (int i = 0; i < 12; ++i) {
    const double middle = std::sqrt(low * high);
    const Result<bool> answer = grows(middle);
    if (!answer) return answer.error();
    (answer.value() ? high : low) = middle;
  }
  return low;
}

Result<const Method*> method_for(std::string_view stepper) {
  const Method* method = find_method(stepper);
  if (method == nullptr) return unknown_method(stepper);
  return method;
}

Result<const Method*> method_for(std::string_view stepper, const Chain& chain) {
  if (chain.springs < 1 || chain.springs > 1024) return out_of_range("chain.springs", "1 to 1024");
  if (!(chain.mass >= 1e-6 && chain.mass <= 1e6)) return out_of_range("chain.mass", "1e-6 to 1e6");
  if (!(chain.dt >= 1e-6 && chain.dt <= 1e3)) return out_of_range("chain.dt", "1e-6 to 1000");
  return method_for(stepper);
}

}  // namespace

Result<OrderMeasurement> measure_order(const World& world, const Options& options, double seconds,
                                       int halvings) {
  const base::FloatEnvironment environment;
  if (!(seconds >= options.dt && seconds <= 1e6 * options.dt))
    return out_of_range("seconds", "one to a million times dt");
  if (halvings < 1 || halvings > 16) return out_of_range("halvings", "1 to 16");
  const long long coarsest = std::llround(seconds / options.dt);
  const auto with_steps = [&](long long steps) {
    Options finer = options;
    finer.dt = seconds / static_cast<double>(steps);
    finer.force = true;
    return finer;
  };
  const long long finest = (coarsest << halvings) * 8;
  Options best = with_steps(finest);
  best.stepper = "rk4";
  best.object_steppers.clear();
  best.accuracy.reset();
  const Result<std::vector<DVec3>> exact = end_of_run(world, best, finest);
  if (!exact) return exact.error();

  OrderMeasurement measured;
  for (int i = 0; i <= halvings; ++i) {
    const Options trial = with_steps(coarsest << i);
    const Result<std::vector<DVec3>> end = end_of_run(world, trial, coarsest << i);
    if (!end) return end.error();
    measured.dt.push_back(trial.dt);
    measured.error.push_back(largest_distance(end.value(), exact.value()));
  }
  const std::size_t n = measured.error.size();
  measured.order = std::log2(measured.error[n - 2] / measured.error[n - 1]);
  return measured;
}

Result<double> largest_stable_stiffness(std::string_view stepper, const Chain& chain) {
  const base::FloatEnvironment environment;
  if (const auto method = method_for(stepper, chain); !method) return method.error();
  constexpr int kSteps = 2000;
  const double unit = chain.mass / (chain.dt * chain.dt);
  // Methods that grow at any stiffness do so slowly: at omega dt = 0.1 by 1e-5 per step and more.
  const Result<double> slow = growth_of_run(stepper, {{1, chain.mass, chain.dt}, 0.01 * unit, 0}, 20000);
  if (!slow) return slow.error();
  if (slow.value() > 0.1) return 0.0;
  return bisect(0.02 * unit, 1e6 * unit, [&](double stiffness) -> Result<bool> {
    const Result<double> growth = growth_of_run(stepper, {chain, stiffness, 0}, kSteps);
    if (!growth) return growth.error();
    return growth.value() > std::log(10.0);
  });
}

Result<double> stable_stiffness_in_theory(std::string_view stepper, const Chain& chain) {
  const base::FloatEnvironment environment;
  const Result<const Method*> method = method_for(stepper, chain);
  if (!method) return method.error();
  const double limit = method.value()->info.imaginary_limit;
  const double n = chain.springs;
  const double sine = std::sin(std::numbers::pi * (2 * n - 1) / (4 * n + 2));
  return limit * limit * chain.mass / (chain.dt * chain.dt * 4 * sine * sine);
}

Result<double> largest_stable_step(std::string_view stepper, double zeta) {
  const base::FloatEnvironment environment;
  if (const auto method = method_for(stepper); !method) return method.error();
  if (!(zeta >= 0 && zeta <= 100)) return out_of_range("zeta", "0 to 100");
  constexpr int kSteps = 4000;
  // Growth of the energy that counts; the error of sampling an oscillation's maxima is smaller.
  constexpr double kSeen = 3e-3;
  return bisect(1e-3, 1e3, [&](double omega_dt) -> Result<bool> {
    const Chain one;
    const double omega = omega_dt / one.dt;
    const Line line = {one, omega * omega * one.mass, 2 * zeta * omega * one.mass};
    const Result<double> growth = growth_of_run(stepper, line, kSteps);
    if (!growth) return growth.error();
    return growth.value() > kSeen;
  });
}

Result<double> stable_step_in_theory(std::string_view stepper, double zeta) {
  const base::FloatEnvironment environment;
  const Result<const Method*> method = method_for(stepper);
  if (!method) return method.error();
  if (!(zeta >= 0 && zeta <= 100)) return out_of_range("zeta", "0 to 100");
  if (method.value()->growth == nullptr) return std::numeric_limits<double>::infinity();
  return stable_scale(method.value()->growth, 1, 2 * zeta);
}

}  // namespace hooke::lab
