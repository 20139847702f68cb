/// This file implements queries: rays, moving shapes, overlaps and nearest points.

#include "hooke/world.h"

#include "build/build.h"
#include "build/checks.h"
#include "collision/continuous/shape_bounds.h"
#include "collision/query/deformable_queries.h"
#include "collision/query/queries.h"
#include "state/body_frames.h"
#include "world/body_stages.h"
#include "world/claim.h"
#include "world/object_edits.h"
#include "world/world_data.h"

#include <cmath>

namespace hooke {

namespace {

using collision::QueryScene;
using collision::RayHit;
using state::Tables;

/// Returns what a query may find, or the Error of a filter or of a call during a step.
Result<QueryScene> look(const std::shared_ptr<WorldData>& data, const QueryFilter& filter) {
  if (!data) return world::Claim(data).error();
  if (data->stepping) return Error{ErrorCode::kUnsupported, "query", "cannot be asked during a step"};
  const Tables& t = data->tables;
  const std::uint32_t skip = t.body_slots.find(filter.skip);
  if (filter.skip && skip == t.body_slots.kNone) return world::stale("filter.skip");
  return QueryScene{.broad_phase = world::boxes_for_queries(*data),
                    .bodies = t.bodies,
                    .colliders = t.colliders,
                    .filter = filter.filter,
                    .skip = skip,
                    .sensors = filter.sensors};
}

Result<void> check_place(const char* name, DVec3 place) {
  return build::Checks("query").place(name, place).result();
}

Result<void> check_ray(DVec3 origin, DVec3 motion) {
  build::Checks checks("query");
  checks.place("origin", origin).place("motion", motion);
  checks.require(length(motion) > 0, "motion", "must have a length");
  return checks.result();
}

Result<QueryScene> look_along(const std::shared_ptr<WorldData>& data, DVec3 origin, DVec3 motion,
                              const QueryFilter& filter) {
  if (const auto good = check_ray(origin, motion); !good) return good.error();
  return look(data, filter);
}

/// The shape of a query with its pose.
struct QueryShape {
  state::ColliderShape shape;
  Pose pose;
};

Result<QueryShape> make_query_shape(const Shape& shape, const Pose& pose, const Tables& t) {
  const ShapeKind kind = shape.kind;
  if (kind == ShapeKind::kHalfSpace || kind == ShapeKind::kMesh || kind == ShapeKind::kCompound) {
    return Error{ErrorCode::kUnsupported, "shape.kind", "a query needs a convex shape"};
  }
  const Result<void> good = build::validate(shape);
  if (!good) return good.error();
  Result<state::ColliderShape> made = build::make_shape(shape, "", t);
  if (!made) return made.error();
  const Result<void> placed = check_place("pose.position", pose.position);
  if (!placed) return placed.error();
  const Quat q = pose.rotation;
  const Real squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!std::isfinite(squared) || !(squared > Real(0))) {
    return Error{ErrorCode::kOutOfRange, "query.pose.rotation", "must be finite and not zero"};
  }
  return QueryShape{std::move(made).value(), {pose.position, normalize(q)}};
}

CastHit hit_of(const Tables& t, const RayHit& hit, DVec3 motion) {
  const auto [body, part] = world::part_of(t, hit.collider);
  return {.body = body,
          .part = part,
          .triangle = hit.triangle,
          .point = hit.point,
          .normal = hit.normal,
          .fraction = hit.fraction,
          .distance = hit.fraction * length(motion)};
}

std::optional<CastHit> hit_of(const Tables& t, const std::optional<RayHit>& hit, DVec3 motion) {
  return hit ? std::optional(hit_of(t, *hit, motion)) : std::nullopt;
}

std::vector<BodyPart> parts_of(const Tables& t, const std::vector<std::uint32_t>& colliders) {
  std::vector<BodyPart> parts;
  parts.reserve(colliders.size());
  for (const std::uint32_t collider : colliders) parts.push_back(world::part_of(t, collider));
  return parts;
}

/// Whether a query may look at deformables with this filter now.
Result<void> check_look(const std::shared_ptr<WorldData>& data, const DeformableFilter& filter) {
  if (!data) return world::Claim(data).error();
  if (data->stepping) return Error{ErrorCode::kUnsupported, "query", "cannot be asked during a step"};
  const bool is_known = state::object_row(data->tables, filter.skip) != Tables::kNoRow;
  if (filter.skip.kind != PointRef::Kind::kNone && !is_known) return world::stale("filter.skip");
  const auto margin = static_cast<double>(filter.margin);
  return build::Checks("query").up_to("filter.margin", margin, limits::kSize).result();
}

DeformablePlace place_of(const Tables& t, const collision::DeformableSpot& spot) {
  const auto& [a, b, c] = spot.weights;
  return {.nearest = world::point_of(t, t.objects[spot.object], collision::point_with_most_weight(t, spot)),
          .element = spot.element,
          .corners = spot.corners,
          .weights = {static_cast<Real>(a), static_cast<Real>(b), static_cast<Real>(c)},
          .point = spot.point,
          .normal = vector_cast<Real>(spot.normal)};
}

ClosestDeformable closest_of(const Tables& t, const collision::DeformableSpot& spot) {
  return {.place = place_of(t, spot), .distance = static_cast<Real>(spot.distance)};
}

/// Checks a place and a distance that a query may look from it.
Result<void> check_reach(const char* name, DVec3 place, const char* reach_name, Real reach) {
  build::Checks checks("query");
  checks.place(name, place)
      .require(reach >= Real(0), reach_name, static_cast<double>(reach),
               "must be zero, positive or infinite");
  return checks.result();
}

}  // namespace

