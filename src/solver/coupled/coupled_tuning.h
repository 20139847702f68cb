#pragma once

#include "hooke/math.h"

#include <cstddef>
#include <cstdint>

/// \file
/// Constants of what is solved together, direct islands, load-bearing contacts and coupled groups, that
/// decide accuracy, robustness or cost. docs/tuning.md says how to try another value.

namespace hooke::solver {

// Which islands of contacts are solved directly.

/// Overlap that a soft contact needs for its load, over the size of the smaller body, above which an island
/// asks for a direct solution [ratio]. Larger: contacts are seen to sink. Smaller: heaps that soft contacts
/// hold are solved directly, at 20 times the cost (docs/decisions/0007).
inline constexpr Real kLargestSag = Real(0.005);

/// The same times the square of height over size, sag H^2 / a^3 [ratio]. A column of cubes buckles at 1.9,
/// and columns of 1 m from 24 boxes on, where the lowest overlap is only 0.3 % (docs/decisions/0007). Larger:
/// what is about to buckle stays soft. Smaller: more islands are dear.
inline constexpr Real kLargestBuckling = Real(0.3);

/// Share of both, below which an island that is direct may become soft again [ratio]. Larger: islands
/// alternate. Chosen by hand; no measurement is recorded.
inline constexpr Real kReleasedShare = Real(0.6);

/// Multiple of both, above which an island is direct after one step [ratio]. Chosen by hand; no measurement
/// is recorded.
inline constexpr Real kGrossExcess = Real(5);

/// Ratio of the masses of two bodies that meet, from which on their island becomes direct at once if a soft
/// contact would let them sink into each other too far [ratio]. Larger: with 1000 times the mass of a cube, a
/// body that fell on three of them sank in by 82 % of one; with 10 times, by 5 %. Smaller: like bodies that
/// fall in a heap are dear. No measurement of the value itself is recorded.
inline constexpr Real kArrivingMassRatio = Real(5);

/// The same where the lighter one lands on what does not give way, with the other one on it [ratio]. Larger:
/// 30 kg on a plank of 10 kg that fell sank by 22 mm. Smaller: like bodies that fall in a heap are dear.
inline constexpr Real kLandingMassRatio = Real(2);

/// An island with a faster body does not become direct [m/s]. Larger: a wave of falling dominoes becomes
/// direct, 9.5 ms a step instead of 0.05 (docs/decisions/0007). Smaller: what is only being placed stays soft
/// and sinks meanwhile.
inline constexpr Real kDirectIslandSpeed = Real(0.5);

/// Number of steps on end in which an island asks for a direct solution, until it has one. It is also the
/// first value of state::Bodies::direct_state that stands for a direct island: below 0 an island was refused
/// and is not evaluated for that many steps, from 0 on it counts the steps in which the island asked, and
/// from kDirect on it is direct for that many steps and more. Larger: with three steps a top of 10 000 times
/// the mass fell 2 cm before it was held (docs/decisions/0007).
inline constexpr std::int8_t kDirect = 2;

/// Steps that an island stays direct after it last asked for it. Larger: islands in free flight that hit each
/// other are direct without need. Chosen by hand; no measurement is recorded.
inline constexpr std::int8_t kStaysDirectSteps = 30;

/// Steps on end in which an island may cost more than kDirectStepBudget. Larger: what never comes to a
/// solution costs as much in more of them. Chosen by hand; no measurement is recorded.
inline constexpr std::int8_t kMostCostlySteps = 3;

/// Minus the number of steps for which an island is not evaluated that was refused or is too large. Nearer to
/// zero: sorting contacts into islands costs 20 ns a contact and step; a pyramid of 30 rows took 0.611 ms in
/// place of 0.602. Farther: what was refused waits for longer. A direct_state below it waits for the
/// difference: such an island asked for a direct solution, so that StepReport counts its rows.
inline constexpr std::int8_t kNotEvaluatedSteps = -60;

// What direct islands may cost.

/// Multiplications of one factorization of one island. A column of 100 boxes (0.44 ms a step), a house of
/// cards (0.22) and heavy tops fit. Larger: heaps that move cost 20 times what soft contacts do; `pile` took
/// 101 ms a step instead of 4.5, with this value 6.4 (docs/decisions/0007).
inline constexpr double kDirectIslandBudget = 4e4;

/// Ratio of the mass of what lies on a body to that body's, beyond which the budget of their island grows in
/// proportion, up to that of all islands [ratio]. Larger: a pyramid of 10 rows under 1000 times
/// the mass of a box was refused and fell by 0.6 m. Smaller: heaps of like bodies are dear. No measurement of
/// the value itself is recorded.
inline constexpr Real kHeavyOnLightRatio = Real(20);

/// Multiplications of one factorization of all islands: some milliseconds a step. Smaller: with 4e4 for all
/// of them 13 of 24 towers were refused and sank.
inline constexpr double kDirectBudget = 1e6;

/// Most bodies of a direct island. More are over the budget anyway, and sorting them is saved. Chosen by
/// hand; no measurement is recorded.
inline constexpr std::uint32_t kMaxDirectBodies = 256;

// Which contacts bear load.

/// Ratio of the mass of what lies on a hanging body to that body's, from which on their contact bears load,
/// and ratio of the load to the hanging body's weight [ratio]. Larger: a pass takes at most m v of the light
/// body from the heavy one, which sinks or falls through (docs/decisions/0022). Smaller: more contacts are
/// rows of a coupled group, which is dear. No measurement of the values themselves is recorded.
inline constexpr Real kLoadBearingMassRatio = Real(2);
inline constexpr Real kLoadBearingLoadRatio = Real(1);

/// Contacts of a body with the ground bear load if a body that it is locked to is kPressedMass times as
/// heavy. They also do if all that hangs together with it is kPressedGroup times as heavy and it presses on
/// the ground with kPressedLoad times its weight, or did so in the last step and still presses with
/// kPressedAgainShare of that [ratios]. Ragdolls (solver/joint/approximate_trees.h) are left out. Larger: a
/// ton on four legs of 1 kg goes through the ground (docs/decisions/0022). Smaller: limbs that fall count;
/// for ragdolls that was 15 to 20 % of the time of scenes/rain.json. No measurement of the values themselves
/// is recorded.
inline constexpr Real kPressedMass = Real(8);
inline constexpr Real kPressedGroup = Real(25);
inline constexpr Real kPressedLoad = Real(20);
inline constexpr Real kPressedAgainShare = Real(0.25);

/// Overlap over half the size of the thinner body beyond which a body is far inside another one [ratio].
/// Larger: a ball that a hook holds 0.1 m inside the ground, with ten times its mass on it, reached 40 m/s.
/// Smaller: a hooked body that has sunk in a blow holds no heavy load. No measurement of the value itself is
/// recorded.
inline constexpr Real kDeepShare = Real(1.4);

/// Overlap of a body with one of an articulation that hangs on nothing, over the size of the smaller, from
/// which on their contact bears load [ratio]. Larger: the load on a light table is seen to sink into it.
/// Smaller: what only falls on such a body is coupled. Chosen by hand; no measurement is recorded.
inline constexpr Real kSunkShare = Real(0.025);

/// Gap at which surfaces may press on each other [m]. Larger: what only hangs near is solved with the hooks;
/// at 2 cm a lamp of 1 kg that hung 5 mm beside a tower brought it down. No measurement of the value itself
/// is recorded.
inline constexpr Real kLoadTouchingGap = Real(1e-3);

/// Least cosine between the normal and gravity with which a body lies on another one, and does not lean on
/// its side [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr Real kLiesOnCosine = Real(0.3);

/// Share of load and weight that contacts under a hooked body bring, from which on it stands and does not
/// hang, and the same for a body whose hooks carried it in the last step [ratio]. The second is larger, so
/// that a body does not change between the two from step to step. A knob glued to a tower of ten tons, taken
/// for hanging, sank it by 139 mm. No measurement of the values themselves is recorded.
inline constexpr Real kStandingShare = Real(0.5);
inline constexpr Real kStandingShareAgain = Real(0.9);

/// Most bodies on top of each other above a hanging one of which the contacts bear load: a ton on a board on
/// planks has two. Chosen by hand; no measurement is recorded.
inline constexpr int kMostLoadLayers = 4;

/// Passes from below upwards that find who stands: one for each hooked body that stands on another one.
/// Chosen by hand; no measurement is recorded.
inline constexpr int kMostStandingPasses = 32;

/// Largest number of load-bearing manifolds in a step: they cost some milliseconds. Smaller: with 64, eight
/// of 40 crates on rollers fell through.
inline constexpr std::size_t kMostLoadBearingManifolds = 512;

// How contacts in a coupled group hold.

/// Speed to which the impulse that a contact of two bodies begins with may push it [m/s]: what carried a load
/// pushes on where that load is gone. Larger: hooks that hold bodies inside each other strain contacts with
/// 6e5 N s, which then throw all apart at 4e7 m/s. Smaller: contacts give way under loads of 5e4 times the
/// weight of what carries them.
inline constexpr double kMostCarriedSpeed = 0.01;

/// Most by which the removal of overlaps moves the ends of a rope's segment apart or aside, over its length
/// [ratio]: its square is how much longer the segment becomes. Larger: a rope on which wedged boxes lay was
/// pulled from 7 to 147 cm in one step, and threw them off with 250 times their energy. Smaller: what lies on
/// ropes comes apart later. No measurement of the value itself is recorded.
inline constexpr double kMostSegmentPush = 0.05;

/// Largest drag of sliding friction, times the substep, over the mass at the contact [ratio]. A contact that
/// is dragged harder sticks: what is light may carry many times its weight. Chosen by hand; no measurement is
/// recorded.
inline constexpr double kMostDrag = 1e4;

/// Largest speed at which overlaps of ropes leave [m/s]. Larger: where one end
/// of a segment is wedged, the other moves many times as fast as the contact; 0.2 gave a rope of two nodes 10
/// mJ (docs/decisions/0002). Smaller: overlaps stay for longer.
inline constexpr double kElementPushOutSpeed = 0.05;

/// The most by which a contact of ropes gives way to its force [m/s]. Larger: a rope of 0.8 g a node with 10
/// kg on it is pressed through itself (docs/decisions/0024). No measurement of the value itself is recorded.
inline constexpr double kRopeYieldSpeed = 0.02;

/// Least solutions in a substep while contacts of ropes slide. Smaller: with two the load on a thick rope
/// slid at 7 mm/s at 105 % of what holds, with seven at 12. Larger: with eight contacts are let go as well,
/// and a heap gained 0.6 J (docs/decisions/0024).
inline constexpr int kRopeSlidingSolves = 7;

/// Kinetic energy over that before a solution, above which a solution is not linearized about any more
/// [ratio]. Larger: a heap of ropes with contacts that pull settled at up to 4 J more than the 1.4 J that it
/// had (docs/decisions/0024). No measurement of the value itself is recorded.
inline constexpr double kMostEnergyGain = 1.1;

/// Share of a motor row's diagonal that is added as its compliance [ratio]. A motor asks for a speed and does
/// not take back what it has yielded, so it has much less than other rows (kHookCompliance): a brake of 1000
/// N m yielded by 1.3 rad in 2 s, solved with its rope by 1e-9. No measurement of the value itself is
/// recorded.
inline constexpr double kMotorCompliance = 1e-10;

/// Least share of its own inverse mass that a hooked point keeps while springs are solved [ratio]. Zero: a
/// point that is hooked to something which does not give way does not show how it was pulled. Larger: with
/// 1e-3 a body of 5 kg on a point of 0.3 g counted as 0.3 kg, and stretched its cloth by half more.
inline constexpr Real kLeastMassShare = Real(1e-5);

// What coupled groups may cost.

/// Multiplications of all factorizations of one coupled group in a substep, some 20 ms. Rope contacts that
/// switch off and on again could ask for 256 factorizations: one step of three ropes of 200 points took 29 s.
/// With the budget the longest step of three ropes of 120 points fell from 183 to 68 ms. Where one
/// factorization with all rope contacts costs more, as with segments that each touch all others, every second
/// rope contact is left out until it fits. This choice knows only who touches whom. Smaller: more is cut
/// short.
inline constexpr double kCoupledGroupBudget = 2e7;

/// Factorizations that are always allowed. Chosen by hand; no measurement is recorded.
inline constexpr int kFewestFactorizations = 4;

/// Most rope contacts for each node of the group's ropes, on average. Larger: ropes so thick that each
/// segment touches all others ask for a matrix of 45 GB. No measurement of the value itself is recorded.
inline constexpr std::size_t kMostRopeContacts = 8;

// Which segments of ropes break together.

/// Most segments of a group that give way in one substep; the rest hold until the next. Each costs three
/// solutions. Smaller: of many ropes that are loaded at once, some carry more than they can for a substep.
/// Larger: such a substep takes long. Chosen by hand; no measurement is recorded.
inline constexpr std::size_t kMostSegmentBreaks = 16;

/// How much more than its strength a segment may carry in a substep in which another one of its rope gives
/// way [ratio]. Smaller: a rope that a falling load stretches breaks in up to four places at once, as each
/// needs 2 to 5 % more than its strength while the first passes on just that. Larger: ropes that are pulled
/// at both ends carry more than they can.
inline constexpr double kSparedNeed = 1.2;

}  // namespace hooke::solver
