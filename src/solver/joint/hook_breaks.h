#pragma once

#include "hooke/math.h"

#include "solver/joint/articulations.h"
#include "solver/joint/joint_tuning.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Hooks that break: docs/decisions/0029-hooks-that-break.md. Where joints are solved as a whole, a hook that
/// needs more than it can take is put in series with a dashpot for the rest of that substep. Then everything
/// is solved again, so that no other part feels an impulse that the hook cannot pass on. The dashpot is
/// chosen so that the hook takes what it can. With the relative speed s that is left where the hook takes
/// nothing at all, it is
///
///   gamma = s / (h F),   which takes h F if s does not change, and less if it does,
///
/// and it is set once more with the speed that is left then. A dashpot takes energy and never gives any,
/// whatever the speeds turn out to be. Then the hook is broken.

namespace hooke::solver {

/// What a hook takes in a substep, by a solution.
struct HookLoad {
  double impulse = 0;          ///< [N s]
  double angular_impulse = 0;  ///< [N m s]
};

/// Sets the dashpots of the hooks of `rows` that gave way before, after a solution that gave load_of(hook
/// row). True if the solution must be repeated.
template <class LoadOf>
bool set_dashpots(std::span<const std::uint32_t> rows, std::vector<state::Hook>& hooks, LoadOf&& load_of);

/// What the weakest of the hooks of `rows` needs in a substep of length h [s] over what it can take.
template <class LoadOf>
[[nodiscard]] double most_need(double h, std::span<const std::uint32_t> rows,
                               const std::vector<state::Hook>& hooks, LoadOf&& load_of);

/// Lets the hooks give way that need too much. In the first rounds only those do that need about `most`.
template <class LoadOf>
void let_most_go(double h, std::span<const std::uint32_t> rows, int round, double most,
                 std::vector<state::Hook>& hooks, LoadOf&& load_of);

/// All of this: of the hooks that need too much, those that need most give way. `round` counts calls in a
/// substep of length h [s]. True if the solution must be repeated.
template <class LoadOf>
[[nodiscard]] bool give_way(double h, std::span<const std::uint32_t> rows, int round,
                            std::vector<state::Hook>& hooks, LoadOf&& load_of);

/// State of bodies and hooks of articulations before a solution, from which they can be solved again.
class BreakScratch {
 public:
  void clear();
  /// Saves the state of articulation `index` before it is solved.
  void note(std::uint32_t index, const Articulation& articulation, const JointTables& tables);
  /// Called after the saved articulations have been solved. Puts back those of which a hook gives way, and
  /// returns them.
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
  std::vector<std::uint32_t> rows_;  ///< Rows of `hooks_`.
  std::vector<std::uint32_t> again_;
};

/// What a hook needs in a substep of length h [s], divided by what it can take.
[[nodiscard]] double need_of(const state::Hook& hook, const HookLoad& load, double h);

/// Makes a hook take nothing, and notes what it needed.
void let_go(double h, double need, const HookLoad& load, state::Hook& hook);

/// Sets the dashpot of a hook that gives way by the speed that is left. That speed follows from the `load`
/// that the hook took with its old dashpot. False if the hook holds, or takes what it can.
bool set_dashpot(const HookLoad& load, state::Hook& hook);

template <class LoadOf>
bool set_dashpots(std::span<const std::uint32_t> rows, std::vector<state::Hook>& hooks, LoadOf&& load_of) {
  bool set = false;
  for (const std::uint32_t row : rows) {
    set = set_dashpot(load_of(row), hooks[row]) || set;
  }
  return set;
}

template <class LoadOf>
double most_need(double h, std::span<const std::uint32_t> rows, const std::vector<state::Hook>& hooks,
                 LoadOf&& load_of) {
  double most = 0;
  for (const std::uint32_t row : rows) most = std::max(most, need_of(hooks[row], load_of(row), h));
  return most;
}

template <class LoadOf>
void let_most_go(double h, std::span<const std::uint32_t> rows, int round, double most,
                 std::vector<state::Hook>& hooks, LoadOf&& load_of) {
  const double least = round < kMostBreakRounds ? std::max(1.0, kAlikeInNeed * most) : 1;
  for (const std::uint32_t row : rows) {
    const HookLoad load = load_of(row);
    const double need = need_of(hooks[row], load, h);
    if (need > 1 && need >= least) let_go(h, need, load, hooks[row]);
  }
}

template <class LoadOf>
bool give_way(double h, std::span<const std::uint32_t> rows, int round, std::vector<state::Hook>& hooks,
              LoadOf&& load_of) {
  if (set_dashpots(rows, hooks, load_of)) return true;
  const double most = most_need(h, rows, hooks, load_of);
  if (!(most > 1)) return false;
  let_most_go(h, rows, round, most, hooks, load_of);
  return true;
}

}  // namespace hooke::solver
