#pragma once

#include "hooke/math.h"

/// \file
/// Constants of continuous collision that decide robustness or cost. docs/tuning.md says how to try another
/// value.

namespace hooke::collision {

// Who is swept.

/// Largest motion of a body, and of a pair against each other, that is not swept, in half thicknesses
/// [ratio]. Larger than 1: bodies may pass each other. Smaller: more sweeps, and what overlaps is taken from
/// the contacts (docs/decisions/0006). No measurement of the value itself is recorded.
inline constexpr Real kUnseenDisplacement = Real(0.5);

/// Margin around the reach of a shape: half of the distance from which contacts are kept [m]. Larger: more
/// pairs are tested. Smaller: pairs of which points would be kept are not found.
inline constexpr Real kReachMargin = Real(0.01);

// How deep a sweep lets shapes overlap.

/// A sweep lets a pair overlap by kOverlapShareOfBoth of the sum of their half thicknesses, at most by the
/// larger of kOverlapAllowance [m] and kOverlapShareOfThinner of the thinner one [ratio]. Smaller: bodies at
/// rest on each other sink in, and sliding would be an impact. Larger: with this allowance for impacts that
/// are foreseen, balls met 5 mm too deep, and the line of centers was off by 3 degrees (docs/decisions/0006).
/// No measurement of the values themselves is recorded.
inline constexpr Real kOverlapAllowance = Real(5e-3);
inline constexpr Real kOverlapShareOfBoth = Real(0.25);
inline constexpr Real kOverlapShareOfThinner = Real(0.1);

// How exactly a sweep finds the time, and what that costs.

/// Error of the gap at the time of an impact, over the overlap that is allowed [ratio]. Chosen by hand; no
/// measurement is recorded.
inline constexpr Real kSweepTolerance = Real(0.05);

/// Most rounds of a sweep; after them the pair counts as having met (docs/decisions/0006). Beside a large
/// body that turns a sweep takes many. Chosen by hand; no measurement is recorded.
inline constexpr int kMostSweepRounds = 256;

/// Least number of stretches into which the way over a mesh is divided where it is longer than the shape: in
/// each only triangles within reach of it are swept. Chosen by hand; no measurement is recorded.
inline constexpr Real kSweepStretches = Real(16);

/// Halvings of the time in which the middle of a shape got behind a face. Chosen by hand; no measurement is
/// recorded.
inline constexpr int kBehindFaceHalvings = 20;

/// How often a body is clamped in a step, until it stands (docs/decisions/0006). Smaller: in a crowd that
/// moves fast as a whole bodies stand and are run into. Larger: more sweeps. No measurement of the value
/// itself is recorded.
inline constexpr int kMostClamps = 4;

}  // namespace hooke::collision
