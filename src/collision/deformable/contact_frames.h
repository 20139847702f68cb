#pragma once

#include "hooke/math.h"

#include "geometry/box.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Which shapes of bodies the points of an object may touch, and where they are as the object sees them.

namespace hooke::collision {

inline constexpr Real kParticleMargin = Real(0.02);  ///< By which contacts are looked for ahead [m].
inline constexpr Real kNoContact = Real(1e9);        ///< Distance of a row that does not hold now [m].

/// A shape's frame as one object sees it: x_shape = R^T (x - offset), x relative to the object's origin.
struct Frame {
  const state::ColliderShape* shape = nullptr;
  Quat rotation = {};
  Vec3 offset = {};
  Vec3 center = {};         ///< Of the body's mass.
  Vec3 belt_velocity = {};  ///< Of a conveyor's surface against its body [m/s].
  Real speed = Real(0);     ///< Of the body's fastest point, at most [m/s].
  geometry::Box box = {};   ///< Holds the shape on its way in this step.

  [[nodiscard]] Vec3 to_shape_direction(Vec3 direction) const {
    return rotate(conjugate(rotation), direction);
  }
  [[nodiscard]] Vec3 to_shape(Vec3 x) const { return to_shape_direction(x - offset); }
  [[nodiscard]] Vec3 to_world(Vec3 direction) const { return rotate(rotation, direction); }
};

[[nodiscard]] Frame frame_of(const state::Tables& tables, std::uint32_t collider,
                             const state::Deformable& object);

/// Distance from a shape to a place; looked for up to `reach` from a mesh [m].
[[nodiscard]] Real distance_to(const Frame& frame, Vec3 place, Real reach);

/// Whether particles may touch the body.
[[nodiscard]] bool is_solid(const state::Tables& tables, std::uint32_t body);

/// Rows of the colliders that particles may touch, in ascending order.
void list_solid_colliders(const state::Tables& tables, std::vector<std::uint32_t>& rows);

/// Those whose boxes, which hold their ways in this step, come within `reach` [m] of the object's points.
void list_near_colliders(const state::Tables& tables, std::span<const std::uint32_t> colliders,
                         const state::Deformable& object, Real reach, std::vector<std::uint32_t>& near);

/// The frames of `colliders` as one object sees them: made once for all of its particles.
void make_frames(const state::Tables& tables, std::span<const std::uint32_t> colliders,
                 const state::Deformable& object, std::vector<Frame>& frames);

/// A particle and a body that a hook keeps from touching.
using Hooked = std::pair<std::uint32_t, std::uint32_t>;

/// Those held together by hooks, with what was inside the body; all of a rope along which a body slides.
/// Sorted.
void list_hooked(const state::Tables& tables, std::vector<Hooked>& hooked);
[[nodiscard]] bool is_hooked(const std::vector<Hooked>& hooked, std::uint32_t particle, std::uint32_t body);

}  // namespace hooke::collision
