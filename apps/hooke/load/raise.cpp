#include "hooke/load/raise.h"

#include "hooke/load/rest.h"
#include "hooke/text_of.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::app {

namespace {

// All are shares of the weight of what moves and of the load.
constexpr double kLoosestResidual = 1e-4;
constexpr double kTightestResidual = 3e-6;
constexpr double kResidualOfStep = 0.02;  ///< Of a step of the load.
constexpr double kDriftOfExtent = 1e-7;   ///< Of the extent, in a second.
constexpr double kFinest = 1e-7;          ///< Share of the weight below which steps are not halved.
constexpr double kFirstShare = 0.25;      ///< Of the weight, where all of it is too much at once.
constexpr double kMostGrowth = 2;         ///< A step of the load is at most twice the one before.

constexpr double kCoarseWays = 5;         ///< A step that can be halved may go so many times as far.
constexpr double kMechanismWay = 0.25;    ///< Of the extent, on the way to rest without load.
constexpr double kNarrowest = 0.6;        ///< Least step, as a share of the width that is asked for.
constexpr double kStepAfterBreak = 0.01;  ///< Of the load at which something broke.

/// Raises the load. It belongs to one call of raise_load.
class Raise {
 public:
  Raise(Simulation& simulation, Movers& movers, const Push& push, const RaiseOptions& options)
      : simulation_(simulation),
        movers_(movers),
        push_(push),
        options_(options),
        relaxation_(simulation, movers, push),
        extent_(movers.extent(simulation)) {
    raised_.members = find_members(simulation);
    const auto gravity = static_cast<double>(length(simulation.world().desc().gravity));
    raised_.weight = movers.mass() * gravity;
  }

  Result<Raised> run() {
    if (auto rest = settle(); !rest) return rest.error();
    double load = 0;
    double step = options_.first;
    bool grows = true;  // A step is tried once more after it was halved, before it grows again.
    while (!raised_.collapse && load < options_.most) {
      const double next = std::min(load + step, options_.most);
      const std::size_t breaks = raised_.breaks.size();
      auto reached = attempt(load, next);
      if (!reached) return reached.error();
      if (raised_.breaks.size() > breaks) {
        if (options_.until_break) break;
        step = std::max(kStepAfterBreak * next, finest(next));
      } else if (!reached.value()) {
        step = std::max(0.5 * (next - load), kNarrowest * finest(next));
      } else if (grows) {
        step = std::min(kMostGrowth * (next - load), std::max(next, options_.first));
      }
      grows = reached.value();
      if (reached.value()) load = next;
      if (options_.until_limit && is_beyond_limit()) break;
    }
    return std::move(raised_);
  }

 private:
  /// Width of an interval of loads that needs no halving [N].
  [[nodiscard]] double finest(double load) const {
    return std::max(options_.tolerance * load, kFinest * (raised_.weight + load));
  }

  [[nodiscard]] RestRules rules(double load, double step) const {
    const double scale = raised_.weight + load;
    const auto dt = static_cast<double>(simulation_.scene().dt);
    return {
        .residual = std::clamp(kResidualOfStep * step, kTightestResidual * scale, kLoosestResidual * scale),
        .speed = 1e-3 * std::max(extent_, 1e-3),
        .drift = kDriftOfExtent * extent_,
        .way = options_.way,
        .steps = static_cast<std::uint64_t>(std::max(1.0, options_.patience / dt)),
        .ends_at_break = true};
  }

  /// Whether a member yields or buckles now.
  [[nodiscard]] bool is_beyond_limit() const {
    const std::vector<MemberForce> forces = member_forces(simulation_, raised_.members);
    return std::any_of(forces.begin(), forces.end(),
                       [](const MemberForce& one) { return std::max(one.yielding, one.buckling) >= 1; });
  }

  void record(double load, const RestOutcome& outcome) {
    Equilibrium one = {.load = load,
                       .way = push_.place(simulation_.world()) - start_,
                       .residual = outcome.residual,
                       .steps = outcome.steps,
                       .forces = member_forces(simulation_, raised_.members)};
    raised_.largest_residual = std::max(raised_.largest_residual, one.residual);
    raised_.equilibria.push_back(std::move(one));
    held_ = simulation_.snapshot();
    if (first_break(raised_) == nullptr) raised_.whole = held_;
    loose_ = movers_.loose();
  }

  void note(double held, double load, RestOutcome& outcome) {
    for (LoadBreak& one : outcome.breaks) {
      one.held = held;
      one.load = load;
      raised_.breaks.push_back(std::move(one));
    }
    for (std::string& name : outcome.fell_off) raised_.fell_off.push_back(std::move(name));
  }

  void collapse(double held, double load, const RestOutcome& outcome) {
    const bool ran = outcome.end == RestOutcome::End::kMoved;
    raised_.collapse = {.ran = ran,
                        .held = held,
                        .load = load,
                        .why = ran ? text_of("the loaded place moved more than %.3g m", options_.way)
                                   : text_of("there was no rest in %.3g s", options_.patience),
                        .moves = movers_.moves(simulation_.world())};
  }

  /// Finds the equilibrium without load.
  Result<void> settle() {
    start_ = push_.place(simulation_.world());
    Movers start = movers_;
    start.mark(simulation_.world());
    auto outcome = settle_at_once();
    if (!outcome) return outcome.error();
    const bool rests = outcome.value().end == RestOutcome::End::kRest;
    raised_.settling = start.moves(simulation_.world());
    const std::vector<Move>& moves = raised_.settling;
    raised_.is_mechanism = !rests || (!moves.empty() && length(moves[0].way) > kMechanismWay * extent_);
    start_ = push_.place(simulation_.world());
    if (rests) {
      record(0, outcome.value());
    } else {
      collapse(0, 0, outcome.value());
    }
    return {};
  }

