#pragma once

#include "solver/joint/articulations.h"

/// \file
/// Trees of which friction need not be exact: ragdolls.

namespace hooke::solver {

inline constexpr double kApproximateError =
    1e-3;  ///< Of a lock, from which on a tree is not loose [m or rad].
inline constexpr double kApproximateMasses =
    30;  ///< Ratio of the heaviest to the lightest, up to which it is.

/// Whether a tree is a ragdoll. Nothing hangs on it and it hangs on nothing: its root moves; its masses
/// differ by kLooseMasses at most; every joint rubs, and nothing drives one.
[[nodiscard]] bool is_ragdoll(const Articulation& tree, const std::vector<state::Hook>& hooks,
                              const state::Bodies& bodies);

/// Whether a ragdoll may be solved as a loose tree in this step: with viscous friction, limits that are met a
/// little late, and rows about the start of the substep only (wide/trees.h). In the last substep no lock was
/// off by kLooseError. It depends on the state alone, which a snapshot has: a tree is exact for as long as
/// its error asks for it.
[[nodiscard]] bool is_approximate(const Articulation& ragdoll, const std::vector<state::Hook>& hooks);

}  // namespace hooke::solver
