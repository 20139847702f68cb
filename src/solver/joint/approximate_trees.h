#pragma once

#include "solver/joint/articulations.h"
#include "solver/joint/joint_tuning.h"

/// \file
/// Trees whose friction need not be exact: ragdolls.

namespace hooke::solver {

/// Whether a tree is a ragdoll. Nothing hangs on it and it hangs on nothing: its root moves. Its masses
/// differ by kApproximateMasses at most. Every joint has friction, and nothing drives one.
[[nodiscard]] bool is_ragdoll(const Articulation& tree, const std::vector<state::Hook>& hooks,
                              const state::Bodies& bodies);

/// Whether a ragdoll may be solved as an approximate tree in this step: with viscous friction, limits that
/// act a little late, and rows about the start of the substep only (solver/joint/tree_kernels.h). In the last
/// substep no lock was off by kApproximateError. It depends on the state alone, which a snapshot has: a tree
/// is exact for as long as its error demands it.
[[nodiscard]] bool is_approximate(const Articulation& ragdoll, const std::vector<state::Hook>& hooks);

}  // namespace hooke::solver
