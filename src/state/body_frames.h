#pragma once

#include "hooke/math.h"
#include "hooke/world.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <algorithm>
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
  HOOKE_ASSERT(body < bodies.center.size());  // no hole
  const Quat rotation = bodies.rotation[body];
  return {bodies.center[body] + vector_cast<double>(rotate(rotation, colliders.position[row])),
          rotation * colliders.rotation[row]};
}

/// Whether a free rotation of the body visibly moves its axis.
inline bool is_gyroscopic(const BodyMass& mass) {
  const auto [least, most] = std::minmax({mass.inertia.x, mass.inertia.y, mass.inertia.z});
  return most > Real(1.02) * least;
}

/// Whether the body makes a gyroscopic turn in this step. The column of rotations is up to date in the middle
/// of a step for such bodies; others rotate at the end of the step.
inline bool is_gyroscopic_now(const Bodies& bodies, std::uint32_t row) {
  return is_gyroscopic(bodies.mass[row]) && !bodies.frozen_inertia[row].on;
}

/// Center of mass and rotation in the middle of a step.
inline Pose pose_now(const Bodies& bodies, std::uint32_t row) {
  const MotionRecord& m = bodies.motion[row];
  const DVec3 center = bodies.center[row] + vector_cast<double>(m.dx);
  const bool turned = m.inverse_mass > Real(0) && is_gyroscopic_now(bodies, row);
  if (turned || m.theta_scaled == Vec3{}) return {center, bodies.rotation[row]};
  return {center, math::quaternion_of(bodies.scale[row] * m.theta_scaled) * bodies.rotation[row]};
}

/// Center of mass and rotation after `time` [s] more of motion_before_contacts.
inline Pose pose_after(const Bodies& bodies, std::uint32_t row, Real time) {
  const FreeMotionRecord motion = motion_before_contacts(bodies, row);
  const Pose now = pose_now(bodies, row);
  return {now.position + vector_cast<double>(time * motion.v),
          math::quaternion_of(bodies.scale[row] * (time * motion.omega_scaled)) * now.rotation};
}

/// Displacement of a point of a body since the start of the step, to first order in the rotation.
inline Vec3 displacement_of(const Bodies& bodies, std::uint32_t row, Vec3 lever) {
  const MotionRecord& m = bodies.motion[row];
  const Vec3 turn = m.inverse_mass > Real(0) ? bodies.scale[row] * m.theta_scaled : m.theta_scaled;
  return m.dx + cross(turn, lever);
}

/// Displacement of B's point relative to A's, at a point of a manifold.
inline Vec3 displacement_between(const Bodies& bodies, const Manifold& m, const ContactPoint& point) {
  return displacement_of(bodies, m.body_b, point.anchor_b) -
         displacement_of(bodies, m.body_a, point.anchor_a);
}

/// L = R I R^T omega, for a body whose frame is rotated by `rotation`.
inline Vec3 angular_momentum_of(const BodyMass& mass, Quat rotation, Vec3 omega) {
  const Quat axes = rotation * mass.principal;
  const Vec3 local = rotate(conjugate(axes), omega);
  return rotate(axes, {mass.inertia.x * local.x, mass.inertia.y * local.y, mass.inertia.z * local.z});
}

}  // namespace hooke::state
