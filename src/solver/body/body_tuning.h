#pragma once

#include "hooke/math.h"

/// \file
/// Constants of the motion of bodies that decide accuracy, robustness or cost. docs/tuning.md says how to try
/// another value.

namespace hooke::solver {

// How a body turns freely within a substep: side by side by the midpoint rule, or by exact turns.

/// Largest turn of a substep, times the ratio of the largest to the least principal inertia, with which the
/// iteration of the midpoint rule converges at once [rad]. Faster bodies are turned by exact turns, one after
/// the other. Larger: thin bodies above some 100 rad/s gain energy, one capsule 3e11-fold in a step
/// (docs/decisions/0006). Smaller: fewer bodies are turned side by side, which took substeps of
/// scenes/rain.json from 13.3 to 12.2 ms. No measurement of the value itself is recorded.
inline constexpr Real kMidpointTurn = Real(0.1);

/// Number of iterations of the midpoint rule. It goes with kMidpointTurn: for faster turns as many would not
/// converge. Chosen by hand; no measurement is recorded.
inline constexpr int kMidpointIterations = 3;

/// Error of the rotational energy after exact turns that is left, as a share of it [ratio]. Smaller: rounding
/// is corrected too, and the root of a square's rounding error spun a ladder, which leaned at rest, about its
/// own axis (check V50). Larger: bodies keep the error of the exact turns, 2 % at 500 rad/s and 20 times the
/// energy above 5000 rad/s (docs/decisions/0006). No measurement of the value itself is recorded.
inline constexpr double kTurnEnergyTolerance = 1e-4;

// When rows no longer know a body's inertia, so that it is frozen for the step or L is kept from gaining
// energy.

/// Turn within a step below which a body's inertia is not tested [rad]. Chosen by hand; no measurement is
/// recorded.
inline constexpr Real kOtherInertiaTurn = Real(0.02);

/// Trace of S_now S_start^-1 squared, above which a body outgrows its rows [ratio]: it is 1 + r + 1/r, with
/// r = 2, where an impulse does twice what rows know. Larger: rods that spin about their own axis and are
/// tipped over ask for impulses up to 380 times too large (docs/decisions/0006, 0026). Smaller: more bodies
/// get a frozen inertia, and angular momentum is not kept in the step of an impact.
inline constexpr Real kOutgrownResponse = Real(3.5);

/// Rotational energy that rows know, over that of the angular momentum, from which on an impact has turned
/// the body over within the substep, and its inertia is frozen [ratio]. Chosen by hand; no measurement is
/// recorded.
inline constexpr Real kOtherMotionEnergy = Real(2);

/// The farthest turn that a body on hooks is foreseen to make in a substep [rad]. After half a turn all is as
/// it was, so that a larger angle would show less change of the inertia, not more.
inline constexpr Real kForeseenTurn = Real(1.5);

/// Turn in a substep from which on the angular momentum may have no more energy than before [rad]. Larger:
/// the angular momentum and the turn that joints and contacts left may disagree by the ratio of the inertias,
/// a hundred for a rod (docs/decisions/0026). Smaller: it acts where the two agree well enough. No
/// measurement of the value itself is recorded.
inline constexpr Real kEnergyKeepingTurn = Real(0.5);

}  // namespace hooke::solver