  [[nodiscard]] RestRules rules_without_load(bool ends_at_break) const {
    RestRules own = rules(0, 0);
    own.residual = kTightestResidual * raised_.weight;
    own.way = 0;
    own.ends_at_break = ends_at_break;
    return own;
  }

  Result<RestOutcome> settle_at_once() {
    const SimulationSnapshot start = simulation_.snapshot();
    auto outcome = relaxation_.run(0, rules_without_load(true));
    if (!outcome) return outcome;
    raised_.steps += outcome.value().steps;
    if (outcome.value().end != RestOutcome::End::kBroke) return outcome;
    if (auto restored = simulation_.restore(start); !restored) return restored.error();
    return settle_by_shares();
  }

  /// Where weight that comes all at once breaks something, it is raised like a load.
  Result<RestOutcome> settle_by_shares() {
    World& world = simulation_.world();
    const Vec3 gravity = world.desc().gravity;
    SimulationSnapshot held = simulation_.snapshot();
    double share = 0;
    for (double step = kFirstShare;;) {
      const double next = std::min(share + step, 1.0);
      const bool narrow = next - share <= options_.tolerance;
      if (auto set = world.set_gravity(static_cast<Real>(next) * gravity); !set) return set.error();
      auto outcome = relaxation_.run(0, rules_without_load(!narrow));
      if (!outcome) return outcome;
      raised_.steps += outcome.value().steps;
      if (narrow || outcome.value().end != RestOutcome::End::kBroke) {
        for (LoadBreak& one : outcome.value().breaks) one.share = next;
        note(0, 0, outcome.value());
        // What finds no rest under a part of its weight would find none under all of it.
        if (next >= 1 || outcome.value().end != RestOutcome::End::kRest) return outcome;
        held = simulation_.snapshot();
        share = next;
        step *= kMostGrowth;
      } else {
        if (auto restored = simulation_.restore(held); !restored) return restored.error();
        step = 0.5 * (next - share);
      }
    }
  }

  /// Tries to go from one load to the next. Returns whether that is done, or must be tried with less.
  Result<bool> attempt(double load, double next) {
    const RestRules with = rules(next, next - load);
    auto outcome = relaxation_.run(next, with);
    if (!outcome) return outcome.error();
    raised_.steps += outcome.value().steps;
    const bool narrow = next - load <= finest(next) * (1 + 1e-9);
    const bool rests = outcome.value().end == RestOutcome::End::kRest;
    if (rests && (narrow || !options_.until_limit || !is_beyond_limit())) {
      note(load, next, outcome.value());
      record(next, outcome.value());
      return true;
    }
    if (!narrow) {
      if (auto restored = simulation_.restore(held_); !restored) return restored.error();
      movers_.set_loose(loose_);
      return false;
    }
    if (outcome.value().end == RestOutcome::End::kBroke) return pass_break(load, next, outcome.value());
    note(load, next, outcome.value());
    collapse(load, next, outcome.value());
    return false;
  }

  /// Goes on from where something has broken, under the same load.
  Result<bool> pass_break(double load, double next, RestOutcome& broken) {
    note(load, next, broken);
    if (options_.until_break) return true;
    RestRules with = rules(next, next - load);
    with.ends_at_break = false;
    auto outcome = relaxation_.run(next, with);
    if (!outcome) return outcome.error();
    raised_.steps += outcome.value().steps;
    note(load, next, outcome.value());
    if (outcome.value().end == RestOutcome::End::kRest) {
      record(next, outcome.value());
      return true;
    }
    collapse(load, next, outcome.value());
    return false;
  }

  Simulation& simulation_;
  Movers& movers_;
  const Push& push_;
  RaiseOptions options_;
  Relaxation relaxation_;
  double extent_ = 0;
  DVec3 start_ = {};
  SimulationSnapshot held_ = {};  ///< The last equilibrium.
  std::vector<bool> loose_ = {};  ///< What was loose then.
  Raised raised_ = {};
};

}  // namespace

std::optional<LoadLimit> first_limit(const Raised& raised, double MemberForce::*ratio) {
  for (std::size_t e = 0; e < raised.equilibria.size(); ++e) {
    const Equilibrium& now = raised.equilibria[e];
    std::optional<LoadLimit> first;
    for (std::size_t i = 0; i < raised.members.size(); ++i) {
      const double used = now.forces[i].*ratio;
      if (!(used >= 1)) continue;
      LoadLimit limit = {
          .member = raised.members[i].name, .held = now.load, .load = now.load, .at = now.load};
      if (e > 0) {
        const Equilibrium& before = raised.equilibria[e - 1];
        const double was = before.forces[i].*ratio;
        limit.held = before.load;
        limit.at = before.load + (1 - was) / (used - was) * (now.load - before.load);
      }
      if (!first || limit.at < first->at) first = std::move(limit);
    }
    if (first) return first;
  }
  return {};
}

const Equilibrium& last_whole(const Raised& raised) {
  const LoadBreak* first = first_break(raised);
  const double held = first == nullptr ? 1e300 : first->held;
  std::size_t last = 0;
  for (std::size_t i = 0; i < raised.equilibria.size() && raised.equilibria[i].load <= held; ++i) last = i;
  return raised.equilibria[last];
}

const LoadBreak* first_break(const Raised& raised) {
  for (const LoadBreak& one : raised.breaks) {
    if (one.load > 0) return &one;
  }
  return nullptr;
}

Result<Raised> raise_load(Simulation& simulation, Movers& movers, const Push& push,
                          const RaiseOptions& options) {
  return Raise(simulation, movers, push, options).run();
}

}  // namespace hooke::app
