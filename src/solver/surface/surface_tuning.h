#pragma once

#include "hooke/math.h"

#include <cstddef>
#include <limits>

/// \file
/// Constants of the contact of deformables with each other that decide accuracy, robustness or cost.
/// docs/tuning.md says how to try another value, docs/decisions/0040-contact-of-surfaces.md what was tried.

namespace hooke::solver {

// Rows of contacts.

/// Share of the overlap that a substep takes back [ratio], and the largest speed at which it does [m/s].
/// Larger: layers that lie on each other do not come to rest. Smaller: overlaps stay longer.
inline constexpr Real kSurfaceRecovery = Real(0.3);
inline constexpr Real kSurfaceRecoverySpeed = Real(1);

/// Distance that ridges and tips keep from each other, and crossing edges, over the thickness [ratio]. At 1
/// an edge that slides over edges bumps along, and loses speed without friction.
inline constexpr Real kRidgeShare = Real(0.8);
inline constexpr Real kEdgeShare = Real(0.5);

/// Distance that a segment of a rope keeps from others and from edges, over the thickness [ratio].
inline constexpr Real kRopeShare = Real(1);

/// A pair of a vertex and a face, or of edges, has a row where it comes within this share of the thickness
/// beyond its distance [ratio].
inline constexpr Real kSurfaceMargin = Real(0.2);
inline constexpr Real kEdgeMargin = Real(0.1);

/// Largest cosine between the normal at an edge or a corner and a face or an edge that begins there. Smaller:
/// contacts at curved places are lost. Larger: flat places bump along.
inline constexpr Real kWedgeCosine = Real(0.15);

/// Passes over the rows between two solutions of contacts with bodies, and how often both alternate in a
/// particle substep. With one round the lowest of four layers on a ball kept 40 % of its thickness.
inline constexpr int kSurfaceSweeps = 2;
inline constexpr int kSurfaceRounds = 3;

/// How far a part that has come through a surface is drawn back until contacts are found again, over the
/// length of an edge [ratio]. Larger: what began crossed flies apart. Smaller: it takes longer.
inline constexpr Real kWayBack = Real(0.05);

// Cages.

/// Room of a point beyond its expected path, over the length of an edge [ratio]: where the group hardly
/// moves, where it moves, and most. Smaller: corrections have no room and jam at impacts. Larger: more
/// candidates.
inline constexpr Real kCalmRoom = Real(0.04);
inline constexpr Real kRoom = Real(0.1);
inline constexpr Real kMostRoom = Real(0.2);

/// Displacement in a substep, over the length of an edge, from which on a group has the room of one that
/// moves [ratio].
inline constexpr Real kCalmDisplacement = Real(0.1);

/// A cage lasts until 95 % of the points have gone less than this share of an edge [ratio]. Larger: the
/// number of candidates grows faster than the number of detections falls.
inline constexpr Real kCageDisplacement = Real(0.25);

/// Share of the points that may be clipped to their cages before contacts are found anew [ratio]. At 0.01 a
/// moving front was clipped for a whole substep.
inline constexpr double kClippedShare = 0.002;

/// Most pairs that are found between two surfaces: some hundred megabytes. More of them, where points fly
/// apart, hold the whole group back.
inline constexpr std::size_t kMostFound = std::size_t{1} << 22U;

// Truncation.

/// Distance that surfaces keep for certain, over the thickness [ratio], and over the distance they had before
/// [ratio]: a jammed pair may come 10 % closer in a substep, and never reaches the rounding of positions.
inline constexpr Real kKeptShare = Real(0.02);
inline constexpr Real kKeptOfGap = Real(0.9);

/// Rounds of corrections in a particle substep. With 4 and 8 sheets jammed that fold, with 16 nearly, with 32
/// rarely.
inline constexpr int kCorrectionRounds = 64;

/// Most work of these rounds in a particle substep of a group, beyond which they end and what is still too
/// near is held back: a pair that is looked at counts 1, one that is moved apart 8 more, a stiff solid that
/// moves a quarter of its particles. Jelly hit at 1e6 m/s had 27 000 near pairs in all 64 rounds: a step took
/// 15 s.
inline constexpr std::size_t kMostCorrectionWork = 2000000;

/// Pairs this much closer than they need to be, over the thickness, are looked at in each round [ratio].
inline constexpr Real kHotShare = Real(0.1);

/// Rounding of positions, over the largest coordinate: what is farther apart is apart for certain.
inline constexpr Real kSurfaceReserve = Real(3.4) * std::numeric_limits<Real>::epsilon();

// Corrections.

/// Speed below which what corrections gave a group as a whole is rounding [m/s]. Chosen by hand.
inline constexpr Real kRoundedSpeed = Real(1e-7);

}  // namespace hooke::solver
