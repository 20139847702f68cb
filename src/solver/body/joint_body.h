#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"
#include "state/bodies.h"

#include <cstdint>

/// \file
/// A body as joints see it.

namespace hooke::solver {

/// An end of a hook in the middle of a step, in double: errors of joints are small differences.
struct JointBody {
  DVec3 center = {};  ///< Present center of mass [m].
  DVec3 ahead = {};   ///< From where impulses act on it to `center`, where it will be; zero for now [m].
  Quaternion<double> rotation = {};
  DVec3 v = {};
  DVec3 omega_scaled = {};
  math::Symmetric3<double> scale = math::Symmetric3<double>::diagonal(1);  ///< S; 1 where nothing moves it.
  double inverse_mass = 0;                                                 ///< 0 where nothing moves it.
};

/// The body in `row` after the part of the step that is done; HookPlace::kWorld gives the world at rest.
[[nodiscard]] JointBody joint_body(const state::Bodies& bodies, std::uint32_t row);

/// The same with the present S instead of that of the step's start. They differ for a body that makes a
/// gyroscopic turn: torques on a thin bar with its inertia of another time would make energy.
[[nodiscard]] JointBody joint_body_now(const state::Bodies& bodies, std::uint32_t row);

/// Gives the body in `row`, which was `before` by joint_body_now, the velocity that joints want. Their
/// change counts as free motion, not as an effect of contacts: it is not repeated as the contacts' warm
/// start.
void set_joint_velocity(const JointBody& before, DVec3 v, DVec3 omega_scaled, std::uint32_t row,
                        state::Bodies& bodies);

/// Does the same from velocities in the scale of the step's start, and the change of angular momentum.
void set_joint_velocity(DVec3 v, DVec3 omega_scaled, DVec3 angular_momentum, std::uint32_t row,
                        state::Bodies& bodies);

}  // namespace hooke::solver
