#pragma once

#include "hooke/math.h"

#include <limits>

/// \file
/// Constants of the rows of hooks that decide accuracy, robustness or cost. docs/tuning.md says how to try
/// another value.

namespace hooke::solver {

// How fast errors of hooks are taken back.

/// Largest speed of the correction of a lock, beyond that with which the ends move already [m/s] or [rad/s].
/// Larger: errors of bodies that turn far in a substep come back as speed, with which the next are larger
/// (docs/decisions/0026). Smaller: a body that was put away from its hook comes back later. No measurement of
/// the value itself is recorded.
inline constexpr double kJointPushSpeed = 10;

/// The same in coupled groups with contacts of two bodies, whatever the ends' speed: a lock that contacts
/// hold open [m/s] or [rad/s]. Larger: hooks pull bodies into walls with a force without bound, and friction
/// there turns it into speed, with which the errors grow: 5 m/s became 4e7 in ten substeps. No measurement of
/// the value itself is recorded.
inline constexpr double kJointPushInContact = 1;

/// Share of what is beyond a limit that a substep takes back [ratio], and largest speed of that [m/s] or
/// [rad/s]. Both are less than for locks because the bodies keep that speed. Chosen by hand; no measurement
/// is recorded.
inline constexpr double kJointLimitShare = 0.2;
inline constexpr double kJointLimitSpeed = 2;

/// Errors of a lock that count little, over its levers or as an angle [ratio]: some roundings of directions
/// kept in Reals. Smaller: redundant locks strain to remove roundings; hinges of 21 planks between two banks
/// held 1550 N across for 6600 N along once the scene was turned, with this value 150 N. Larger: errors stay.
inline constexpr double kLockRounding = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());

/// Frequency [Hz] and damping ratio of the locks of iterative joints, and the largest frequency in shares of
/// a substep, 0.25 / h [ratio]. They are those of soft contacts. Chosen by hand; no measurement is recorded.
inline constexpr double kLockHertz = 60;
inline constexpr double kLockDampingRatio = 5;
inline constexpr double kLockSubstepShare = 0.25;

/// Compliance of a hook row in a coupled group or on a rope, as a share of its diagonal [ratio]. Zero: loops
/// of rigid ropes leave the split of tension open; the trial needed 0.1 / m in float, in double a millionth
/// does (docs/decisions/0011). Larger: hooks stretch.
inline constexpr double kHookCompliance = 1e-6;

/// The same of joints between bodies in a coupled group. Larger: what redundant joints of a nearly straight
/// row of planks hold by tension alone gives way, since that is nearly unfelt; with 1e-6 a ton on planks of 4
/// kg sank by 1.5 mm. Smaller: sums of momentum drown in rounding (docs/decisions/0033).
inline constexpr double kCoupledJointCompliance = 1e-7;

// When a force on a lever turns a light body back so fast that it must be implicit.

/// Trace of h^2 S K S that is left explicit [ratio]. Larger: a chain of 16 x 1 kg under a ton explodes when
/// dropped, as it does with all of it explicit. Smaller: more solutions are repeated with a stiffness. No
/// measurement of the value itself is recorded.
inline constexpr double kStiffnessLeft = 0.5;

/// Share of the rest that acts on the velocity too [ratio]. Zero: that chain gains energy when swung. Larger:
/// with full implicit damping it would lose 4 % of its swing each second, as estimated (docs/decisions/0026).
inline constexpr double kStiffnessDamping = 0.2;

/// Growth of a stiffness beyond which a solution is repeated with it [ratio]. Chosen by hand; no measurement
/// is recorded.
inline constexpr double kStiffnessGrowth = 1.5;

// When rows are made anew about the end of the substep, and how often bounds are revised.

/// Turn in a substep from which on rows are not straight [rad]: a link that turns by that leaves the joint a
/// gap of the square of it. A chain of 16 kg under a ton, dropped from level, stretched by 0.16 % without new
/// rows and by 0.066 % with them. Smaller: more solutions. No measurement of the value itself is recorded.
inline constexpr double kBentRowsTurn = 0.03;

/// Gap of a joint over its levers, or its angle, from which on such rows are made anew [rad]. Chosen by hand;
/// no measurement is recorded.
inline constexpr double kBentRowsError = 2e-4;

/// Least lever against which a gap is compared [m]. Smaller: hooks at centers of mass have errors without
/// measure. Chosen by hand; no measurement is recorded.
inline constexpr double kLeastJointLever = 0.01;

/// How often free rows are solved anew while rows go to their bounds and are let go again. After that number
/// rows only go to their bounds. Larger: the friction of one axis went round up to eight times, so that a
/// tenth of the trees of scenes/rain.json took 9 to 11 solutions. Smaller: three without the rule that a row
/// is let go once are as fast, but gaps are 0.38 mm in place of 0.26 (docs/decisions/0017).
inline constexpr int kFreeBoundPasses = 4;

/// How often in all. Chosen by hand; no measurement is recorded.
inline constexpr int kMostBoundPasses = 16;

/// How often an articulation is solved with bounds in a substep, with rows or a stiffness made anew. Chosen
/// by hand; no measurement is recorded.
inline constexpr int kMostArticulationSolves = 4;

/// Speed at a bound that rounding leaves, so that the row stays there [m/s] or [rad/s]. Chosen by hand; no
/// measurement is recorded.
inline constexpr double kJointRoundingSpeed = 1e-9;

/// Least cosine of the second angle by which rates of the other two are divided, and least square of the like
/// sum for twist [ratio]: 87 degrees. Smaller: rates grow without bound as the axes fall together. Chosen by
/// hand; no measurement is recorded.
inline constexpr double kLeastAngleCosine = 0.05;

}  // namespace hooke::solver
