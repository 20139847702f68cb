#pragma once

/// \file
/// Constants of cloths that are solved as a whole. docs/tuning.md says how to try another value.

namespace hooke::solver {

/// Mass of a point, with what presses on it or hangs on it, over that of a yarn of its cloth, from which on
/// the cloth is solved as a whole [ratio]. Larger: a flag of 0.2 kg with 100 g on its edge, 12 yarns, was
/// stretched by 10 % and had 2.8 times its energy. Smaller: with 30 g yarns held it to 0.7 %.
inline constexpr double kLoadOfYarns = 4;

/// Stiffness of what is rigid, over the mass of the cloth with its loads and the square of the substep
/// [ratio]. Smaller: limits yield, by 4e-5 m in a substep of 2 ms under 1 g if it is 1. Larger: with 4 the
/// flag above took a third longer.
inline constexpr double kRigidOfCloth = 1;

/// Share of the first residual down to which a loaded cloth is solved [ratio], and how far points may still
/// want to move in a substep, over the mean length of a spring [ratio]. Smaller: with 0.01 for the first a
/// flag under 5 kg takes twice the time, and is stretched as much. Larger: without the second a flag of 0.2
/// kg under 50 kg gained half of its energy, as light points were off by 60 m/s.
inline constexpr double kLoadedClothError = 0.1;
inline constexpr double kLoadedClothLengthError = 2e-3;

/// Share of its residual to which a step of Newton's method is solved [ratio]. Chosen by hand; no measurement
/// is recorded.
inline constexpr double kClothStepError = 0.1;

/// Steps of Newton's method in a substep and halvings of a step, at most. The flag takes 1.3 steps under 5
/// kg; 16 where its springs are so soft that limits hold all of 20 kg. Smaller: what is left stretches.
inline constexpr int kMostClothSteps = 30;
inline constexpr int kMostClothHalvings = 10;

/// Way of a body against a cloth in a substep, over the mean length of a spring, and length of a spring over
/// that at rest, above which bodies are not solved with the cloth [ratio]: contacts alone stop what is so
/// fast, and untangle what a shot has drawn out. Without the second a free cloth that a ball of 1000 m/s hit
/// stayed tangled, with 2.5 times all energy.
inline constexpr double kMostPressWay = 0.5;
inline constexpr double kMostPressedLength = 2;

/// Times that points are let go or taken hold of in a substep, at most. Chosen by hand; no measurement is
/// recorded.
inline constexpr int kMostPressRenewals = 10;

/// Share of the most friction up to which a point sticks at first to what presses on it, and error of
/// friction where it slides [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr double kStickingShareOnCloth = 0.95;
inline constexpr double kFrictionErrorOnCloth = 0.1;

/// Drag of friction on a point, over the mass with which springs resist its motion, from which on the point
/// sticks [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr double kMostDragOnCloth = 100;

/// Mass of a solid that presses on points of a cloth, over theirs, that its solution takes at most [ratio]:
/// what is held has no other bound. Chosen by hand; no measurement is recorded.
inline constexpr double kMostLoadOnCloth = 5e3;

/// Momentum that a cloth may lack as a whole, over what its springs have changed [ratio]; what is left is
/// shared out by mass. Larger: with 1e-2 a point of a hammock went through the floor.
inline constexpr double kClothMotionError = 1e-3;

/// Mass of a point with what it is hooked to, over its own, from which on that does not give way [ratio]: it
/// holds the cloth, and takes up momentum. It is under the inverse of kLeastMassShare, by which masses that
/// hooks lend are bounded.
inline constexpr double kMassThatHolds = 5e4;

/// Passes over single springs in a substep, at most [1]; one takes about 4 ns. Smaller: what is left
/// stretches. Larger: what comes to no end costs as much.
inline constexpr double kMostClothWork = 2e6;

}  // namespace hooke::solver
