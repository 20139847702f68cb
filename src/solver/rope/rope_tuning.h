#pragma once

/// \file
/// Constants of ropes that decide accuracy, robustness or cost. docs/tuning.md says how to try another value.

namespace hooke::solver {

// How far segments yield, and what keeps slack and waves defined.

/// Compliance of a rigid segment, times the mass of its lighter end: in the air, and while the rope is in
/// contact (chi) [ratio]. Smaller: rigid segments between two stuck nodes are undetermined. Larger: ropes
/// stretch (docs/decisions/0002). No measurement of the values themselves is recorded.
inline constexpr double kComplianceInAir = 1e-7;
inline constexpr double kComplianceInContact = 1e-5;

/// Transverse stiffness that every segment has, as a share of the lighter end's mass [ratio]. Zero: slack
/// segments are undefined. Larger: it adds inertia; at 0.1 a two-point pendulum at 90 degrees has T/T0
/// = 1.2362 in place of 1.1803, at 1e-5 1.1800 (docs/decisions/0002).
inline constexpr double kTransverseFloor = 1e-5;

/// Share of the geometric stiffness that damps what moves unlike the line between the rope's ends, waves, not
/// swings [ratio]. It is the rope's one numerical damping. Smaller: below 0.05 the threshold of sliding on a
/// cylinder is off; from 0.1 to 0.2 it is 0.998 of Euler's (docs/decisions/0002). Larger: no measurement is
/// recorded.
inline constexpr double kWaveDamping = 0.2;

/// Newmark's beta and a damping delta of the moment of a bend, in shares of h times the stiffness [ratio].
/// Beta keeps the energy of any stiffness. Without delta what swings faster than substeps follow would do so
/// for ever; it takes 5 % of that in each substep. Larger: a clamped rod loses more of its swing than the 1.9
/// % in five swings at 8 substeps (docs/decisions/0030).
inline constexpr double kBendNewmark = 0.25;
inline constexpr double kBendDamping = 0.03;

/// Length over the largest length of a segment, less 1, from which on it is held at its limit [ratio].
/// Smaller: rounding decides. Chosen by hand; no measurement is recorded.
inline constexpr double kRopeLimitTolerance = 1e-4;

/// Resistance of a segment over the largest that compliance lets it have, from which on it counts as firm, so
/// that its length is compared with its compliance and not with its stiffness [ratio]. It lies above 1 by
/// more than rounding. Chosen by hand; no measurement is recorded.
inline constexpr double kFirmResistance = 1.0001;

// When a rope is solved once more, and when it is given up.

/// Error of a length, over it, above which a rope is solved once more [ratio]. The next substep takes back
/// the rest, as speed. Larger: at 1 % a load of 1 kg on 16 rigid segments, let go from the horizontal, rose
/// up to 2.7 % of its swing above the start within 30 s, at 0.1 % never. Smaller: more solutions, of which
/// there are 1.004 a substep at 8 substeps.
inline constexpr double kRopeLengthTolerance = 1e-3;

/// Error of a length, over it, from which on a rope counts as unconverged and lets go of friction [ratio].
/// Smaller: at 0.3 % none of 200 ropes beside a wall gains 11 J, but the wheel of V15 turns 0.3 % less
/// (docs/decisions/0002). Larger: jammed ropes gained up to 3743 J of 12 J.
inline constexpr double kRopeReportedError = 0.01;

/// Most solutions of a rope in a substep; it gets as many again without friction. Then contacts that pull are
/// let go. A slack rope that snaps taut needs several; with a single one it ends in NaN
/// (docs/decisions/0002). No measurement of the value itself is recorded.
inline constexpr int kMostRopeSolves = 8;

/// Least solutions in a substep of a rope in contact, and while a node slides: friction follows from the
/// solution before. Chosen by hand; no measurement is recorded.
inline constexpr int kLeastRopeContactSolves = 2;
inline constexpr int kLeastRopeSlidingSolves = 4;

/// Share by which the drag of a sliding contact may still change [ratio]. Chosen by hand; no measurement is
/// recorded.
inline constexpr double kRopeConvergedDrag = 0.1;

/// Speed above which a contact that would be met is solved for in this substep [m/s]. Smaller: up to 8
/// solutions for what the next substep corrects. Larger: before there was such a speed, 4 solutions were
/// taken whatever they left (docs/decisions/0002). No measurement of the value itself is recorded.
inline constexpr double kRopeImpactSpeed = 0.1;

/// Energy per mass that a contact may give by pulling or driving, that of 1 cm/s [J/kg]. Larger: on rough
/// ground ropes gained up to 54 J of 1 J, with this value 9 mJ. Smaller: more solutions
/// (docs/decisions/0002). No measurement of the value itself is recorded.
inline constexpr double kRopeLeastWork = 0.5e-4;

/// Fewest ropes of one form that are solved in lanes. For fewer, one after another is faster.
inline constexpr int kFewestRopesForLanes = 2;

// How hard contacts hold.

/// Stiffness rho of a contact, over the mass that it holds [ratio]. Smaller: 10 throws weights off. With 1000
/// and forces carried over creep is 0 and penetration below 1 um (docs/decisions/0002). Larger: no
/// measurement is recorded.
inline constexpr double kRopeContactStiffness = 1e3;

/// Share of mu N from which on the friction of a node in the last substep was that of sliding [ratio]. Chosen
/// by hand; no measurement is recorded.
inline constexpr double kRopeSlidingShare = 0.9999;

/// Cosine of the turn of a normal up to which friction that is carried over keeps its size [ratio]. Larger:
/// nodes that turn by more than 0.014 rad seem not to slide any more, and ropes over a drum stall
/// (docs/decisions/0002). Smaller: force of one place acts at another. No measurement of the value itself is
/// recorded.
inline constexpr double kSameFrictionPlace = 0.95;

/// Ratio of rho along the normal, of what is solved with a body, to the heaviest mass that it touches, and
/// largest ratio to its own mass [ratio]: inverting its 3 x 3 matrix loses the square of that
/// (docs/decisions/0011). Smaller: bodies sink into what they lie on; a ball of 100 kg that fell on a rope of
/// 30 g pressed it in by 7 mm, and got up to 9 % of its energy back that was counted nowhere. No measurement
/// of the values themselves is recorded.
inline constexpr double kPointStiffnessOnBody = 10;
inline constexpr double kMostPointStiffness = 1e6;

/// Share of a tether's excess length that is taken back per second [1/s], and largest speed of that [m/s].
/// Larger: at 1 m/s thirty tethers spun 760 kg up to 40 rad/s (docs/decisions/0011). Smaller: what stretched
/// stays long.
inline constexpr double kTetherRecovery = 10;
inline constexpr double kTetherSpeed = 0.1;

// Twist and repulsion.

/// Least 1 + cos of a bend in the rates of twist [ratio]: 172 degrees. A fold would have infinite curvature.
/// Chosen by hand; no measurement is recorded.
inline constexpr double kSharpestTwistBend = 0.01;

/// Distance, in ranges, up to which points may repel each other in a substep, whatever their speed, and up to
/// which they are noted for it [ratio]. The first at 1 would miss what comes near within the substep; the
/// second less the first is how far points move before they are noted anew (docs/decisions/0025). Larger:
/// more pairs. Chosen by hand; no measurement is recorded.
inline constexpr double kRepulsionNear = 1.5;
inline constexpr double kRepulsionNoted = 2;

}  // namespace hooke::solver
