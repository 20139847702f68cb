#pragma once

#include "hooke/math.h"

#include "collision/manifold/manifold_points.h"
#include "state/manifolds.h"

#include <span>

namespace hooke::collision {

/// Where the bodies' centers of mass are in the frame of a meeting.
struct ContactFrame {
  Vec3 center_a = {};
  Vec3 center_b = {};
};

/// Reduces a meeting to a manifold's points, and carries the impulses of the last step's manifold over: by
/// key, then by the nearest anchor within 2 cm. `old` is null where there was none; one whose normal has
/// turned by more than 30 degrees gives nothing.
void make_points(ContactResult& result, Real margin, const ContactFrame& frame, const state::Manifold* old,
                 state::Manifold& manifold);

}  // namespace hooke::collision
