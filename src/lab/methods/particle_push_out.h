#pragma once

#include "lab/system/system.h"

#include <vector>

namespace hooke::lab {

/// These are the static bodies of a World, which the points of one object cannot enter.
struct Bodies {
  struct Entry {
    state::ColliderShape shape;
    Pose pose;            ///< Pose of the shape's frame.
    double friction = 0;  ///< Friction of the pair, sqrt(a b).
  };
  std::vector<Entry> entries;  ///< The bodies that collide with the object.
};

[[nodiscard]] Bodies bodies_near(const state::Tables& tables, const state::Deformable& object);

/// Puts each free point that is inside a body back on its surface. With n out of the surface, the point loses
/// its velocity into the surface, and friction takes a part of the rest (restitution 0, Coulomb):
///
/// v -= n.v n  where n.v < 0;   |v_t| falls by at most mu times that
///
/// Distances have the engine's own precision. Returns whether anything was moved.
bool push_out(const System& system, const Bodies& bodies, State& y);

}  // namespace hooke::lab
