#pragma once

#include "hooke/math.h"

#include <cstdint>

/// \file
/// Constants of contacts and impacts of bodies that decide accuracy, robustness or cost. docs/tuning.md says
/// how to try another value.

namespace hooke::solver {

// Soft contacts: how fast overlaps leave, and where friction acts.

/// Largest speed at which a soft contact pushes an overlap apart, and least limit of speeds in a dense pile
/// [m/s]. Larger: what begins deep inside each other is thrown; without the limit a thousand bodies at one
/// point left at 104 m/s with 94 times the energy of being pushed out, with it they never exceed 3.1 m/s.
/// Smaller: deep overlaps stay for longer. No measurement of the value itself is recorded.
inline constexpr Real kContactPushOutSpeed = Real(3);

/// Gap up to which a point counts fully for the place where the friction of its manifold acts, and gap from
/// which on it does not count [m]. The second is the margin within which the narrow phase keeps points.
/// Chosen by hand; no measurement is recorded.
inline constexpr Real kFrictionFullGap = Real(0.005);
inline constexpr Real kFrictionNoGap = Real(0.02);

/// Weight that a point has for that place at any gap, so that a mean exists where none is near [ratio].
/// Larger: points that do not touch draw friction away from those that do. Smaller: rounding decides the mean
/// of distant points. Chosen by hand; no measurement is recorded.
inline constexpr Real kFrictionLeastWeight = Real(1e-4);

// Direct islands: how stiff their rows are, and how overlaps leave.

/// D: impulse per rate of a row, over its effective mass [ratio]. Smaller: with 1e2 or 1e3 Newton steps are
/// few, but a column of 100 boxes sways by centimeters and a top of 10 000 times the mass sinks
/// (docs/decisions/0007). Larger: no measurement is recorded.
inline constexpr double kDirectStiffness = 1e5;

/// The same where no solution was found with kDirectStiffness: the last attempt before sweeps [ratio]. Chosen
/// by hand; no measurement is recorded.
inline constexpr double kDirectSofterStiffness = 1e2;

/// Overlap, or gap, that counts as none, over the radius of the smaller body [ratio]. Smaller: rounding moves
/// impulses from point to point (docs/decisions/0007). Larger: bodies rest that much inside each other.
inline constexpr double kDirectSlop = 1e-5;

/// Share of an overlap that a step removes, by displacement alone [ratio]. Pushed out by velocity, a heavy
/// top would keep the speed (docs/decisions/0007). Chosen by hand; no measurement is recorded.
inline constexpr double kDirectPushOut = 0.5;

/// Largest displacement of that kind in a step [m]. Chosen by hand; no measurement is recorded.
inline constexpr double kDirectLargestPush = 0.05;

// Direct islands: when a solution is found, and how long it is searched for.

/// Largest gradient of a solution, over the largest change of a velocity by contacts [ratio]. Chosen by hand;
/// no measurement is recorded.
inline constexpr double kDirectTolerance = 1e-7;

/// Newton steps in a round of friction, and in the first attempt, which starts from what held in the substep
/// before. At rest one is enough; with poor steps each ends at the next of hundreds of kinks
/// (docs/decisions/0007). Chosen by hand; no measurement is recorded.
inline constexpr int kDirectNewtonSteps = 12;
inline constexpr int kDirectQuickSteps = 3;

/// The same where something lies on what is much lighter (kHeavyOnLightRatio). Only the first substeps take
/// so many. Smaller: with 12, a pyramid of 14 rows under 1000 times the mass of a box sank by 0.6 mm first.
/// Larger: for all islands, 60 made the slowest steps of `pile` 1.25 times as long.
inline constexpr int kDirectHeavyNewtonSteps = 60;

/// Multiplications of all factorizations of an island in a step, some 5 ms, beyond which it costs too much,
/// and the multiple of that with which the search for a solution ends where its bodies rest [ratio]: what has
/// just been put up needs many in its first step. Smaller: a pyramid of 14 rows under 1000 times the mass of
/// a box is swept in its first step, and sinks by 84 mm. Larger: light leaves under a heavy plate in
/// scenes/suction.json took 37 ms a step.
inline constexpr double kDirectStepBudget = 1e7;
inline constexpr double kDirectRestingBudget = 5;

/// Halvings of the interval in which the least energy along a Newton step is searched for. Chosen by hand; no
/// measurement is recorded.
inline constexpr int kDirectSearchSteps = 20;

/// Slope of the energy at the end of a Newton step, over that at its start, up to which the whole step is
/// taken without a search [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr double kDirectSearchTolerance = 1e-3;

/// Rounds of friction, each with limits by the loads of the round before. Chosen by hand; no measurement is
/// recorded.
inline constexpr int kDirectFrictionRounds = 3;

/// Share of its limit from which on friction slid in the last substep [ratio]. Chosen by hand; no measurement
/// is recorded.
inline constexpr double kDirectSticking = 0.999;

/// Change of a load, as a share of it, below which sliding friction is not solved again [ratio]. Chosen by
/// hand; no measurement is recorded.
inline constexpr double kDirectSameLoad = 0.01;

/// Sweeps row by row where no attempt finds a solution. They gain no energy. A house of cards of four storeys
/// needs them in 15 of its first 2400 substeps and never later (docs/decisions/0007). Chosen by hand; no
/// measurement is recorded.
inline constexpr int kDirectSweeps = 8;

// Impacts: what bounces.

/// Slower impacts do not bounce [m/s]. Larger: with 0.2 a ball with e = 0.8 rests 0.15 s too early
/// (docs/decisions/0018). Smaller: what nearly rests has more impacts.
inline constexpr Real kLeastImpactSpeed = Real(0.03);

/// The same in dense piles [m/s]. Smaller: 4096 boxes with e = 0.5 that fall into a bin have 23 000 impacts a
/// step, nearly all below this speed, and take 0.2 s; with it 20 ms (docs/decisions/0018).
inline constexpr Real kLeastImpactSpeedInPile = Real(0.2);

/// Speed of all points of a body below which its pairs are not tested for impacts [m/s]: two bodies as slow
/// as that cannot meet at kLeastImpactSpeed.
inline constexpr Real kRestingImpactSpeed = Real(0.5) * kLeastImpactSpeed;

/// Number of pairs of a body that may bounce, from which on it is in a dense pile for impacts. Chosen by
/// hand; no measurement is recorded.
inline constexpr std::uint32_t kImpactPairsOfPile = 3;

// Impacts: how often and how exactly they are taken.

/// Most refreshes of the manifolds of a pair for one impact. Mostly one is enough (docs/decisions/0018).
inline constexpr int kMostImpactRefreshes = 5;

/// Most impacts of a pair in a substep. What still comes together then just stops (docs/decisions/0018).
/// Chosen by hand; no measurement is recorded.
inline constexpr int kMostImpacts = 16;

/// Most impacts of a pair in a dense pile in a step. Larger: impulses run to and fro in a heap, which is dear
/// and not right either (docs/decisions/0018).
inline constexpr int kMostImpactsInPile = 1;

/// Error of the time of an impact, over the substep [ratio]. Smaller: an impact that rounding delays until
/// just after the end is stopped by the relaxation of its substep, as a ball in double was. Larger: the
/// bodies meet in the manifolds of another time. No measurement of the value itself is recorded.
inline constexpr Real kImpactTimeShare = Real(2e-3);

/// Gap up to which points meet at once [m]. Chosen by hand; no measurement is recorded.
inline constexpr double kImpactSameTimeGap = 1e-4;

/// Least inverse mass with which both bodies together give way [1/kg]. It keeps a quotient finite: with
/// nothing to give way an impulse of 1e12 kg times the speed left rounding of a tenth of a millimeter a
/// second.
inline constexpr double kLeastImpactResponse = 1e-12;

/// How long an impact is iterated.
struct ImpactEffort {
  int sweeps = 60;          ///< Most sweeps over its points.
  int friction_rounds = 8;  ///< Rounds of friction, each followed by sweeps.
  double converged = 1e-9;  ///< Largest change of a speed in the last sweep, over the fastest speed.
};

/// Effort of an impact of two bodies. Chosen by hand; no measurement is recorded.
inline constexpr ImpactEffort kImpactEffort = {};

/// Effort of an impact in a dense pile, of which there are many. Chosen by hand; no measurement is recorded.
inline constexpr ImpactEffort kImpactEffortInPile = {.sweeps = 8, .friction_rounds = 2, .converged = 1e-2};

// Impacts: who is held by what it rests on, or by its hooks.

/// What rests is nearer to its support than this [m]. Chosen by hand; no measurement is recorded.
inline constexpr Real kImpactSupportGap = Real(1e-3);

/// Least cosine between an impulse and the direction in which a support holds a body against it [ratio].
/// Smaller: what the impulse only brushes counts as behind the body. Larger: a tile on the floor takes most
/// of a ball's momentum. Chosen by hand; no measurement is recorded.
inline constexpr Real kImpactSupportCosine = Real(0.2);

/// Most bodies between a struck body and what does not give way. A body with more behind it counts as free
/// (docs/decisions/0018). Chosen by hand; no measurement is recorded.
inline constexpr int kMostBackingBodies = 8;

/// Speed against a lock of a hook, over the change of speed by the impacts, from which on the joints are
/// solved where the body was before its impacts [ratio]. Larger: with e = 0.9, on a rail at 57 degrees to the
/// wall, 10 m/s became 38. Smaller: with joints always solved first, a ball on a thread is off by 4 % of its
/// swing after 30 s, with this value by 0.27 % (docs/decisions/0018).
inline constexpr double kImpactAgainstJoint = 0.1;

}  // namespace hooke::solver
