#include "collision/manifold/shape_placement.h"

namespace hooke::collision {

Convex place(const state::Colliders& colliders, std::uint32_t collider, Quat rotation) {
  const state::ColliderShape& shape = colliders.shape[collider];
  return {.shape = shape.shape,
          .center = rotate(rotation, colliders.position[collider]),
          .axes = matrix_of(normalize(rotation * colliders.rotation[collider])),
          .hull = shape.hull.get()};
}

PlacedMesh place_mesh(const state::ColliderShape& shape, const Convex& place, DVec3 from) {
  const DVec3 d = from - vector_cast<double>(place.center);
  const auto along = [&d](Vec3 axis) { return static_cast<Real>(dot(vector_cast<double>(axis), d)); };
  return {*shape.mesh, place.axes, {along(place.axes.x), along(place.axes.y), along(place.axes.z)}};
}

Real height_over(const Convex& half_space, DVec3 from) {
  return static_cast<Real>(
      dot(vector_cast<double>(half_space.axes.y), from - vector_cast<double>(half_space.center)));
}

}  // namespace hooke::collision
