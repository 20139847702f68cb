#include "lab/methods/particle_push_out.h"

#include "collision/distance/shape_gap.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>

namespace hooke::lab {

namespace {

using collision::Gap;

/// Returns the gap to the nearest triangle, or one beyond `reach` if there is none within it.
Gap gap_to_mesh(const state::Mesh& mesh, Vec3 x, Real reach) {
  std::vector<std::uint32_t> near;
  collision::find_triangles_near(mesh, x, reach, near);
  const std::optional<bool> inside = collision::is_inside(mesh, x);
  Gap best = {reach, {}};
  Real least = std::numeric_limits<Real>::infinity();
  for (const std::uint32_t triangle : near) {
    const collision::TriangleGap g = collision::gap_to_triangle(mesh, triangle, x);
    if (!(g.unsigned_distance < least)) continue;
    least = g.unsigned_distance;
    best = collision::gap_on_side(g, inside);
  }
  return best;
}

Gap gap_to(const Bodies::Entry& entry, DVec3 x, double radius) {
  const state::ColliderShape& shape = entry.shape;
  const Vec3 local = rotate(conjugate(entry.pose.rotation), vector_cast<Real>(x - entry.pose.position));
  // A point that is deeper than twice its radius and 5 cm inside a mesh without MeshTree::kPlanes stays
  // there.
  const Real reach = static_cast<Real>(2 * radius + 0.05);
  Gap gap = shape.shape.kind == ShapeKind::kMesh ? gap_to_mesh(*shape.mesh, local, reach)
                                                 : collision::gap_to_shape(shape.shape, local);
  gap.normal = rotate(entry.pose.rotation, gap.normal);
  return gap;
}

}  // namespace

Bodies bodies_near(const state::Tables& tables, const state::Deformable& object) {
  Bodies bodies;
  for (std::uint32_t c = 0; c < tables.colliders.body.size(); ++c) {
    const std::uint32_t body = tables.colliders.body[c];
    if (body == state::Colliders::kNoBody) continue;
    const state::BodyTraits& traits = tables.bodies.traits[body];
    if (traits.kind != BodyKind::kStatic || !traits.collides || traits.sensor) continue;
    const double friction = std::sqrt(static_cast<double>(object.friction) *
                                      static_cast<double>(tables.colliders.surface[c].friction));
    bodies.entries.push_back(
        {tables.colliders.shape[c], state::frame_of_collider(tables.bodies, tables.colliders, c), friction});
  }
  return bodies;
}

bool push_out(const System& system, const Bodies& bodies, State& y) {
  bool moved = false;
  if (bodies.entries.empty()) return moved;
  auto x = system.x(y);
  auto v = system.v(y);
  for (Eigen::Index i = 0; i < system.coordinates() / 3; ++i) {
    const double radius = system.radius(system.row_of_free(i));
    for (const Bodies::Entry& entry : bodies.entries) {
      const Gap gap = gap_to(entry, {x[3 * i], x[3 * i + 1], x[3 * i + 2]}, radius);
      const double overlap = radius - static_cast<double>(gap.distance);
      if (!(overlap > 0)) continue;
      moved = true;
      const DVec3 direction = vector_cast<double>(gap.normal);
      const Eigen::Vector3d n(direction.x, direction.y, direction.z);
      x.segment<3>(3 * i) += overlap * n;
      const double into = -n.dot(v.segment<3>(3 * i));
      if (!(into > 0)) continue;
      const Eigen::Vector3d sliding = v.segment<3>(3 * i) + into * n;
      const double rate = sliding.norm();
      const double loss = std::min(entry.friction * into, rate);
      v.segment<3>(3 * i) = rate > 0 ? Eigen::Vector3d((1 - loss / rate) * sliding) : sliding;
    }
  }
  return moved;
}

}  // namespace hooke::lab
