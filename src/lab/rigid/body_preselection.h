#pragma once

#include "geometry/mesh/preselection.h"
#include "lab/rigid/dense.h"

/// \file
/// Which bodies may meet within a step, by the bounding volumes of CollisionOptions::preselection.

namespace hooke::lab {

/// The volumes of one kind around a body's shapes, seen from its center of mass in its principal axes.
struct BodyVolumes {
  geometry::BoundingVolumes volumes = {};
  double skin = 0;             ///< The thickest of its shapes, which the volumes are without [m].
  bool is_everywhere = false;  ///< It has a half-space.
};

[[nodiscard]] BodyVolumes make_body_volumes(const RigidBody& body, Preselection kind);

/// A body within a step.
struct MovingVolumes {
  const BodyVolumes& volumes;
  const DenseMotion& motion;
  double radius = 0;  ///< RigidBody::radius [m].
};

/// False if the bodies cannot come nearer than `reach` [m] within the step: the volumes stand where they are
/// in its middle, apart by more than their points can move against each other from there.
[[nodiscard]] bool may_collide(Preselection kind, const MovingVolumes& a, const MovingVolumes& b,
                               double reach);

}  // namespace hooke::lab
