#pragma once

#include "hooke/math.h"

#include "solver/joint/articulations.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Hooks that break: docs/decisions/0029-hooks-that-break.md. Of what is solved as a whole, a hook that needs
/// more than it can take is put in series with a dashpot for the rest of that substep, and everything is
/// solved again, so that nobody else feels a blow that the hook cannot pass on. The dashpot is chosen so that
/// the hook takes what it can: with the relative speed s that is left where the hook takes nothing at all,
///
///   gamma = s / (h F),   which takes h F as s does not change, and less where it does.
///
/// and once more with the speed that is left then. A dashpot takes energy and never gives any, whatever the
/// speeds turn out to be. Then the hook is broken.

namespace hooke::solver {

/// What a solution says that a hook takes in a substep.
struct HookLoad {
  double impulse = 0;          ///< [N s]
  double angular_impulse = 0;  ///< [N m s]
};

/// Looks at the hooks of `rows` after a solution that gave load_of(hook row): of those that need too much,
/// the ones that need most give way; the dashpots of those that gave way before are set. `round` counts calls
/// in a substep of length h [s]. True if the solution must be repeated.
template <class LoadOf>
[[nodiscard]] bool give_way(double h, std::span<const std::uint32_t> rows, int round,
                            std::vector<state::Hook>& hooks, LoadOf&& load_of);

/// Bodies and hooks of articulations before a solution, to be solved again from.
class BreakScratch {
 public:
  void clear();
  /// Notes articulation `index` before it is solved.
  void note(std::uint32_t index, const Articulation& articulation, const JointTables& tables);
  /// After those that were noted have been solved: puts those back of which a hook gives way, and says which.
  std::span<const std::uint32_t> give_way(double h, const JointTables& tables);

 private:
  struct SavedBody {
    std::uint32_t row = 0;
    state::MotionRecord motion = {};
    state::FreeMotionRecord free_motion = {};
    Vec3 angular_momentum = {};
  };
  struct SavedHook {
    std::uint32_t row = 0;
    Vec3 impulse = {};
    Vec3 angular_impulse = {};
    std::array<Real, state::Hook::kMaxRows> row_impulse = {};
    std::array<double, 6> value = {};
    double energy_debt = 0;
    double spring_energy = 0;
  };
  struct Group {
    std::uint32_t articulation = 0;
    std::size_t first_body = 0, end_body = 0;
    std::size_t first_hook = 0, end_hook = 0;
    int round = 0;
    bool converged = false;
  };

  void put_back(const Group& group, const JointTables& tables) const;

  std::vector<Group> groups_;
  std::vector<SavedBody> bodies_;
  std::vector<SavedHook> hooks_;
  std::vector<std::uint32_t> rows_;  ///< As hooks_.
  std::vector<std::uint32_t> again_;
};

/// How many calls of give_way look for those that need most; after that, all that need too much give way.
inline constexpr int kMostBreakRounds = 16;
/// Those that need as much as the one that needs most, to this share, give way together.
inline constexpr double kAlikeInNeed = 0.999;

/// What a hook needs in a substep of length h [s], over what it can take.
[[nodiscard]] double need_of(const state::Hook& hook, const HookLoad& load, double h);

/// Lets a hook take nothing, and notes what it needed.
void let_go(double h, double need, const HookLoad& load, state::Hook& hook);

/// Sets the dashpot of a hook that gives way by the speed that is left, as the `load` says that it took with
/// the dashpot it had. False if it holds, or takes what it can.
bool set_dashpot(const HookLoad& load, state::Hook& hook);

template <class LoadOf>
bool give_way(double h, std::span<const std::uint32_t> rows, int round, std::vector<state::Hook>& hooks,
              LoadOf&& load_of) {
  bool set = false;
  for (const std::uint32_t row : rows) {
    set = set_dashpot(load_of(row), hooks[row]) || set;
  }
  if (set) return true;
  double most = 0;
  for (const std::uint32_t row : rows) most = std::max(most, need_of(hooks[row], load_of(row), h));
  if (!(most > 1)) return false;
  const double least = round < kMostBreakRounds ? std::max(1.0, kAlikeInNeed * most) : 1;
  for (const std::uint32_t row : rows) {
    const HookLoad load = load_of(row);
    const double need = need_of(hooks[row], load, h);
    if (need > 1 && need >= least) let_go(h, need, load, hooks[row]);
  }
  return true;
}

}  // namespace hooke::solver
