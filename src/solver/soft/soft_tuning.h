#pragma once

#include "hooke/math.h"

#include <cstddef>

/// \file
/// Constants of springs, solids and contacts of points that decide accuracy, robustness or cost.
/// docs/tuning.md says how to try another value.

namespace hooke::solver {

// How stiff, and how damped, rows may be.

/// Largest speed at which a rigid spring takes its error back [m/s]. Larger: without a bound a spring that is
/// 1 m off was closed in one substep, at 480 m/s with 8 substeps and 3.8 km/s with 64. Smaller: at 10 m/s
/// balls at 250 m/s go through the net of B-28.
inline constexpr Real kRigidSpringRecoverySpeed = Real(100);

/// The same for a tether [m/s]. It is too long only where its pin has jumped, or where others pull against
/// it. Larger: at 100 m/s points between two pins that are pulled apart shake at 250 m/s.
inline constexpr Real kTetherRecoverySpeed = Real(3);

/// Damping of a spring or bend counts up to the larger of these: a share of m / h, and a multiple of h k
/// [ratio]. Larger: a damper far beyond its spring is a lock on speed, and one pass over a sheet of locks
/// makes energy; of 10 000 random sheets 110 came beyond 30 to 50 m/s, with the bound 27. Smaller: what is
/// asked for is damped less. No measurement of the values themselves is recorded.
inline constexpr Real kMostDampingOfMass = Real(0.5);
inline constexpr Real kMostDampingOfStiffness = Real(10);

/// Solutions of a stiff solid in a substep, between which points are let go where they do not stay, and held
/// where they would pass; in as many more they are let go alone. Chosen by hand; no measurement is recorded.
inline constexpr int kMostPressedRounds = 8;

/// Most of its own mass that a point of a solid gets of what presses on it besides the body that holds it
/// [ratio]: that of the ground.
/// Smaller: with 1e3 the points of a jelly of 1 GPa moved into the ground, and it gained 80 times its energy.
/// Larger: rounding of what moves it gets larger.
inline constexpr double kMostMassShare = 1e9;

/// Share of the most friction up to which a point of a solid sticks at first to what presses on it [ratio].
/// Chosen by hand; no measurement is recorded.
inline constexpr Real kStickingShare = Real(0.95);

/// Drag of friction on a point of a solid, over the mass with which stress resists its motion, from which on
/// the point sticks [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr double kMostDragOfPoints = 1e4;

/// Change of the drag on a point of a solid, over the drag, from which on the solid is solved again
/// [ratio]. Without friction in the solution a jelly under 45 times its mass gained 2.5 % of its energy.
/// Chosen by hand; no measurement of the value is recorded.
inline constexpr double kFrictionError = 0.1;

/// Least compliance of a link of a yarn in a substep, over the inverse masses of its nodes [ratio]. Zero: a
/// rigid yarn between two pins has one link more than it has coordinates along it. Larger: rigid yarns give
/// way to what is heavier than a node by its inverse. Smaller: rigid yarns that contacts push tremble.
inline constexpr Real kLeastYarnSoftness = Real(1e-4);

/// Solutions of a yarn in a substep, at most, after the first: links that came out longer than their limit
/// are held at it in the next. Fewer: what is left over is longer than its limit for that substep.
inline constexpr int kMostYarnRounds = 4;

/// h^2 T (w_a + w_b) / l of a link of a yarn from which on its tension T acts on where its nodes are about to
/// be [ratio]. Larger: from 2 on nodes swing across the yarn without bound. Smaller: taut cloth that turns is
/// braked.
inline constexpr Real kLeastTautness = Real(0.5);

/// Length by which a link ends too long since it turns in a substep, over its length, above which its yarn is
/// solved again [ratio].
inline constexpr Real kYarnLengthTolerance = Real(0.002);

// How far solids flow.

/// det F_e below which nothing flows [ratio]: inside out, or pressed to a hundredth. Chosen by hand; no
/// measurement is recorded.
inline constexpr double kFlattestThatFlows = 0.01;

/// Square of the largest plastic stretch [ratio]: plastic stretches stay within [1/5, 5], and tetrahedra well
/// shaped (docs/decisions/0014). Chosen by hand; no measurement is recorded.
inline constexpr double kMostPlasticSquare = 25;

// Contacts of points, and between them.

/// Largest speed at which overlaps of particles, and of cloth elements, are undone in position [m/s]; in
/// ropes it bounds the push of a contact. Chosen by hand; no measurement is recorded.
inline constexpr double kParticlePushOutSpeed = 1;

/// Looks at which bodies would pass through elements, at most, in a particle substep; sweeps over those that
/// would, at most, between two looks; and the largest change of speed in a sweep, over that of the first, at
/// which sweeps end [ratio]. Fewer: what is not stopped is held back as a whole.
inline constexpr int kPassRounds = 8;
inline constexpr int kMostPassSweeps = 24;
inline constexpr Real kPassAccuracy = Real(0.01);

/// Sweeps over contacts of cloth elements. Chosen by hand; no measurement is recorded.
inline constexpr int kElementContactSweeps = 2;

// How copies of rows are grouped. It changes no result.

/// Most particles and rows of a group of several objects [1]. Larger: a change of one of them copies more
/// rows anew, at about 50 ns each. Smaller: more blocks are not full; with 16384, 200 cloths of 10 x 10
/// points took 4 % longer on AVX-512, and with 4096 a tenth.
inline constexpr std::size_t kMostRowsOfSharedGroup = 65536;

/// Objects that are copied anew join a group beside them that has at most so many times their particles and
/// rows [ratio]. Larger: adding small objects one by one copies the others more often. Smaller: it leaves
/// more groups.
inline constexpr std::size_t kLargestToJoin = 4;

}  // namespace hooke::solver
