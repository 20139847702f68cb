#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include <cstdint>

/// \file
/// Puts a whole arrangement somewhere else: the same scene, turned and moved. A struct of hooke/desc.h
/// describes each thing that a World can hold; `placed` gives the description of the same thing at its new
/// place.

namespace hooke {

/// Where the frame of an arrangement lies in the world: turned about its own origin, then moved.
struct Placement {
  Quaternion<double> rotation = {};  ///< Rotation of the frame, of unit length.
  DVec3 position = {};               ///< Place of the frame's origin in the world [m].

  friend bool operator==(const Placement&, const Placement&) = default;

  /// A point of the arrangement, in the world [m].
  [[nodiscard]] DVec3 point(DVec3 own) const { return position + rotate(rotation, own); }
  ///@{
  /// A direction, velocity or force of the arrangement, in the world. It turns in double.
  [[nodiscard]] DVec3 direction(DVec3 own) const { return rotate(rotation, own); }
  template <class T>
  [[nodiscard]] Vector3<T> direction(Vector3<T> own) const {
    return vector_cast<T>(rotate(rotation, vector_cast<double>(own)));
  }
  ///@}
  /// A point of the world, in the arrangement's frame [m].
  [[nodiscard]] DVec3 own_point(DVec3 world) const { return rotate(conjugate(rotation), world - position); }
  /// A direction, velocity or force of the world, in the arrangement's frame.
  [[nodiscard]] DVec3 own_direction(DVec3 world) const { return rotate(conjugate(rotation), world); }
};

/// Describes the world for the placed arrangement: gravity and wind turn. Gusts do not turn with the wind, as
/// WindDesc ties them to places of the world.
[[nodiscard]] WorldDesc placed(WorldDesc desc, const Placement& at);
///@{
/// Describes the same thing at its new place. A default Placement gives the description back, bit for bit.
/// What is given in the frame of a body, a mesh or a solid needs no change and keeps its value.
[[nodiscard]] WindDesc placed(WindDesc desc, const Placement& at);
[[nodiscard]] MotionDesc placed(MotionDesc desc, const Placement& at);
[[nodiscard]] BodyDesc placed(BodyDesc desc, const Placement& at);
[[nodiscard]] RopeDesc placed(RopeDesc desc, const Placement& at);
[[nodiscard]] ClothDesc placed(ClothDesc desc, const Placement& at);
[[nodiscard]] SolidDesc placed(SolidDesc desc, const Placement& at);
[[nodiscard]] ParticlesDesc placed(ParticlesDesc desc, const Placement& at);
///@}
/// Describes the same hook at its new place. A second axis that is not given stays so, and is again any
/// direction across the first.
[[nodiscard]] HookDesc placed(HookDesc desc, const Placement& at);
/// Describes the same field at its new place. `gravity` [m/s^2] is that of the world it is placed in: the
/// height of a liquid's surface counts against it.
[[nodiscard]] FieldDesc placed(FieldDesc desc, const Placement& at, Vec3 gravity);

/// Draws a placement by `seed`, to try an arrangement in any direction. Every rotation is equally likely
/// (Shoemake 1992, Uniform random rotations). The position is drawn from a cube of 200 m about the origin and
/// moved along the turned `gravity` until it is level with the origin: heights above the origin stay the
/// same.
[[nodiscard]] Placement random_placement(std::uint32_t seed, Vec3 gravity);

}  // namespace hooke
