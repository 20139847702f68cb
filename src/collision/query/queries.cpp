#include "collision/query/queries.h"

#include "base/assert.h"
#include "collision/distance/shape_gap.h"
#include "collision/query/queries_ray.h"
#include "math/rotation.h"
#include "state/body_frames.h"

#include <algorithm>
#include <utility>

namespace hooke::collision {

namespace {

std::optional<RayHit> cast_ray_on_collider(const QueryScene& scene, std::uint32_t collider, DVec3 origin,
                                           DVec3 motion) {
  if (!can_be_found(scene, collider)) return {};
  const Pose pose = state::frame_of_collider(scene.bodies, scene.colliders, collider);
  const auto rotation = math::in_double(pose.rotation);
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

/// The rank of a collider among equally near ones.
std::pair<std::uint32_t, std::uint32_t> creation_of(const QueryScene& scene, std::uint32_t collider) {
  return {scene.bodies.slot[scene.colliders.body[collider]], collider};
}

bool comes_before(const QueryScene& scene, const RayHit& a, const RayHit& b) {
  if (a.fraction != b.fraction) return a.fraction < b.fraction;
  return creation_of(scene, a.collider) < creation_of(scene, b.collider);
}

bool comes_before(const QueryScene& scene, const ClosestHit& a, const ClosestHit& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  return creation_of(scene, a.collider) < creation_of(scene, b.collider);
}

template <class Hit>
void sort_hits(const QueryScene& scene, std::vector<Hit>& hits) {
  std::sort(hits.begin(), hits.end(), [&](const Hit& a, const Hit& b) { return comes_before(scene, a, b); });
}

std::optional<ClosestHit> closest_on_collider(const QueryScene& scene, std::uint32_t collider, DVec3 point,
                                              Real reach) {
  if (!can_be_found(scene, collider)) return {};
  const state::ColliderShape& shape = scene.colliders.shape[collider];
  const Pose pose = state::frame_of_collider(scene.bodies, scene.colliders, collider);
  const Vec3 x = rotate(conjugate(pose.rotation), vector_cast<Real>(point - pose.position));
  ClosestHit hit = {.collider = collider};
  Gap gap;
  if (shape.shape.kind == ShapeKind::kMesh) {
    hit.triangle = geometry::find_closest(shape.mesh->bvh, x).value().triangle;
    const std::optional<bool> inside = is_inside(*shape.mesh, x);
    gap = gap_on_side(gap_to_triangle(*shape.mesh, hit.triangle, x), inside);
    if (!inside && gap.distance < Real(0)) gap = {-gap.distance, -gap.normal};
  } else {
    gap = gap_to_shape(shape, x);
  }
  if (!(gap.distance <= reach)) return {};
  hit.distance = gap.distance;
  hit.normal = rotate(pose.rotation, gap.normal);
  hit.point = point - vector_cast<double>(gap.distance * hit.normal);
  return hit;
}

}  // namespace

bool can_be_found(const QueryScene& scene, std::uint32_t collider) {
  const std::uint32_t body = scene.colliders.body[collider];
  HOOKE_ASSERT(body < scene.bodies.traits.size());
  const state::BodyTraits& traits = scene.bodies.traits[body];
  return body != scene.skip && traits.collides && (scene.sensors || !traits.sensor) &&
         state::filters_agree(traits.filter, scene.filter);
}

void sort_by_creation(const QueryScene& scene, std::vector<std::uint32_t>& colliders) {
  std::sort(colliders.begin(), colliders.end(),
            [&](std::uint32_t a, std::uint32_t b) { return creation_of(scene, a) < creation_of(scene, b); });
}

std::optional<RayHit> cast_ray(const QueryScene& scene, DVec3 origin, DVec3 motion) {
  std::optional<RayHit> best;
  scene.broad_phase.visit_sweep(origin, motion, Real(0), [&](std::uint32_t collider) {
    const auto hit = cast_ray_on_collider(scene, collider, origin, motion);
    if (hit && (!best || comes_before(scene, *hit, *best))) best = hit;
    return best ? best->fraction : 1.0;
  });
  return best;
}

bool is_ray_blocked(const QueryScene& scene, DVec3 origin, DVec3 motion) {
  constexpr double kEnough = -1;  // no box is entered before the start
  bool blocked = false;
  scene.broad_phase.visit_sweep(origin, motion, Real(0), [&](std::uint32_t collider) {
    blocked = blocked || cast_ray_on_collider(scene, collider, origin, motion).has_value();
    return blocked ? kEnough : 1.0;
  });
  return blocked;
}

void cast_ray_through(const QueryScene& scene, DVec3 origin, DVec3 motion, std::vector<RayHit>& hits) {
  hits.clear();
  scene.broad_phase.visit_sweep(origin, motion, Real(0), [&](std::uint32_t collider) {
    const auto hit = cast_ray_on_collider(scene, collider, origin, motion);
    if (hit) hits.push_back(*hit);
    return 1.0;
  });
  sort_hits(scene, hits);
}

void find_near(const QueryScene& scene, DVec3 point, Real reach, std::vector<ClosestHit>& hits) {
  hits.clear();
  const auto limit = static_cast<double>(reach);
  scene.broad_phase.visit_near(point, limit, [&](std::uint32_t collider) {
    const auto hit = closest_on_collider(scene, collider, point, reach);
    if (hit) hits.push_back(*hit);
    return limit;
  });
  sort_hits(scene, hits);
}

std::optional<ClosestHit> find_closest(const QueryScene& scene, DVec3 point, Real reach) {
  std::optional<ClosestHit> best;
  scene.broad_phase.visit_near(point, static_cast<double>(reach), [&](std::uint32_t collider) {
    const auto hit = closest_on_collider(scene, collider, point, reach);
    if (hit && (!best || comes_before(scene, *hit, *best))) best = hit;
    // Inside a solid there may be another that holds the point deeper.
    return static_cast<double>(best ? std::max(best->distance, Real(0)) : reach);
  });
  return best;
}

}  // namespace hooke::collision
