#pragma once

#include "parallel/thread_pool.h"
#include "state/bodies.h"
#include "state/manifolds.h"

#include <span>
#include <vector>

/// \file
/// Manifolds of pairs that hardly move against each other are carried along instead of being made anew.

namespace hooke::collision {

/// How a body moved since the narrow phase last saw it.
struct SmallMotion {
  Vec3 way = {};             ///< Of the center of mass [m].
  Mat3 turn = {{}, {}, {}};  ///< How far points moved from their place about the center by turning.
  Real reach = Real(0);      ///< No point of the body turned farther than this [m].
  Real tolerance = Real(0);  ///< What two bodies may move against each other before a new test [m].
};

/// The motions of all bodies since `seen`, which becomes what is seen now.
std::vector<SmallMotion> motions_since(parallel::ThreadPool& pool, const state::Bodies& bodies,
                                       std::vector<state::SeenPose>& seen);

/// How far points of the two can have moved against each other [m].
[[nodiscard]] Real drift_of(const SmallMotion& a, const SmallMotion& b);

/// Moves points and normals along with their bodies; the normal belongs to `fixed`, A or B. Separations
/// follow to first order in what the bodies turned against each other.
void carry_along(const SmallMotion& a, const SmallMotion& b, bool fixed_is_a, state::Manifold& manifold);

}  // namespace hooke::collision
