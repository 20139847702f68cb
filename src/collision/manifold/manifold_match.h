#pragma once

#include "hooke/math.h"

#include "collision/manifold/manifold_points.h"
#include "state/manifolds.h"

#include <span>

namespace hooke::collision {

/// Positions of the bodies' centers of mass in the frame of a contact result.
struct ContactFrame {
  Vec3 center_a = {};
  Vec3 center_b = {};
};

/// Reduces a contact result to a manifold's points, and carries the impulses of the last step's manifold
/// over: by key, then by the nearest anchor within 2 cm. `old` is null if there was none. An old manifold
/// whose normal has turned by more than 30 degrees gives nothing.
void make_points(ContactResult& result, Real margin, const ContactFrame& frame, const state::Manifold* old,
                 state::Manifold& manifold);

}  // namespace hooke::collision