Result<std::optional<CastHit>> World::cast_ray(DVec3 origin, DVec3 motion, const QueryFilter& filter) const {
  const world::Reading reading(data_);
  const Result<QueryScene> scene = look_along(data_, origin, motion, filter);
  if (!scene) return scene.error();
  return hit_of(reading.tables(), collision::cast_ray(scene.value(), origin, motion), motion);
}

Result<std::vector<CastHit>> World::cast_ray_through(DVec3 origin, DVec3 motion,
                                                     const QueryFilter& filter) const {
  const world::Reading reading(data_);
  const Result<QueryScene> scene = look_along(data_, origin, motion, filter);
  if (!scene) return scene.error();
  std::vector<RayHit> found;
  collision::cast_ray_through(scene.value(), origin, motion, found);
  std::vector<CastHit> hits;
  hits.reserve(found.size());
  for (const RayHit& hit : found) hits.push_back(hit_of(reading.tables(), hit, motion));
  return hits;
}

Result<bool> World::is_ray_blocked(DVec3 origin, DVec3 motion, const QueryFilter& filter) const {
  const world::Reading reading(data_);
  const Result<QueryScene> scene = look_along(data_, origin, motion, filter);
  if (!scene) return scene.error();
  return collision::is_ray_blocked(scene.value(), origin, motion);
}

Result<std::optional<CastHit>> World::cast_shape(const Shape& shape, const Pose& start, DVec3 motion,
                                                 const QueryFilter& filter) const {
  const world::Reading reading(data_);
  const Result<QueryShape> made = make_query_shape(shape, start, reading.tables());
  if (!made) return made.error();
  const Result<QueryScene> scene = look_along(data_, start.position, motion, filter);
  if (!scene) return scene.error();
  const auto& [collider, pose] = made.value();
  return hit_of(reading.tables(), collision::cast_shape(scene.value(), collider, pose, motion), motion);
}

Result<std::vector<BodyPart>> World::find_overlaps(const Shape& shape, const Pose& pose,
                                                   const QueryFilter& filter) const {
  const world::Reading reading(data_);
  const Result<QueryShape> made = make_query_shape(shape, pose, reading.tables());
  if (!made) return made.error();
  const Result<QueryScene> scene = look(data_, filter);
  if (!scene) return scene.error();
  std::vector<std::uint32_t> found;
  collision::find_overlaps(scene.value(), made.value().shape, made.value().pose, found);
  return parts_of(reading.tables(), found);
}

