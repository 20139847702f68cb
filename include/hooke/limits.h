#pragma once

/// \file
/// Which numbers the engine takes. A number beyond these limits comes back as an Error that names the field,
/// the value and the limit. The limits are wide: within them no call overflows. A step that combines several
/// numbers near them may overflow; StepReport::rows_quarantined then counts what was put back.

namespace hooke::limits {

/// Largest distance of a place from the world's origin, along each axis [m]. Places of bodies and origins of
/// objects are doubles, exact to 1e-7 m there; boxes around bodies are floats, and grow by 64 m at 1e9 m.
inline constexpr double kPlace = 1e9;
/// Smallest size of a shape, rope, cloth or solid [m].
inline constexpr double kLeastSize = 1e-6;
/// Largest size of a shape, rope, cloth or solid, and largest coordinate of a mesh [m].
inline constexpr double kSize = 1e6;
/// Largest component of any velocity [m/s].
inline constexpr double kSpeed = 1e9;
/// Largest component of an angular velocity [rad/s], and largest angle that may be given [rad].
inline constexpr double kSpin = 1e6;
/// Largest acceleration of gravity and of fields: uniform, suction, vortex [m/s^2].
inline constexpr double kAcceleration = 1e6;
/// Smallest mass of a body, or of all points of an object together [kg].
inline constexpr double kLeastMass = 1e-9;
/// Largest mass of a body, or of all points of an object together [kg].
inline constexpr double kMass = 1e12;
/// Largest component of a force [N] or torque [N m] that is applied, alone and summed over a step, and of an
/// impulse [N s].
inline constexpr double kForce = 1e15;
/// Largest stiffness that is not kRigid [N/m], [N m/rad].
inline constexpr double kStiffness = 1e30;
/// Largest damping [N s/m], largest stiffness against bending and twist [N m], [N m^2], and largest elastic
/// modulus of a rope [Pa].
inline constexpr double kResistance = 1e18;
/// Shortest step that World::step takes [s].
inline constexpr double kShortestStep = 1e-9;
/// Longest step that World::step takes [s].
inline constexpr double kLongestStep = 1e3;

}  // namespace hooke::limits
