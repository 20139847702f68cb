#include "solver/body/joint_body.h"

#include "base/assert.h"
#include "solver/body/body_motion.h"
#include "state/body_frames.h"
#include "state/hooks.h"

namespace hooke::solver {

using state::HookPlace;

JointBody joint_body(const state::Bodies& bodies, std::uint32_t row) {
  if (row == HookPlace::kWorld) return {};
  HOOKE_ASSERT(row < bodies.motion.size());
  const state::MotionRecord& m = bodies.motion[row];
  JointBody body;
  body.inverse_mass = static_cast<double>(m.inverse_mass);
  if (m.inverse_mass > Real(0)) body.scale = math::in_double(bodies.scale[row]);
  body.center = bodies.center[row] + vector_cast<double>(m.dx);
  body.rotation = math::in_double(bodies.rotation[row]);
  if (!(m.inverse_mass > Real(0)) || !is_gyroscopic_now(bodies, row)) {
    const DVec3 theta = body.scale * vector_cast<double>(m.theta_scaled);
    body.rotation = math::quaternion_of(theta) * body.rotation;
  }
  body.v = vector_cast<double>(m.v);
  body.omega_scaled = vector_cast<double>(m.omega_scaled);
  return body;
}

JointBody joint_body_now(const state::Bodies& bodies, std::uint32_t row) {
  JointBody body = joint_body(bodies, row);
  if (!(body.inverse_mass > 0) || !is_gyroscopic_now(bodies, row)) return body;
  const DVec3 omega = body.scale * body.omega_scaled;
  body.scale = math::in_double(inertia_scale(bodies.mass[row], bodies.rotation[row]));
  body.omega_scaled = math::inverse(body.scale) * omega;
  return body;
}

void set_joint_velocity(DVec3 v, DVec3 omega_scaled, DVec3 angular_momentum, std::uint32_t row,
                        state::Bodies& bodies) {
  state::MotionRecord& m = bodies.motion[row];
  HOOKE_ASSERT(m.inverse_mass > Real(0) && bodies.asleep[row] == 0);
  state::FreeMotionRecord& free = bodies.free_motion[row];
  const Vec3 by_contacts = m.v - free.v;
  const Vec3 turn_by_contacts = m.omega_scaled - free.omega_scaled;
  m.v = vector_cast<Real>(v);
  m.omega_scaled = vector_cast<Real>(omega_scaled);
  free.v = m.v - by_contacts;
  free.omega_scaled = m.omega_scaled - turn_by_contacts;
  bodies.angular_momentum[row] += vector_cast<Real>(angular_momentum);
}

void set_joint_velocity(const JointBody& before, DVec3 v, DVec3 omega_scaled, std::uint32_t row,
                        state::Bodies& bodies) {
  const DVec3 change = math::inverse(before.scale) * (omega_scaled - before.omega_scaled);
  if (is_gyroscopic_now(bodies, row))
    omega_scaled = math::inverse(math::in_double(bodies.scale[row])) * (before.scale * omega_scaled);
  set_joint_velocity(v, omega_scaled, change, row, bodies);
}

}  // namespace hooke::solver
