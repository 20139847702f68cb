#include "hooke/load/rest.h"

#include "hooke/text_of.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::app {

namespace {

constexpr std::uint64_t kLooseInterval = 20;  ///< Steps between searches for what fell off.

/// Largest distance of any move [m].
double farthest(const std::vector<Move>& moves) {
  return moves.empty() ? 0 : length(moves.front().way);
}

}  // namespace

std::vector<LoadBreak> breaks_of(const Simulation& simulation) {
  std::vector<LoadBreak> breaks;
  const Events& events = simulation.world().events();
  const auto name_of = [&](const auto& matches) {
    const auto objects = simulation.objects();
    const auto found = std::find_if(objects.begin(), objects.end(), matches);
    return found == objects.end() ? std::string() : found->name;
  };
  for (const BreakEvent& event : events.breaks) {
    breaks.push_back({.object = name_of([&](const SceneObject& one) { return one.hook == event.hook; }),
                      .what = "hook",
                      .force = static_cast<double>(event.force)});
  }
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
  for (const SolidTearEvent& event : events.solid_tears) {
    breaks.push_back({.object = name_of([&](const SceneObject& one) { return one.solid == event.solid; }),
                      .what = text_of("solid, point %u", event.point),
                      .force = static_cast<double>(event.stress)});
  }
  return breaks;
}

Relaxation::Relaxation(Simulation& simulation, Movers& movers, const Push& push)
    : simulation_(&simulation), movers_(&movers), push_(&push) {}

Result<void> Relaxation::step(double load) {
  if (auto pushed = push_->apply(simulation_->world(), load); !pushed) return pushed;
  const StepReport stepped = simulation_->step();
  if (stepped.healthy()) return {};
  return Error{ErrorCode::kOutOfRange, simulation_->scene().path,
               stepped.moved ? "what moves is no longer finite: more --substeps, or heavier joints, may help"
                             : "the step did not move"};
}

bool Relaxation::settles(Attempt& attempt, const RestRules& rules) {
  World& world = simulation_->world();
  const auto dt = static_cast<double>(simulation_->scene().dt);
  const auto second = static_cast<std::uint64_t>(std::max(1.0, std::round(1 / dt)));
  const std::uint64_t steps = attempt.outcome.steps;
  const Unrest unrest = movers_->unrest(world, dt);
  attempt.outcome.residual = unrest.residual;
  const RestWatch::Verdict verdict = attempt.watch.observe(unrest, attempt.broke);
  if (verdict == RestWatch::Verdict::kAtRest) return true;
  if (verdict == RestWatch::Verdict::kPeak) movers_->stop(world);
  if (rules.way > 0 && steps % kLooseInterval == 0) {
    for (std::string& name : movers_->find_loose(*simulation_, push_->names(), rules.way))
      attempt.outcome.fell_off.push_back(std::move(name));
    attempt.second.set_loose(movers_->loose());
  }
  if (steps % second != 0) return false;
  if (attempt.watch.is_still(farthest(attempt.second.moves(world)))) return true;
  attempt.second.mark(world);
  return false;
}

Result<RestOutcome> Relaxation::run(double load, const RestRules& rules) {
  using End = RestOutcome::End;
  const World& world = simulation_->world();
  const std::vector<DVec3> start = push_->places(world);
  movers_->mark(world);
  Attempt attempt = {
      .outcome = {},
      .watch = RestWatch(
          {.residual = rules.residual, .speed = rules.speed, .drift = rules.drift, .steps = rules.steps}),
      .second = *movers_};
  RestOutcome& outcome = attempt.outcome;
  while (outcome.steps < rules.steps) {
    if (auto stepped = step(load); !stepped) return stepped.error();
    ++outcome.steps;
    std::vector<LoadBreak> breaks = breaks_of(*simulation_);
    attempt.broke = !breaks.empty();
    for (LoadBreak& one : breaks) outcome.breaks.push_back(std::move(one));
    if (attempt.broke && rules.ends_at_break) return outcome.end = End::kBroke, outcome;
    if (rules.way > 0 && push_->farthest(world, start) > rules.way) return outcome.end = End::kMoved, outcome;
    if (settles(attempt, rules)) return outcome.end = End::kRest, outcome;
  }
  return outcome;
}

}  // namespace hooke::app
