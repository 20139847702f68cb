#include "hooke/load/rest.h"

#include "hooke/text_of.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::app {

namespace {

constexpr int kCalmSteps = 3;                 ///< Steps on end that must be calm.
constexpr std::uint64_t kLooseInterval = 20;  ///< Steps between searches for what fell off.

/// Largest distance of any move [m].
double farthest(const std::vector<Move>& moves) {
  return moves.empty() ? 0 : length(moves.front().way);
}

/// Factor on the drift that counts as rest. What jitters or creeps, as large cloths do, is given up on late,
/// and its residual tells how near it came.
double leniency(std::uint64_t steps, std::uint64_t most) {
  if (3 * steps < most) return 1;
  return 10 * steps < 9 * most ? 100 : 1000;
}

/// Watches the kinetic energy for its peaks.
class Peaks {
 public:
  /// Takes the energy after a step [J]. Returns whether it fell after it had risen.
  bool passed(double kinetic) {
    const bool fell = kinetic < last_;
    const bool is_peak = fell && rising_;
    rising_ = !fell;
    last_ = is_peak ? 0 : kinetic;
    return is_peak;
  }

 private:
  double last_ = 0;
  bool rising_ = false;
};

}  // namespace

Relaxation::Relaxation(Simulation& simulation, Movers& movers, const Push& push)
    : simulation_(&simulation), movers_(&movers), push_(&push) {
  for (const SceneObject& object : simulation.objects()) {
    if (object.kind == SceneObject::Kind::kHook)
      hooks_[{object.hook.slot, object.hook.generation}] = object.name;
  }
}

std::vector<LoadBreak> Relaxation::take_breaks() {
  std::vector<LoadBreak> breaks;
  const Events& events = simulation_->world().events();
  for (const BreakEvent& event : events.breaks) {
    breaks.push_back({.object = hooks_[{event.hook.slot, event.hook.generation}],
                      .what = "hook",
                      .force = static_cast<double>(event.force)});
  }
  const auto name_of = [&](const auto& matches) {
    const auto objects = simulation_->objects();
    const auto found = std::find_if(objects.begin(), objects.end(), matches);
    return found == objects.end() ? std::string() : found->name;
  };
  for (const RopeBreakEvent& event : events.rope_breaks) {
    breaks.push_back({.object = name_of([&](const SceneObject& one) { return one.rope == event.rope; }),
                      .what = text_of("rope, segment %u", event.segment),
                      .force = static_cast<double>(event.force)});
  }
  for (const ClothTearEvent& event : events.tears) {
    breaks.push_back({.object = name_of([&](const SceneObject& one) { return one.cloth == event.cloth; }),
                      .what = text_of("cloth, point %u", event.point),
                      .force = static_cast<double>(event.strain)});
  }
  return breaks;
}

Result<RestOutcome> Relaxation::run(double load, const RestRules& rules) {
  using End = RestOutcome::End;
  World& world = simulation_->world();
  const auto dt = static_cast<double>(simulation_->scene().dt);
  const auto second = static_cast<std::uint64_t>(std::max(1.0, std::round(1 / dt)));
  const std::vector<DVec3> start = push_->places(world);
  RestOutcome outcome;
  Peaks peaks;
  Movers window = *movers_;  // marked once a second, to see drift
  window.mark(world);
  movers_->mark(world);
  for (int calm = 0; outcome.steps < rules.steps;) {
    if (auto pushed = push_->apply(world, load); !pushed) return pushed.error();
    if (!simulation_->step().moved) {
      return Error{ErrorCode::kOutOfRange, simulation_->scene().path, "the step did not move"};
    }
    ++outcome.steps;
    std::vector<LoadBreak> breaks = take_breaks();
    const bool broke = !breaks.empty();
    for (LoadBreak& one : breaks) outcome.breaks.push_back(std::move(one));
    const Unrest unrest = movers_->unrest(world, dt);
    outcome.residual = unrest.residual;
    if (broke && rules.ends_at_break) return outcome.end = End::kBroke, outcome;
    if (rules.way > 0 && push_->farthest(world, start) > rules.way) return outcome.end = End::kMoved, outcome;
    const bool at_rest = unrest.sum <= rules.residual && unrest.speed <= rules.speed && !broke;
    calm = at_rest ? calm + 1 : 0;
    if (calm >= kCalmSteps) return outcome.end = End::kRest, outcome;
    if (peaks.passed(unrest.kinetic)) movers_->stop(world);
    if (rules.way > 0 && outcome.steps % kLooseInterval == 0) {
      for (std::string& name : movers_->find_loose(*simulation_, push_->names(), rules.way))
        outcome.fell_off.push_back(std::move(name));
      window.set_loose(movers_->loose());
    }
    if (outcome.steps % second != 0) continue;
    if (farthest(window.moves(world)) <= rules.drift * leniency(outcome.steps, rules.steps))
      return outcome.end = End::kRest, outcome;
    window.mark(world);
  }
  return outcome;
}

}  // namespace hooke::app
