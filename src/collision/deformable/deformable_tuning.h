#pragma once

#include "hooke/math.h"

/// \file
/// Constants of contacts of particles, rope segments and cloth triangles that decide accuracy, robustness or
/// cost. docs/tuning.md says how to try another value.

namespace hooke::collision {

// How far ahead contacts are searched.

/// Distance by which contacts of particles and elements are searched ahead [m]. Chosen by hand; no
/// measurement is recorded.
inline constexpr Real kParticleMargin = Real(0.02);

/// Largest rounding of a side of a box near an object, seen from its origin [m]. Smaller: shapes are missed.
/// Chosen by hand; no measurement is recorded.
inline constexpr Real kBoxRounding = Real(1e-4);

/// Number of substeps for which a new search for pairs of segments is valid. Chosen by hand; no measurement
/// is recorded.
inline constexpr int kRopeSearchSubsteps = 4;

/// Rounds of advancement to the place where a particle meets a shape. A sphere that has not met it by then is
/// taken where it is. Chosen by hand; no measurement is recorded.
inline constexpr int kParticleAdvanceRounds = 8;

// Which segments and triangles get contacts between their points.

/// By how much an edge is thinner in its middle than at its ends, over the radius of the ends [ratio]: of a
/// rope, whose nodes must not catch on what it slides over, and of a cloth. Zero at points: an even thickness
/// of 0.8 r, as beads on a string, hooked ropes into edges with each node (docs/decisions/0021). No
/// measurement of the values themselves is recorded.
inline constexpr Real kRopeThinning = Real(0.2);
inline constexpr Real kClothThinning = Real(0.5);

/// Rows are made where a shape protrudes by this share of an edge's thinning [ratio]. Chosen by hand; no
/// measurement is recorded.
inline constexpr Real kElementSearchShare = Real(0.5);

/// Depth of a gentle curve in a chord between two points, over their radius, up to which it is not tested
/// [ratio]. On ropes the line from node to node stays outside; on cloths the points hold it off all the same.
/// Smaller: at 0.16 hair on a head was in coupled groups and cost 4.5 times as much (docs/decisions/0021).
inline constexpr Real kRopeGentleDepth = Real(0.8);
inline constexpr Real kClothGentleDepth = Real(0.4);

/// Least share of an element that belongs to points that are free: pinned points do not give way [ratio].
/// Chosen by hand; no measurement is recorded.
inline constexpr Real kLeastFreeShare = Real(0.25);

/// Largest number of elements near a body that none of them held in the step before; near to more it has
/// contacts with points alone. Larger: twelve small bodies on one coarse cloth took 73 ms with all in one
/// matrix. Smaller: small bodies fall through (docs/decisions/0021).
inline constexpr int kMostNearElements = 12;

/// Largest number of contacts of a cloth with bodies that are solved as one. Larger: a box of 100 kg over 60
/// of them took 3 ms per frame in place of 0.4. Smaller: row after row a roller of 100 kg in a hammock did
/// not come to rest (docs/decisions/0021). No measurement of the value itself is recorded.
inline constexpr int kFewElementContacts = 12;

/// Number of points from which on they carry a body that is wider than the meshes. For narrow ones three
/// points were not enough: of twelve bodies of 12 cm on meshes of 10 cm one fell through
/// (docs/decisions/0021).
inline constexpr int kSupportingPoints = 3;

// When contacts of elements begin, hold and keep their force.

/// Largest overlap, over the radius, with which a contact may begin [ratio]. Larger: what gives way and
/// overlaps from the start is pushed out; that made 10 to 600 J in one of four heaps (docs/decisions/0021).
/// No measurement of the value itself is recorded.
inline constexpr Real kDeepestNewOverlap = Real(0.5);

/// Cosine of the angle that a normal may turn in a substep without losing its force, of elements and of rope
/// contacts [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr Real kElementSameSide = Real(0.9);
inline constexpr Real kRopeSameSide = Real(0.9);

/// Share of the thickness at which an element and a shape count as touching [ratio]. Chosen by hand; no
/// measurement is recorded.
inline constexpr Real kElementTouchingShare = Real(0.01);

/// Largest speed at which overlaps of elements are undone in place [m/s]: that of
/// solver::kParticlePushOutSpeed, by which rows that are apart may come nearer without being looked at.
inline constexpr Real kElementApartSpeed = Real(1);

/// Rounds of advancement to the place where an element meets a shape. Chosen by hand; no measurement is
/// recorded.
inline constexpr int kElementAdvanceRounds = 4;

/// Rounds of the search for the deepest point of an element, by thirds: to 1e-3 of the interval. Chosen by
/// hand; no measurement is recorded.
inline constexpr int kDeepestPointRounds = 17;

// What keeps bodies from passing through faces and segments.

/// Distance that faces and segments keep from shapes, over the radius of their points [ratio]. Larger: it
/// gets in the way of contacts of points, over whose chords shapes protrude. Smaller: rounding decides.
inline constexpr Real kPassedBodyShare = Real(0.1);

/// How far a chord between points that touch a wide body may cut into it, over the longest edge [ratio]: it
/// is as much at a right angle. Smaller: points and faces both carry a heavy body, and gain energy.
inline constexpr Real kChordShare = Real(0.36);

/// How much farther zones may move a body into another in a particle substep before that becomes part of the
/// zone [m]. Smaller: whatever lies on cloth that lies on something is held. Larger: overlaps grow.
inline constexpr Real kPressedOverlap = Real(1e-4);

/// Weight of a point from which on what touches an element of a solid that is solved as a whole is left to
/// the contact of the point [ratio]. Chosen by hand: a second push made 4 % of the energy of 10 t on a jelly.
inline constexpr Real kPointShare = Real(0.8);

/// Distance at which a shape may come to press on a face of a solid that is solved as a whole, beyond the
/// distance that they keep, over the longest edge [ratio]. Chosen by hand.
inline constexpr Real kNearFaceShare = Real(0.02);

/// How far a shape may move in a particle substep relative to such a face, over the longest edge, for the
/// contact to belong to the solution [ratio]. What is faster is stopped after it.
inline constexpr Real kSlowFaceShare = Real(0.2);

/// Share of that distance that they keep for certain, or the substep is taken back [ratio].
inline constexpr Real kPassedBodyLeast = Real(0.2);

/// Rounds of advancement of a moving shape to a moving element. Two that have not met by then count as
/// meeting.
inline constexpr int kMostMeetingRounds = 40;

// When contacts of two ropes act.

/// Share of the displacement in a substep that other forces may turn into approach [ratio], and gap within
/// which a row acts, over the thickness [ratio]. Smaller: rows come too late. Larger: more rows are in the
/// matrix. Chosen by hand; no measurement is recorded.
inline constexpr Real kRopeAsideShare = Real(0.25);
inline constexpr Real kRopeAheadShare = Real(0.1);

/// Speed below which overlaps of ropes are undone [m/s]: rows that are apart are not looked at before they
/// may have met with it. Chosen by hand; no measurement is recorded.
inline constexpr Real kRopeApartSpeed = Real(1);

/// A fraction of a segment this near to 0 or 1 counts as its end [ratio]. Chosen by hand; no measurement is
/// recorded.
inline constexpr Real kSegmentEndShare = Real(1e-5);

/// Sine of the slope from which on a neighbor counts as nearer [ratio]. Chosen by hand; no measurement is
/// recorded.
inline constexpr Real kClearlyNearer = Real(1e-3);

/// Share by which a row is thinner where a neighbor is nearer [ratio]. Zero: with the nearest place alone a
/// heap overlaps by half, since two strands side by side touch all along (docs/decisions/0024). Larger: what
/// slides past is stopped. No measurement of the value itself is recorded.
inline constexpr Real kRopeSkinShare = Real(0.03);

/// Most steps from a row that does not act to the one that takes its forces over. Chosen by hand; no
/// measurement is recorded.
inline constexpr int kMostSuccessorSteps = 4;

/// Most rounds of advancement of two segments, and share of the distance at which they count as touching
/// [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr int kMostRopePairRounds = 24;
inline constexpr Real kRopeTouchingShare = Real(0.01);

// What keeps ropes from passing through each other.

/// Distance that two center lines keep, as a share of the thickness, or of the arc between two segments
/// [ratio]. Zero: knots come undone (docs/decisions/0024). No measurement of the value itself is recorded.
inline constexpr Real kPassKeptShare = Real(0.5);

/// Share of that distance that rigid zones keep [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr Real kPassZoneShare = Real(0.5);

/// Share of the kept distance at which the direction is taken [ratio]. Chosen by hand; no measurement is
/// recorded.
inline constexpr Real kPassDirectionShare = Real(0.8);

/// A pass is nearer than the kept distance by this share of it [ratio]. Chosen by hand; no measurement is
/// recorded.
inline constexpr Real kPassNearerShare = Real(0.05);

/// Rounds of impulses for single pairs; what is left then goes on as one. And rounds of such zones. Chosen by
/// hand; no measurement is recorded.
inline constexpr int kMostPassRounds = 8;
inline constexpr int kMostPassZoneRounds = 16;

}  // namespace hooke::collision
