#pragma once

#include "hooke/event.h"

#include "world/world_data.h"

#include <cstdint>

/// \file
/// Bodies that become soft, and rigid again (BodyDesc::yields). docs/decisions/0050-rigid-to-soft-and-back.md
/// says why it is done so.

namespace hooke::world {

/// Why a body yields.
struct Blow {
  DVec3 place = {};        ///< Where it was hit hardest [m].
  Real impulse = Real(0);  ///< [N s]
  double time = 0;         ///< [s]
};

/// Makes the body of a row of Tables::yielding soft, between steps, and lists the event. The solid has its
/// mass, its motion, its hooks, and the forces that wait for the next step. Returns false if its tetrahedra
/// have become too flat for a solid: it stays rigid then, and yields no more.
bool soften(WorldData& world, std::uint32_t row, const Blow& blow);

/// Lets the frames of bodies that are soft follow their solids, and makes those rigid that have been at rest
/// in themselves. It is called at the end of a step of `dt` [s].
void follow_soft_bodies(WorldData& world, double dt);

/// Removes what bodies are as solids, before the bodies are removed. `goes` says by body row which are.
void remove_soft_forms_of(const std::vector<std::uint8_t>& goes, state::Tables& tables);

/// Gives the points of a soft body the change of velocity [m/s] and of angular velocity [rad/s] of a rigid
/// motion about its center of mass.
void change_soft_motion(const state::Yielding& yielding, Vec3 v, Vec3 omega, state::Tables& tables);

/// Gives the points of a soft body forces for the next step that sum to a force [N] and a torque [N m] about
/// its center of mass, as a rigid body would take them.
void push_soft_body(const state::Yielding& yielding, Vec3 force, Vec3 torque, state::Tables& tables);

/// Moves and turns a soft body, so that its frame has this pose.
void place_soft_body(const state::Yielding& yielding, const Pose& pose, state::Tables& tables);

/// The change of angular velocity [rad/s] of a soft body by an angular impulse [N m s].
[[nodiscard]] Vec3 soft_spin(const state::Yielding& yielding, Vec3 angular_impulse,
                             const state::Tables& tables);

}  // namespace hooke::world
