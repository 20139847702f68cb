#pragma once

#include <cstddef>

/// \file
/// Constants of groups of hooks that decide accuracy, robustness or cost. docs/tuning.md says how to try
/// another value.

namespace hooke::solver {

// Which hooks are solved as a whole, and what that may cost.

/// Multiplications for one solution of a group of hooks, about a millisecond. Groups that cost more become
/// iterative joints. Larger: large nets take long. Smaller: what could be exact has gaps, or diverged: a hub
/// of 60 hinges was over the budget as one body (docs/decisions/0008). No measurement of the value itself is
/// recorded.
inline constexpr double kArticulationBudget = 2e6;

/// How many times as much a tree may cost [ratio]: it costs in proportion to its hooks, and iterative joints
/// do worst on large stars. 2000 hinges on a hub take 1.5 ms for one substep (docs/decisions/0008).
inline constexpr double kTreeBudgetRatio = 10;

/// Ratio of the heaviest to the lightest body of a group, from which on its masses are unlike, and how many
/// times as much it may cost then [ratio]. Iterative joints yield most where masses are unlike: a net of 25 x
/// 25 balls with a body of 1000 times the mass in its middle gapes by 0.1 m in a second and by 0.03 mm as an
/// articulation, for 34 ms in place of 0.7. Smaller: such nets stretch. Larger: they take long.
inline constexpr double kUnlikeMasses = 10;
inline constexpr double kUnlikeBudgetRatio = 10;

/// Most hooks of a body in a loop that is not divided into links, and hooks of each such link. Larger: n
/// hooks of a body cost n^3 multiplications; from about 45 hinges on they were over the budget. Smaller: more
/// welds. Chosen by hand; no measurement is recorded.
inline constexpr int kMostUndividedHooks = 8;
inline constexpr int kHooksOfLink = 4;

/// Hooks of a body that iterative joints solve as they are. With each hook beyond that number the diagonal of
/// its rows is larger. Larger: sweeps that begin with the last impulses overshoot; 20 masses of 1 kg on a hub
/// of 1 kg diverge. Smaller: gaps close later (docs/decisions/0008).
inline constexpr int kMostFreeHooks = 5;

// How exactly trees and loops are solved.

/// Compliance of a loop's rows, as a share of each diagonal [ratio]. Smaller: what redundant rows ask for by
/// roundings drowns what bodies feel. Larger: a nearly straight row of planks sinks under its load, since its
/// tension is nearly unfelt (docs/decisions/0033).
inline constexpr double kLoopCompliance = 1e-8;

/// The same for what a child gives to a row of a tree, exact in double and approximate in float [ratio].
/// Smaller: it drowns in rounding. Larger: joints yield; with the second scenes/rain.json has a largest gap
/// of 0.50 mm in the mean of its steps. No measurement of the values themselves is recorded.
inline constexpr double kExactTreeCompliance = 1e-9;
inline constexpr double kApproximateTreeCompliance = 1e-5;

/// Fewest trees of one form that are solved in lanes. For fewer, one after another is faster.
inline constexpr std::size_t kFewestTreesForLanes = 2;

/// Fewest trees of a block that need another solution and stay in it; fewer move on to another block. A move
/// costs half a solution of a block. Larger: moving every tree that needs a second solution takes 4 % more
/// (docs/decisions/0017). Smaller: blocks solve for one tree.
inline constexpr int kFewestTreesThatStay = 3;

// Which trees are ragdolls, and how far they may be wrong.

/// Error of a lock in the last substep, from which on a ragdoll is not solved approximately [m] or [rad].
/// Larger: joints are seen to open. Smaller: more ragdolls are exact; with all of them exact a step of
/// scenes/rain.json takes 20 ms in place of 12 (docs/decisions/0023). No measurement of the value itself is
/// recorded.
inline constexpr double kApproximateError = 1e-3;

/// Largest ratio of the heaviest to the lightest body of a ragdoll [ratio]. Larger: trees of which load and
/// friction must be right count as ragdolls. Chosen by hand; no measurement is recorded.
inline constexpr double kApproximateMasses = 30;

/// Least speed of the viscous friction of a ragdoll's joints [m/s] or [rad/s]. What is held creeps by that at
/// most (docs/decisions/0023). Smaller: friction that is held asks for more than its bound in more solutions.
/// No measurement of the value itself is recorded.
inline constexpr double kApproximateSlide = 0.05;

/// Share of the speed before the joints that this speed is at least [ratio]. Zero: 7 % more solutions. A
/// half: 8 % less, but what is held creeps more (docs/decisions/0023).
inline constexpr double kApproximateJolt = 0.25;

/// How many times its friction a row of a ragdoll may ask for before it goes to its bound and the tree is
/// solved again [ratio]. At 1: 10 % more solutions (docs/decisions/0023).
inline constexpr double kApproximateFriction = 3;

/// Speed up to which limits of a ragdoll may be met, or let go, one substep late [m/s] or [rad/s]. Chosen by
/// hand; no measurement is recorded.
inline constexpr double kApproximateSpeed = 0.2;

// How much energy joints may add to what turns far.

/// Turn of a body, or of the line of a hook that keeps a distance, in a substep, from which on there is an
/// energy account [rad]. Smaller: with the account always on a hinge whose arm is tied to a jelly tore off.
/// Larger: of 1000 random worlds the velocities of 16 to 23 % overflowed without it (docs/decisions/0026). No
/// measurement of the value itself is recorded.
inline constexpr double kEnergyAccountTurn = 0.3;

/// Share of the kinetic energy that may have been added at any time [ratio], and speed that all bodies may
/// have for nothing [m/s]: 0.5 J for each kilogram. Larger: more energy from nothing. Smaller: what other
/// solvers give back is taken. No measurement of the values themselves is recorded.
inline constexpr double kEnergySlack = 0.02;
inline constexpr double kEnergyFreeSpeed = 1;

// Which hooks break together.

/// Rounds in which only the hooks give way that need most over what they can take. After that all do that
/// need too much. Smaller: what the weakest link would have spared breaks too. Chosen by hand; no measurement
/// is recorded.
inline constexpr int kMostBreakRounds = 16;

/// Need over that of the hook that needs most, from which on hooks give way together [ratio]. Chosen by hand;
/// no measurement is recorded.
inline constexpr double kAlikeInNeed = 0.999;

}  // namespace hooke::solver
