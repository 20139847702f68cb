#pragma once

#include "hooke/world.h"

#include "collision/continuous/continuous_sweep.h"
#include "collision/continuous/continuous_tuning.h"
#include "geometry/box.h"
#include "state/bodies.h"
#include "state/colliders.h"

#include <cstdint>

namespace hooke::collision {

/// The smallest box along the world's axes around a shape whose frame is `pose`, rounded outward to float.
/// For a mesh it holds the box of its frame. A half-space fills the world.
[[nodiscard]] geometry::Box bounds_of(const state::ColliderShape& shape, const Pose& pose);

/// The box that a collider's shape can reach within `dt` [s] at its body's speed, grown by kReachMargin. Two
/// shapes whose boxes do not overlap are more than twice that margin apart at the end of the step.
[[nodiscard]] geometry::Box reach_of(const state::Bodies& bodies, const state::Colliders& colliders,
                                     std::uint32_t collider, Real dt);

/// The box that a collider's shape does reach on a path, grown by kReachMargin.
[[nodiscard]] geometry::Box reach_of(const state::Colliders& colliders, std::uint32_t collider,
                                     const Path& path);

}  // namespace hooke::collision
