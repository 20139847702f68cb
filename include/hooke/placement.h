#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include <cstdint>

/// \file
/// A whole arrangement put somewhere else: the same scene, turned and moved. Everything a World can hold is
/// described by a struct of hooke/desc.h; `placed` gives the description of the same thing at its new place.

namespace hooke {

/// Where the frame of an arrangement lies in the world: turned about its own origin, then moved.
struct Placement {
  Quaternion<double> rotation = {};  ///< Of unit length.
  DVec3 position = {};               ///< Of the frame's origin [m].

  friend bool operator==(const Placement&, const Placement&) = default;

  /// A point of the arrangement, in the world [m].
  [[nodiscard]] DVec3 point(DVec3 own) const { return position + rotate(rotation, own); }
  /// A direction, velocity or force of the arrangement, in the world.
  [[nodiscard]] DVec3 direction(DVec3 own) const { return rotate(rotation, own); }
  template <class T>
  [[nodiscard]] Vector3<T> direction(Vector3<T> own) const {
    return vector_cast<T>(rotate(rotation, vector_cast<double>(own)));
  }
  /// A point of the world, in the arrangement's frame [m].
  [[nodiscard]] DVec3 own_point(DVec3 world) const { return rotate(conjugate(rotation), world - position); }
  [[nodiscard]] DVec3 own_direction(DVec3 world) const { return rotate(conjugate(rotation), world); }
};

// The same thing, placed. With the placement of a default Placement the description comes back as it is, bit
// for bit. What is given in the frame of a body, a mesh or a solid needs no change and keeps its value.

/// Gravity and wind turn too. Gusts do not turn with the wind: WindDesc ties them to places of the world.
[[nodiscard]] WorldDesc placed(WorldDesc desc, const Placement& at);
[[nodiscard]] WindDesc placed(WindDesc desc, const Placement& at);
[[nodiscard]] MotionDesc placed(MotionDesc desc, const Placement& at);
[[nodiscard]] BodyDesc placed(BodyDesc desc, const Placement& at);
[[nodiscard]] RopeDesc placed(RopeDesc desc, const Placement& at);
[[nodiscard]] ClothDesc placed(ClothDesc desc, const Placement& at);
[[nodiscard]] SolidDesc placed(SolidDesc desc, const Placement& at);
[[nodiscard]] ParticlesDesc placed(ParticlesDesc desc, const Placement& at);
/// A second axis that was left open is any one across the first, before and after.
[[nodiscard]] HookDesc placed(HookDesc desc, const Placement& at);
/// The height of a liquid's surface is counted against `gravity`, that of the world it is placed in.
[[nodiscard]] FieldDesc placed(FieldDesc desc, const Placement& at, Vec3 gravity);

/// A placement to try an arrangement in any direction: any rotation is as likely as any other, and the
/// position lies within 100 m, across `gravity` as it is after turning, so that heights above the origin stay
/// the same.
[[nodiscard]] Placement random_placement(std::uint32_t seed, Vec3 gravity);

}  // namespace hooke
