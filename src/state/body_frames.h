#pragma once

#include "hooke/math.h"
#include "hooke/world.h"

#include "state/bodies.h"
#include "state/colliders.h"

#include <cstdint>

/// \file
/// Where bodies and their shapes are: from the columns to frames in the world.

namespace hooke::state {

/// The body's own frame, at the start of the step.
inline Pose frame_of_body(const Bodies& bodies, std::uint32_t row) {
  const Quat rotation = bodies.rotation[row];
  return {bodies.center[row] - vector_cast<double>(rotate(rotation, bodies.mass[row].center)), rotation};
}

/// The frame of a collider's shape, at the start of the step.
inline Pose frame_of_collider(const Bodies& bodies, const Colliders& colliders, std::uint32_t row) {
  const std::uint32_t body = colliders.body[row];
  const Quat rotation = bodies.rotation[body];
  return {bodies.center[body] + vector_cast<double>(rotate(rotation, colliders.position[row])),
          rotation * colliders.rotation[row]};
}

/// L = R I R^T omega, of a body whose frame is turned by `rotation`.
inline Vec3 angular_momentum_of(const BodyMass& mass, Quat rotation, Vec3 omega) {
  const Quat axes = rotation * mass.principal;
  const Vec3 local = rotate(conjugate(axes), omega);
  return rotate(axes, {mass.inertia.x * local.x, mass.inertia.y * local.y, mass.inertia.z * local.z});
}

}  // namespace hooke::state
