#include "hooke/compare/trial.h"

#include "hooke/text_of.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace hooke::app {

namespace {

constexpr std::uint64_t kMostSamples = 4000;
constexpr int kLeastDivisor = 16;  // Least divisor of the reference's step.
constexpr int kMostDivisor = 4096;
constexpr double kFarAway = 10;             // Extents beyond which a run has diverged.
constexpr int kHalvings = 4;                // Halvings for the order.
constexpr double kOrderSeconds = 1;         // Longer runs measure chaos instead.
constexpr double kMostOrderWork = 4e7;      // Points times evaluations, which take half a minute.
constexpr double kMostReferenceWork = 1e8;  // The same for the reference.

/// Sums up wall time over calls.
class Stopwatch {
 public:
  template <class Call>
  auto time(const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    auto result = call();
    total_ += std::chrono::steady_clock::now() - start;
    return result;
  }
  [[nodiscard]] double milliseconds() const {
    return std::chrono::duration<double, std::milli>(total_).count();
  }

 private:
  std::chrono::steady_clock::duration total_ = {};
};

Sample sample_of(const Player& player, double time) {
  return {time, player.position(), player.energy(), 0};
}

/// Returns the largest distance of the object's points from the watched one, at the start.
double size_of(const Stage& stage) {
  double size = 0;
  for (const DVec3 p : stage.points) size = std::max(size, length(p - stage.points[stage.point]));
  return size;
}

double extent_of(const Stage& stage, const std::vector<Sample>& samples) {
  double extent = size_of(stage);
  for (const Sample& sample : samples) {
    extent = std::max(extent, length(sample.position - samples.front().position));
  }
  return extent > 0 ? extent : 1;
}

/// The watched point moves as `exact` says; all other points of the object are held.
void sample_exact(const ExactMotion& exact, const Stage& stage, const Schedule& schedule,
                  Reference& reference) {
  for (std::size_t i = 0; i * schedule.stride <= schedule.steps; ++i) {
    const double time = schedule.time(i);
    reference.samples.push_back({time, exact.position(time), exact.energy(time), 0});
  }
  for (std::uint64_t step = 0; step <= schedule.steps; step += schedule.frame_stride) {
    Frame frame = stage.points;
    frame[stage.point] = exact.position(static_cast<double>(step) * schedule.dt);
    reference.frames.push_back(std::move(frame));
  }
}

Result<Player> make_fine_player(const Stage& stage, int& divisor) {
  for (divisor = kLeastDivisor;; divisor *= 2) {
    auto player = make_player(stage, "rk4", stage.dt() / divisor, false);
    if (player || divisor >= kMostDivisor) return player;
  }
}

/// Does for the solver what lab::measure_order does: it compares with the reference at one time.
std::optional<lab::OrderMeasurement> measure_solver_order(const Stage& stage, const Schedule& schedule,
                                                          const Reference& reference) {
  const auto wanted =
      static_cast<std::size_t>(kOrderSeconds / (schedule.dt * static_cast<double>(schedule.stride)));
  if (reference.samples.size() < 2) return std::nullopt;
  const std::size_t sample = std::clamp<std::size_t>(wanted, 1, reference.samples.size() - 1);
  lab::OrderMeasurement order;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const int divisor = 1 << halving;
    const double dt = schedule.dt / divisor;
    auto player = make_player(stage, kSolverName, dt, false);
    if (!player) return std::nullopt;
    const std::uint64_t steps = sample * schedule.stride * static_cast<std::uint64_t>(divisor);
    for (std::uint64_t i = 0; i < steps; ++i) {
      if (!player.value().advance()) return std::nullopt;
    }
    order.dt.push_back(dt);
    order.error.push_back(length(player.value().position() - reference.samples[sample].position));
  }
  order.order = std::log2(order.error[kHalvings - 2] / order.error[kHalvings - 1]);
  return order;
}

template <class T>
std::optional<T> value_of(Result<T> result) {
  if (!result) return std::nullopt;
  return std::move(result).value();
}

std::optional<lab::OrderMeasurement> measure_lab_order(const Stage& stage, const lab::StepperInfo& info,
                                                       const Schedule& schedule) {
  const double seconds = std::min(kOrderSeconds, static_cast<double>(schedule.steps) * schedule.dt);
  const double points = static_cast<double>(stage.start.world().memory().particles);
  const double reference_steps = seconds / schedule.dt * 8 * (1 << (kHalvings - 1));
  if (info.adaptive || 4 * points * reference_steps > kMostOrderWork) return std::nullopt;
  return value_of(lab::measure_order(stage.start.world(),
                                     {.stepper = std::string(info.name), .dt = schedule.dt, .force = true},
                                     seconds, kHalvings));
}

}  // namespace

