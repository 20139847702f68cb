#include "collision/queries.h"

#include "collision/queries_ray.h"
#include "collision/shape_gap.h"
#include "state/body_frames.h"

#include <algorithm>
#include <tuple>

namespace hooke::collision {

namespace {

bool can_be_found(const QueryScene& scene, std::uint32_t collider) {
  const state::BodyTraits& traits = scene.bodies.traits[scene.colliders.body[collider]];
  return (traits.filter.category & scene.mask) != 0 && (scene.sensors || !traits.sensor);
}

std::optional<RayHit> cast_ray_on_collider(const QueryScene& scene, std::uint32_t collider, DVec3 origin,
                                           DVec3 motion) {
  if (!can_be_found(scene, collider)) return {};
  const Pose pose = state::frame_of_collider(scene.bodies, scene.colliders, collider);
  const Quat q = pose.rotation;
  // Of length one in double too: the hit may be far from the origin.
  const auto rotation = normalize(Quaternion<double>{q.x, q.y, q.z, q.w});
  const auto back = conjugate(rotation);
  const auto hit = cast_ray_on_shape(scene.colliders.shape[collider], rotate(back, origin - pose.position),
                                     rotate(back, motion));
  if (!hit) return {};
  return RayHit{.collider = collider,
                .triangle = hit->triangle,
                .fraction = hit->fraction,
                .point = origin + hit->fraction * motion,
                .normal = vector_cast<Real>(rotate(rotation, hit->normal))};
}

bool comes_before(const RayHit& a, const RayHit& b) {
  return std::tuple(a.fraction, a.collider) < std::tuple(b.fraction, b.collider);
}

bool comes_before(const ClosestHit& a, const ClosestHit& b) {
  return std::tuple(a.distance, a.collider) < std::tuple(b.distance, b.collider);
}

Gap gap_to_collider(const state::ColliderShape& shape, Vec3 x) {
  if (shape.shape.kind != ShapeKind::kMesh) return gap_to_shape(shape, x);
  const auto nearest = geometry::find_closest(shape.mesh->bvh, x);
  return gap_to_triangle(*shape.mesh, nearest.value().triangle, x).gap;
}

}  // namespace

std::optional<RayHit> cast_ray(const QueryScene& scene, DVec3 origin, DVec3 motion) {
  std::optional<RayHit> best;
  scene.broad_phase.visit_sweep(origin, motion, Real(0), [&](std::uint32_t collider) {
    const auto hit = cast_ray_on_collider(scene, collider, origin, motion);
    if (hit && (!best || comes_before(*hit, *best))) best = hit;
    return best ? best->fraction : 1.0;
  });
  return best;
}

void cast_ray_through(const QueryScene& scene, DVec3 origin, DVec3 motion, std::vector<RayHit>& hits) {
  hits.clear();
  scene.broad_phase.visit_sweep(origin, motion, Real(0), [&](std::uint32_t collider) {
    const auto hit = cast_ray_on_collider(scene, collider, origin, motion);
    if (hit) hits.push_back(*hit);
    return 1.0;
  });
  std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) { return comes_before(a, b); });
}

void find_near(const QueryScene& scene, DVec3 point, Real reach, std::vector<ClosestHit>& hits) {
  hits.clear();
  scene.broad_phase.visit_sweep(point, {}, reach, [&](std::uint32_t collider) {
    if (!can_be_found(scene, collider)) return 1.0;
    const Pose pose = state::frame_of_collider(scene.bodies, scene.colliders, collider);
    const Vec3 x = rotate(conjugate(pose.rotation), vector_cast<Real>(point - pose.position));
    const Gap gap = gap_to_collider(scene.colliders.shape[collider], x);
    if (!(gap.distance <= reach)) return 1.0;
    const Vec3 normal = rotate(pose.rotation, gap.normal);
    hits.push_back({collider, gap.distance, point - vector_cast<double>(gap.distance * normal), normal});
    return 1.0;
  });
  std::sort(hits.begin(), hits.end(),
            [](const ClosestHit& a, const ClosestHit& b) { return comes_before(a, b); });
}

std::optional<ClosestHit> find_closest(const QueryScene& scene, DVec3 point, Real reach) {
  std::vector<ClosestHit> hits;
  find_near(scene, point, reach, hits);
  return hits.empty() ? std::nullopt : std::optional(hits.front());
}

}  // namespace hooke::collision
