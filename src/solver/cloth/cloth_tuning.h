#pragma once

#include "hooke/math.h"

#include <cstdint>

/// \file
/// Constants of the solution of cloths under loads that decide accuracy, robustness or cost. docs/tuning.md
/// says how to try another value.

namespace hooke::solver {

/// Largest stiffness of a row, over that with which its two points answer an impulse [ratio]: h^2 k over
/// their reduced mass. Rigid springs and limits have it.
inline constexpr Real kMostRowStiffness = Real(2e4);

/// Share of the inverse of a point's own block that smoothing goes along [ratio]. Above about 0.7 points
/// whose neighbors go the same way overshoot.
inline constexpr Real kSmoothing = Real(0.6);

/// Stiffness of a coarser grid over that of the rows between its points [ratio]. What moves all points of a
/// cell alike strains the rows between cells more than a smooth motion does, which 1 would take for real; 0.7
/// took 12 % fewer directions in a sheet that hangs on two corners.
inline constexpr Real kCoarseStiffness = Real(0.7);

/// Sweeps of smoothing on the coarsest grid.
inline constexpr int kCoarsestSweeps = 4;

/// A solution ends when what it lacks is, in the norm of energy, as if each point had this share of an edge
/// per substep as velocity [ratio].
inline constexpr double kClothError = 0.003;

/// Most directions of a solution for one set of contacts and limits.
inline constexpr int kMostClothDirections = 16;

/// Most sets of limits that are tried in a substep.
inline constexpr int kMostClothRounds = 4;

/// Largest speed at which errors of length are taken back [m/s], as kRigidSpringRecoverySpeed.
inline constexpr Real kClothRecoverySpeed = Real(100);

// Which cloths are solved at once.

/// Share of its length by which a row is too long from which on its cloth is solved at once [ratio]; and by
/// which sweeps would leave it too long below which that ends. Smaller: flags in the wind, which hardly gain
/// by it, cost twice as much.
inline constexpr Real kStretchFrom = Real(0.01);
inline constexpr Real kStretchUntil = Real(0.005);

/// Fewest points of a cloth that is solved at once. A chain of few rows hardly adds compliance, and a flap of
/// four points came to rest less exactly.
inline constexpr std::uint32_t kLeastClothPoints = 64;

/// For how long rows must have been below kStretchUntil [s]: each change copies the rows of the cloth anew.
inline constexpr Real kCalmTime = Real(2);

}  // namespace hooke::solver
