#pragma once

#include "hooke/math.h"

#include <limits>

/// \file
/// Constants of distances that decide accuracy or cost. docs/tuning.md says how to try another value.

namespace hooke::collision {

// How exactly the distance of two convex shapes is found.

/// Most rounds of the search for the nearest points. Between a triangle and a shape it takes about four.
/// Chosen by hand; no measurement is recorded.
inline constexpr int kMostDistanceRounds = 64;

/// Error of a distance that is rounding, over the size of what is compared [ratio]: four roundings of a Real.
/// Smaller: the search goes on where nothing is gained. Larger: distances are wrong. Chosen by hand; no
/// measurement is recorded.
inline constexpr double kDistanceRounding = 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());

// Where a ridge or a peak of a mesh holds.

/// Sine of the angle by which the mesh around a place may stand out over the plane of contact: within a
/// hundredth nothing around is nearer (docs/decisions/0021). Chosen by hand; no measurement is recorded.
inline constexpr Real kProtrusionTilt = Real(0.01);

/// Points that are nearer than this, over the element's size, define no direction [ratio]. Chosen by hand; no
/// measurement is recorded.
inline constexpr Real kProtrusionClose = Real(1e-3);

/// Square of the sine below which an element lies along a ridge [ratio]: its points carry it then. Chosen by
/// hand; no measurement is recorded.
inline constexpr Real kAlongRidge = Real(1e-4);

}  // namespace hooke::collision
