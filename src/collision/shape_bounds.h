#pragma once

#include "hooke/world.h"

#include "collision/continuous_sweep.h"
#include "geometry/box.h"
#include "state/bodies.h"
#include "state/colliders.h"

#include <cstdint>

namespace hooke::collision {

/// The smallest box along the world's axes around a shape whose frame is `pose`, rounded outward to float; of
/// a mesh, around the box of its frame. A half-space fills the world.
[[nodiscard]] geometry::Box bounds_of(const state::ColliderShape& shape, const Pose& pose);

/// What a collider's shape can reach within `dt` [s] at its body's speed, and 1 cm around it. Two shapes
/// whose reaches do not overlap are more than 2 cm apart at the end of the step.
[[nodiscard]] geometry::Box reach_of(const state::Bodies& bodies, const state::Colliders& colliders,
                                     std::uint32_t collider, Real dt);

/// What it does reach on a path, and 1 cm around it.
[[nodiscard]] geometry::Box reach_of(const state::Colliders& colliders, std::uint32_t collider,
                                     const Path& path);

}  // namespace hooke::collision
