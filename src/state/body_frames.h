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

/// How a body has moved since the step began, at some time within it.
struct BodyMotion {
  Vec3 dx = {};            ///< Of the center of mass [m].
  Vec3 theta_scaled = {};  ///< Scaled rotation [sqrt(kg) m].
  Quat rotation = {};      ///< As in Bodies::rotation.
};

inline BodyMotion motion_now(const Bodies& bodies, std::uint32_t row) {
  return {bodies.motion[row].dx, bodies.motion[row].theta_scaled, bodies.rotation[row]};
}

/// Center of mass and rotation after that motion.
inline Pose pose_after(const Bodies& bodies, std::uint32_t row, const BodyMotion& motion) {
  const DVec3 center = bodies.center[row] + vector_cast<double>(motion.dx);
  const bool turned = bodies.motion[row].inverse_mass > Real(0) && is_gyroscopic_now(bodies, row);
  if (turned || motion.theta_scaled == Vec3{}) return {center, motion.rotation};
  return {center, math::quaternion_of(bodies.scale[row] * motion.theta_scaled) * motion.rotation};
}

/// Center of mass and rotation in the middle of a step.
inline Pose pose_now(const Bodies& bodies, std::uint32_t row) {
  return pose_after(bodies, row, motion_now(bodies, row));
}

/// Center of mass and rotation after `time` [s] more of motion_before_contacts.
inline Pose pose_after(const Bodies& bodies, std::uint32_t row, Real time) {
  const FreeMotionRecord motion = motion_before_contacts(bodies, row);
  const Pose now = pose_now(bodies, row);
  return {now.position + vector_cast<double>(time * motion.v),
          math::quaternion_of(bodies.scale[row] * (time * motion.omega_scaled)) * now.rotation};
}

/// Displacement of a point of a body by that motion, to first order in the rotation.
inline Vec3 displacement_of(const Bodies& bodies, std::uint32_t row, const BodyMotion& motion, Vec3 lever) {
  const bool is_scaled = bodies.motion[row].inverse_mass > Real(0);
  const Vec3 turn = is_scaled ? bodies.scale[row] * motion.theta_scaled : motion.theta_scaled;
  return motion.dx + cross(turn, lever);
}

/// The same since the start of the step.
inline Vec3 displacement_of(const Bodies& bodies, std::uint32_t row, Vec3 lever) {
  return displacement_of(bodies, row, motion_now(bodies, row), lever);
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

/// The angular velocity that belongs to an angular momentum [kg m^2/s] of such a body [rad/s].
inline Vec3 angular_velocity_of(const BodyMass& mass, Quat rotation, Vec3 momentum) {
  const Quat axes = rotation * mass.principal;
  const Vec3 l = rotate(conjugate(axes), momentum);
  return rotate(axes, {l.x / mass.inertia.x, l.y / mass.inertia.y, l.z / mass.inertia.z});
}

}  // namespace hooke::state
