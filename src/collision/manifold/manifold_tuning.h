#pragma once

#include "hooke/math.h"

#include <cstddef>

/// \file
/// Constants of manifolds that decide accuracy, robustness or cost. docs/tuning.md says how to try another
/// value.

namespace hooke::collision {

// Which axis separates two shapes.

/// The last axis stays unless one is better by this, and pairs of edges have to be better than faces by this
/// [m]. The values come from evidence: with less, stacks of boxes change between equally good axes from step
/// to step. Larger: hulls kept axes that no longer held, and lay up to 0.32 m in each other without a
/// contact, until an axis had to be as deep as its points.
inline constexpr Real kKeepAxis = Real(5e-4);
inline constexpr Real kPreferFaces = Real(2e-3);

/// Squared sine of the angle of two edges below which they have no axis that a face does not have [ratio].
/// Smaller: the axis of nearly parallel edges loses digits. Chosen by hand; no measurement is recorded.
inline constexpr Real kParallelEdges = Real(1e-4);

/// Most pushes apart in the search for a better axis of round shapes. Chosen by hand; no measurement is
/// recorded.
inline constexpr int kMostAxisPushes = 8;

// Which feature of a shape touches.

/// Least cosine between a face and a direction for which it is the feature of a polyhedron there [ratio]:
/// where the normal may be any direction, and where it is that of a face of the other shape. Chosen by hand;
/// no measurement is recorded.
inline constexpr Real kFlatFaceCosine = Real(0.98);
inline constexpr Real kSteepFaceCosine = Real(0.2);

/// Slope of a side, as a sine, up to which it counts as perpendicular to the direction [ratio]. Chosen by
/// hand; no measurement is recorded.
inline constexpr Real kFlatSide = Real(0.2);

/// The end of a cylinder that is less tilted than this cosine is a disc and not a point of its rim [ratio].
/// Chosen by hand; no measurement is recorded.
inline constexpr Real kFlatEnd = Real(0.995);

/// Points of a rim are taken at marks fixed to the body, unless its lowest point lies this share of the
/// radius below them [ratio]. Smaller: marks that follow the tilt jump about on an end that stands flat.
/// Larger: a tilted end rests beside its lowest point. Chosen by hand; no measurement is recorded.
inline constexpr Real kTiltedRim = Real(1e-3);

/// Distance beside an edge at which a point still counts as inside, in lengths of the edge [ratio]. So a
/// point on an edge that two faces share is over one of them. Chosen by hand; no measurement is recorded.
inline constexpr Real kOverFaceSlack = Real(1e-5);

// Which points stay.

/// Points within this of the deepest count as equally deep [m]. Smaller: rounding chooses between them.
/// Chosen by hand; no measurement is recorded.
inline constexpr Real kSameDepth = Real(5e-4);

/// Favor of points of the last step among those that span nearly the same area [ratio]. Chosen by hand; no
/// measurement is recorded.
inline constexpr Real kKeepArea = Real(1.1);

/// Distance up to which a point is that of the last step and keeps its impulse [m]. Larger: edges that are
/// nearly parallel cross now near one end and now near the other under one key. Smaller: what slides loses
/// its impulse. It is the distance within which points are kept.
inline constexpr Real kSamePosition = Real(0.02);

/// Cosine of the angle, 30 degrees, up to which a manifold is that of the last step [ratio]. Chosen by hand;
/// no measurement is recorded.
inline constexpr Real kSameNormal = Real(0.866);

// What meshes add: flush triangles, covered ones, patches.

/// By how much a piece may stand out over a plane and still count as behind it: flush pieces are one floor
/// [m]. It is also how much deeper than a patch points of a covered triangle must be to join it
/// (docs/decisions/0027). Smaller: inner edges are felt. Larger: what lies in a groove is covered. No
/// measurement of the value itself is recorded.
inline constexpr Real kFlush = Real(5e-4);

/// Heights below this are rounding where two triangles cover each other [m]. Chosen by hand; no measurement
/// is recorded.
inline constexpr Real kPositionRounding = Real(2e-6);

/// Tilt of the line from a triangle to the center of a ball up to which the ball is over its face [rad].
/// Larger: the line is off, and the spin of the ball seems to bring surfaces together. Smaller: rounding
/// decides. Chosen by hand; no measurement is recorded.
inline constexpr Real kOverFaceTilt = Real(1e-4);

/// Least cosine between a covered triangle's normal and that of the patch that its points join [ratio].
/// Chosen by hand; no measurement is recorded.
inline constexpr Real kPatchLikeness = Real(0.5);

/// Most patches of a pair with a mesh; those with the most similar normals are joined to come to it. Larger:
/// more manifolds. Smaller: more sides share one normal. Chosen by hand; no measurement is recorded.
inline constexpr std::size_t kMostPatches = 6;

}  // namespace hooke::collision
