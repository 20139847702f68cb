#pragma once

/// \file
/// What numbers the engine takes. Whatever is given to it beyond these comes back as an Error that names the
/// field, the value and the limit. They are wide: within them nothing that a call computes overflows. What a
/// step makes of numbers near them, together, may; then StepReport counts it as quarantined.

namespace hooke::limits {

/// Of places, along each axis, from the origin [m]. Places of bodies and origins of objects are doubles, true
/// to 1e-7 m there; but boxes around bodies are floats, which at 1e9 m grow by 64 m.
inline constexpr double kPlace = 1e9;
/// Of sizes of shapes, of ropes, cloths and solids [m], and of coordinates of a mesh.
inline constexpr double kLeastSize = 1e-6;
inline constexpr double kSize = 1e6;
/// Of velocities, of anything [m/s].
inline constexpr double kSpeed = 1e9;
/// Of angular velocities [rad/s], and of angles that are given [rad].
inline constexpr double kSpin = 1e6;
/// Of accelerations: gravity, uniform fields, suction, vortices [m/s^2].
inline constexpr double kAcceleration = 1e6;
/// Of masses [kg], of a body or of all points of an object.
inline constexpr double kLeastMass = 1e-9;
inline constexpr double kMass = 1e12;
/// Of forces that are applied [N], and torques [N m], each by itself and all of a step together.
inline constexpr double kForce = 1e15;
/// Of stiffnesses that are not kRigid [N/m], [N m/rad].
inline constexpr double kStiffness = 1e30;
/// Of dampings [N s/m], of what resists bending and twist [N m], [N m^2], and of elastic moduli of ropes
/// [Pa].
inline constexpr double kResistance = 1e18;
/// Of a step [s].
inline constexpr double kShortestStep = 1e-9;
inline constexpr double kLongestStep = 1e3;

}  // namespace hooke::limits
