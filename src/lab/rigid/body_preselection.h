#pragma once

#include "geometry/mesh/preselection.h"
#include "lab/rigid/dense.h"

/// \file
/// Finds which bodies may collide within a step, by the bounding volumes of CollisionOptions::preselection.

namespace hooke::lab {

/// These are the bounding volumes of one kind around a body's shapes, in the frame of its center of mass and
/// principal axes.
struct BodyVolumes {
  geometry::BoundingVolumes volumes = {};
  double skin = 0;             ///< The largest skin of its shapes, which the volumes do not include [m].
  bool is_everywhere = false;  ///< The body has a half-space.
};

[[nodiscard]] BodyVolumes make_body_volumes(const RigidBody& body, Preselection kind);

/// This describes the volumes and the motion of a body in a step.
struct MovingVolumes {
  const BodyVolumes& volumes;
  const DenseMotion& motion;
  double radius = 0;  ///< RigidBody::radius [m].
};

/// Returns false only if the bodies cannot come nearer than `reach` [m] within the step. The volumes are
/// compared at the middle of the step, with a margin for how far their points can move from there.
[[nodiscard]] bool may_collide(Preselection kind, const MovingVolumes& a, const MovingVolumes& b,
                               double reach);

}  // namespace hooke::lab
