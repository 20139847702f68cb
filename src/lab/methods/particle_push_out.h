#pragma once

#include "lab/system/system.h"

#include <vector>

namespace hooke::lab {

/// The static bodies of a World, and how points of one object answer them.
struct Bodies {
  struct Entry {
    state::ColliderShape shape;
    Pose pose;            ///< Of the shape's frame.
    double friction = 0;  ///< Of the pair, sqrt(a b).
  };
  std::vector<Entry> entries;  ///< Those that collide.
};

[[nodiscard]] Bodies bodies_near(const state::Tables& tables, const state::Deformable& object);

/// Puts each free point that is inside a body back on its surface. With n out of the surface, it loses its
/// velocity into it, and of the rest what friction takes (restitution 0, Coulomb):
///
///     v -= n.v n  where n.v < 0;   |v_t| falls by at most mu times that
///
/// Distances have the engine's own precision. Returns whether anything was moved.
bool push_out(const System& system, const Bodies& bodies, State& y);

}  // namespace hooke::lab
