#pragma once

#include "hooke/math.h"

#include "collision/deformable/deformable_tuning.h"
#include "geometry/box.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// The shapes of bodies that the points of an object may touch, and their frames as the object sees them.

namespace hooke::collision {

inline constexpr Real kNoContact = Real(1e9);  ///< Distance of a row that does not act now [m].

/// A shape's frame as one object sees it: x_shape = R^T (x - offset), x relative to the object's origin.
struct Frame {
  const state::ColliderShape* shape = nullptr;
  Quat rotation = {};
  Vec3 offset = {};
  Vec3 center = {};         ///< Center of mass of the body.
  Vec3 belt_velocity = {};  ///< Velocity of a conveyor's surface relative to its body [m/s].
  Real speed = Real(0);     ///< Upper bound of the speed of the body's points [m/s].
  geometry::Box box = {};   ///< Holds the shape during this step.

  [[nodiscard]] Vec3 to_shape_direction(Vec3 direction) const {
    return rotate(conjugate(rotation), direction);
  }
  [[nodiscard]] Vec3 to_shape(Vec3 x) const { return to_shape_direction(x - offset); }
  [[nodiscard]] Vec3 to_world(Vec3 direction) const { return rotate(rotation, direction); }
};

[[nodiscard]] Frame frame_of(const state::Tables& tables, std::uint32_t collider,
                             const state::Deformable& object);

/// Distance from a shape to a position; searched up to `reach` from a mesh [m].
[[nodiscard]] Real distance_to(const Frame& frame, Vec3 place, Real reach);

/// Whether particles may touch the body.
[[nodiscard]] bool is_solid(const state::Tables& tables, std::uint32_t body);

/// Rows of the colliders that particles may touch, in ascending order.
void list_solid_colliders(const state::Tables& tables, std::vector<std::uint32_t>& rows);

/// Lists those of `colliders` whose boxes, which hold their motion in this step, come within `reach` [m] of
/// the object's points.
void list_near_colliders(const state::Tables& tables, std::span<const std::uint32_t> colliders,
                         const state::Deformable& object, Real reach, std::vector<std::uint32_t>& near);

/// Makes the frames of `colliders` as one object sees them, once for all of its particles.
void make_frames(const state::Tables& tables, std::span<const std::uint32_t> colliders,
                 const state::Deformable& object, std::vector<Frame>& frames);

/// A particle and a body that a hook keeps from touching.
using Hooked = std::pair<std::uint32_t, std::uint32_t>;

/// A solid that a hook holds to a body which it may touch. Where it was nearer than by its thickness when it
/// was hooked, it touches the body at that distance: hook and contact would strain against each other.
struct HookedNear {
  std::uint32_t object = 0;  ///< Row of the object.
  std::uint32_t body = 0;    ///< Row of the body.
  Real distance = Real(0);   ///< At which its points touch the body, state::Hook::rest_distance [m].
};
void list_hooked_near(const state::Tables& tables, std::vector<HookedNear>& near);

/// The radius with which points of an object touch a body, of points with `radius` [m].
[[nodiscard]] Real touching_radius(const std::vector<HookedNear>& near, std::uint32_t object,
                                   std::uint32_t body, Real radius);

/// Lists the pairs that hooks hold together, with the points that were inside the body; for a rope along
/// which a body slides, all its points; for a point that a body holds, also the bodies that this one is
/// hooked to, and what is fixed to those. Sorted.
void list_hooked(const state::Tables& tables, std::vector<Hooked>& hooked);
[[nodiscard]] bool is_hooked(const std::vector<Hooked>& hooked, std::uint32_t particle, std::uint32_t body);

}  // namespace hooke::collision
