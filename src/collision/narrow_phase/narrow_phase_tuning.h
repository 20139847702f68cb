#pragma once

#include "hooke/math.h"

#include <cstdint>

/// \file
/// Constants of the narrow phase that decide accuracy, robustness or cost. docs/tuning.md says how to try
/// another value.

namespace hooke::collision {

// From where points are kept, and when fast pairs are looked at where they will meet.

/// Distance up to which points are kept, at rest, and motion beyond the thickness of a pair from which on it
/// is fast [m]. Smaller: points come and go. Larger: more rows. kReachMargin is half of it; kSlowDriftLimit
/// is less. No measurement of the value itself is recorded.
inline constexpr Real kPointMargin = Real(0.02);

/// Overlap at which a fast pair is tested, at most what a sweep allows [m]. Larger: balls met 5 mm too deep
/// with the allowance of sweeps, and the line of centers was off by 3 degrees (docs/decisions/0006). Smaller:
/// points are missed by rounding. No measurement of the value itself is recorded.
inline constexpr Real kForeseenOverlap = Real(1e-4);

/// Overlap before the time of a test, from which on points that are apart then have parted, and are dropped
/// [m]. Smaller: points of a wheel that only just touched were thrown away where rounding made them part, by
/// 1e-7 m, and it fell freely for a step (docs/decisions/0022). No measurement of the value itself is
/// recorded.
inline constexpr Real kPartingOverlap = Real(1e-4);

// Which pairs are tested again in each substep.

/// Turn in a step from which on the levers of its start do not fit the whole step [rad]. Larger: no
/// measurement is recorded. Smaller: with 0.02 for boxes too, dominoes of 40 cm run 0.7 % slower, 0.5 asked
/// (docs/decisions/0015).
inline constexpr Real kSpinningTurn = Real(0.2);

/// The same for pairs with a round shape, since the place where it touches wanders [rad]. Larger: at 0.2 the
/// rattleback of V48 gains 22 % of energy in 12 s, with this value 0.9 % in 24 s.
inline constexpr Real kRollingTurn = Real(0.02);

/// Motion of a surface by turning, below which it is no turn: a ball about its center [m]. Chosen by hand; no
/// measurement is recorded.
inline constexpr Real kStillSurface = Real(1e-3);

/// Gap at which a pair that slides far touches [m]. Chosen by hand; no measurement is recorded.
inline constexpr Real kSlidingGap = Real(5e-3);

/// Least number of manifolds of a refreshed pair with a mesh: one for each patch that it may reach within the
/// step (docs/decisions/0015). Chosen by hand; no measurement is recorded.
inline constexpr std::uint32_t kRefreshedPatches = 4;

// When a pair keeps its manifolds.

/// Share of a body's radius by which a pair may drift and keep its manifolds, so that its surfaces tilt by no
/// more than twice this [ratio, rad]. A test compares such manifolds with new ones: 5e-7 m apart. Steps at
/// rest take 10 to 50 % less. Larger: manifolds are wrong. No measurement of the value itself is recorded.
inline constexpr Real kDriftShare = Real(5e-4);

/// The same for slow bodies of islands that are too large to be solved directly, and at most this [m]. It is
/// less than kPointMargin. Smaller: levers and normals follow what soft contacts let a heap lean;
/// large_pyramid fell after 11 s, and moves by 70 mm in 60 s now. Larger: dominoes of 10 cm fell 0.2 % faster
/// with 3 % for all slow bodies (docs/decisions/0004).
inline constexpr Real kSlowDriftShare = Real(0.03);
inline constexpr Real kSlowDriftLimit = Real(0.015);

/// Speed of all points of a body, over its radius, below which it is slow [1/s]. Chosen by hand; no
/// measurement is recorded.
inline constexpr Real kSlowRate = Real(0.25);

// Dense piles: bodies that stand deep inside each other.

/// Distance of two centers over the sum of the inner radii, below which two bodies are deep in each other
/// [ratio]. Larger: contacts are left out of bodies that came together by themselves. Chosen by hand; no
/// measurement is recorded.
inline constexpr double kDeepCenters = 0.75;

/// Overlap over the smaller inner radius, above which they are [ratio]. Chosen by hand; no measurement is
/// recorded.
inline constexpr Real kDeepOverlap = Real(0.5);

/// Number of neighbors with which a body of a dense pile makes contact, and number from which on it is in
/// one. Larger: all pairs of a thousand bodies at one point were half a million manifolds and 31.7 s a step;
/// with eight they take 20 to 40 ms. Smaller: bodies pass. No measurement of the values themselves is
/// recorded.
inline constexpr std::uint32_t kMostNeighborsInPile = 8;
inline constexpr std::uint32_t kLeastNeighborsInPile = 4;

}  // namespace hooke::collision