Schedule make_schedule(double seconds, double dt, std::uint64_t frames) {
  const auto steps = static_cast<std::uint64_t>(std::max(1LL, std::llround(seconds / dt)));
  return {.steps = steps,
          .stride = (steps + kMostSamples - 1) / kMostSamples,
          .frame_stride = (steps + frames - 1) / frames,
          .dt = dt};
}

Result<Reference> make_reference(const Stage& stage, const Schedule& schedule) {
  Reference reference;
  if (const auto exact = exact_motion(stage)) {
    reference.title = exact->title;
    sample_exact(*exact, stage, schedule, reference);
  } else {
    int divisor = 1;
    auto player = make_fine_player(stage, divisor);
    if (!player) return player.error();
    const auto points = static_cast<double>(player.value().points().size());
    if (4 * points * divisor * static_cast<double>(schedule.steps) > kMostReferenceWork) {
      return Error{
          ErrorCode::kUnsupported, "",
          text_of("the finest solution would take %llu steps of %.0f points; a shorter --seconds has one",
                  static_cast<unsigned long long>(schedule.steps) * static_cast<unsigned long long>(divisor),
                  points)};
    }
    reference.title = text_of("the finest solution, rk4 at dt/%d", divisor);
    Progress progress("reference", schedule.steps);
    reference.samples.push_back(sample_of(player.value(), 0));
    reference.frames.push_back(player.value().points());
    for (std::uint64_t step = 1; step <= schedule.steps; ++step) {
      for (int part = 0; part < divisor; ++part) {
        const auto done = player.value().advance();
        if (!done) return done.error();
      }
      if (step % schedule.stride == 0) {
        reference.samples.push_back(sample_of(player.value(), schedule.dt * static_cast<double>(step)));
      }
      if (step % schedule.frame_stride == 0) reference.frames.push_back(player.value().points());
      progress.show(step);
    }
  }
  reference.extent = extent_of(stage, reference.samples);
  return reference;
}

Reference no_reference(const Stage& stage, const std::string& why) {
  const double size = size_of(stage);
  return {.title = "", .samples = {}, .extent = size > 0 ? size : 1, .missing = why};
}

Result<Trial> run_trial(const Stage& stage, const std::string& name, bool force, const Schedule& schedule,
                        const Reference& reference) {
  auto made = make_player(stage, name, schedule.dt, force);
  if (!made) return made.error();
  Player& player = made.value();
  Trial trial = {.name = name, .samples = {}, .note = player.note};
  Stopwatch watch;
  Progress progress(name, schedule.steps);
  std::uint64_t step = 0;
  const auto record = [&] {
    const std::size_t i = trial.samples.size();
    Sample& sample = trial.samples.emplace_back(sample_of(player, schedule.time(i)));
    const bool known = i < reference.samples.size();
    sample.error = known ? length(sample.position - reference.samples[i].position)
                         : std::numeric_limits<double>::quiet_NaN();
    if (!known) return;
    trial.largest_error = std::max(trial.largest_error, sample.error);
    if (!(sample.error <= kFarAway * reference.extent)) trial.diverged_at = sample.time;
  };
  record();
  trial.frames.push_back(player.points());
  while (step < schedule.steps && !trial.diverged_at) {
    const Result<void> done = watch.time(player.advance);
    if (!done) {
      trial.diverged_at = static_cast<double>(step) * schedule.dt;
      trial.note = done.error().message;
      break;
    }
    if (++step % schedule.stride == 0) record();
    if (step % schedule.frame_stride == 0 && !trial.diverged_at) trial.frames.push_back(player.points());
    progress.show(step);
  }
  const double simulated = static_cast<double>(std::max<std::uint64_t>(step, 1)) * schedule.dt;
  trial.cost_ms = watch.milliseconds() / simulated;
  trial.evaluations = player.evaluations() / simulated;
  trial.collisions = player.collisions();
  if (reference.samples.empty()) trial.largest_error = std::numeric_limits<double>::quiet_NaN();
  return trial;
}

Limits measure_limits(const Stage& stage, const std::string& name, const Schedule& schedule,
                      const Reference& reference) {
  Limits limits;
  if (name == kSolverName) {
    limits.order = measure_solver_order(stage, schedule, reference);
    limits.order_in_theory = 1;
    return limits;
  }
  const auto info = lab::find_stepper(name);
  if (!info) return limits;
  limits.order_in_theory = info.value().order;
  limits.order = measure_lab_order(stage, info.value(), schedule);
  if (info.value().adaptive) return limits;
  const lab::Chain chain = {.dt = schedule.dt};
  limits.stiffness = value_of(lab::largest_stable_stiffness(name, chain));
  limits.stiffness_in_theory = value_of(lab::stable_stiffness_in_theory(name, chain));
  limits.step = value_of(lab::largest_stable_step(name, 0));
  limits.step_in_theory = value_of(lab::stable_step_in_theory(name, 0));
  return limits;
}

}  // namespace hooke::app
