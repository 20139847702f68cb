#pragma once

#include "hooke/world.h"

#include "collision/continuous/continuous_sweep.h"
#include "geometry/box.h"
#include "state/bodies.h"
#include "state/colliders.h"

#include <cstdint>

namespace hooke::collision {

/// The smallest box along the world's axes around a shape whose frame is `pose`, rounded outward to float; of
/// a mesh, around the box of its frame. A half-space fills the world.
[[nodiscard]] geometry::Box bounds_of(const state::ColliderShape& shape, const Pose& pose);

/// Around what a shape reaches: half of the distance from which contacts are kept [m].
inline constexpr Real kReachMargin = Real(0.01);

/// What a collider's shape can reach within `dt` [s] at its body's speed, and kReachMargin around it. Two
/// shapes whose reaches do not overlap are more than twice that apart at the end of the step.
[[nodiscard]] geometry::Box reach_of(const state::Bodies& bodies, const state::Colliders& colliders,
                                     std::uint32_t collider, Real dt);

/// What it does reach on a path, and kReachMargin around it.
[[nodiscard]] geometry::Box reach_of(const state::Colliders& colliders, std::uint32_t collider,
                                     const Path& path);

}  // namespace hooke::collision