Result<std::vector<BodyPart>> World::find_in_box(DVec3 lower, DVec3 upper, const QueryFilter& filter) const {
  const world::Reading reading(data_);
  build::Checks checks("query");
  checks.place("lower", lower).place("upper", upper);
  checks.require(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z, "upper",
                 "must not be below `lower`");
  if (!checks.good()) return checks.result().error();
  const Result<QueryScene> look_result = look(data_, filter);
  if (!look_result) return look_result.error();
  const QueryScene& scene = look_result.value();
  const geometry::Box box = {vector_cast<Real>(lower), vector_cast<Real>(upper)};
  std::vector<std::uint32_t> found;
  scene.broad_phase.query(box, found);
  std::erase_if(found, [&](std::uint32_t collider) {
    const Pose pose = state::frame_of_collider(scene.bodies, scene.colliders, collider);
    return !collision::can_be_found(scene, collider) ||
           !overlap(collision::bounds_of(scene.colliders.shape[collider], pose), box);
  });
  collision::sort_by_creation(scene, found);
  return parts_of(reading.tables(), found);
}

Result<std::optional<ClosestPoint>> World::find_closest(DVec3 point, Real reach,
                                                        const QueryFilter& filter) const {
  const world::Reading reading(data_);
  if (const auto good = check_reach("point", point, "reach", reach); !good) return good.error();
  const Result<QueryScene> scene = look(data_, filter);
  if (!scene) return scene.error();
  const auto hit = collision::find_closest(scene.value(), point, reach);
  if (!hit) return std::optional<ClosestPoint>();
  const auto [body, part] = world::part_of(reading.tables(), hit->collider);
  return std::optional(ClosestPoint{.body = body,
                                    .part = part,
                                    .triangle = hit->triangle,
                                    .point = hit->point,
                                    .normal = hit->normal,
                                    .distance = hit->distance});
}

Result<std::optional<DeformableHit>> World::cast_ray_on_deformables(DVec3 origin, DVec3 motion,
                                                                    const DeformableFilter& filter) const {
  const world::Reading reading(data_);
  if (const auto good = check_ray(origin, motion); !good) return good.error();
  if (const auto good = check_look(data_, filter); !good) return good.error();
  const auto spot = collision::cast_ray(reading.tables(), filter, origin, motion);
  if (!spot) return std::optional<DeformableHit>();
  return std::optional(DeformableHit{.place = place_of(reading.tables(), *spot),
                                     .fraction = spot->distance,
                                     .distance = spot->distance * length(motion)});
}

Result<std::optional<ClosestDeformable>> World::find_closest_deformable(
    DVec3 point, Real reach, const DeformableFilter& filter) const {
  const world::Reading reading(data_);
  if (const auto good = check_reach("point", point, "reach", reach); !good) return good.error();
  if (const auto good = check_look(data_, filter); !good) return good.error();
  const auto spot = collision::find_closest(reading.tables(), filter, point, static_cast<double>(reach));
  if (!spot) return std::optional<ClosestDeformable>();
  return std::optional(closest_of(reading.tables(), *spot));
}

Result<std::vector<ClosestDeformable>> World::find_deformables(DVec3 center, Real radius,
                                                               const DeformableFilter& filter) const {
  const world::Reading reading(data_);
  if (const auto good = check_reach("center", center, "radius", radius); !good) return good.error();
  if (const auto good = check_look(data_, filter); !good) return good.error();
  std::vector<collision::DeformableSpot> spots;
  collision::find_near(reading.tables(), filter, center, static_cast<double>(radius), spots);
  std::vector<ClosestDeformable> found;
  found.reserve(spots.size());
  for (const auto& spot : spots) found.push_back(closest_of(reading.tables(), spot));
  return found;
}

}  // namespace hooke
