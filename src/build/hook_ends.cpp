#include "build/hook_ends.h"

#include "base/assert.h"
#include "build/common.h"
#include "build/connection_points.h"
#include "geometry/closest.h"
#include "state/rope_chains.h"

#include <algorithm>
#include <array>
#include <span>

namespace hooke::build {

namespace {

using state::Deformable;
using state::HookPlace;
using state::Tables;

/// The nearest place to `wanted` found so far, between particles of one object.
struct Nearest {
  const Tables& t;
  DVec3 wanted = {};  ///< Offset from the object's origin [m].
  HookPlace place = {};
  double distance_squared = HUGE_VAL;

  [[nodiscard]] DVec3 at(std::uint32_t particle) const {
    return vector_cast<double>(t.particles.position[particle].x);
  }
  void take(double square, std::span<const std::uint32_t> particles, std::span<const double> weights) {
    if (!(square < distance_squared)) return;
    distance_squared = square;
    place.particle_count = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (weights[i] <= 0) continue;
      place.particle[place.particle_count] = particles[i];
      place.weight[place.particle_count++] = static_cast<Real>(weights[i]);
    }
  }
  void try_particle(std::uint32_t p) { take(length_squared(at(p) - wanted), std::array{p}, std::array{1.0}); }
  void try_segment(std::uint32_t a, std::uint32_t b) {
    const geometry::SegmentPoint<double> near = geometry::closest_on_segment(wanted, at(a), at(b));
    take(length_squared(near.point - wanted), std::array{a, b}, std::array{1 - near.fraction, near.fraction});
  }
  void try_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const geometry::TrianglePoint<double> near = geometry::closest_on_triangle(wanted, at(a), at(b), at(c));
    take(near.distance_squared, std::array{a, b, c},
         std::array{near.weights.x, near.weights.y, near.weights.z});
  }
  void try_tetrahedron(const state::Tetrahedra::Corners& c) {
    const DVec3 ab = at(c.b) - at(c.a);
    const DVec3 ac = at(c.c) - at(c.a);
    const DVec3 ad = at(c.d) - at(c.a);
    const DVec3 p = wanted - at(c.a);
    const double volume = dot(ab, cross(ac, ad));
    const double b = dot(p, cross(ac, ad)) / volume;
    const double third = dot(ab, cross(p, ad)) / volume;
    const double d = dot(ab, cross(ac, p)) / volume;
    const std::array weights = {1 - b - third - d, b, third, d};
    if (std::all_of(weights.begin(), weights.end(), [](double w) { return w >= 0; })) {
      return take(0, std::array{c.a, c.b, c.c, c.d}, weights);
    }
    try_triangle(c.a, c.b, c.c);
    try_triangle(c.a, c.b, c.d);
    try_triangle(c.a, c.c, c.d);
    try_triangle(c.b, c.c, c.d);
  }
};

void find_nearest(const Deformable& object, Nearest& nearest) {
  const Tables& t = nearest.t;
  for (std::uint32_t i = 0; i < object.tetrahedra.count; ++i)
    nearest.try_tetrahedron(t.tetrahedra.corners[object.tetrahedra.first + i]);
  for (std::uint32_t i = 0; i < object.triangles.count && object.tetrahedra.count == 0; ++i) {
    const state::Triangles::Corners& c = t.triangles.corners[object.triangles.first + i];
    nearest.try_triangle(c.a, c.b, c.c);
  }
  if (object.rest_shape && object.skin) {  // Each vertex of the skin is a point of the solid.
    const auto row = [&](std::uint32_t vertex) {
      return row_of(t, object, object.skin->vertices[vertex].points[0]);
    };
    for (const auto& [a, b, c] : object.skin->triangles) nearest.try_triangle(row(a), row(b), row(c));
  }
  for (std::uint32_t i = 0; i < object.segments.count; ++i) {
    const std::uint32_t from = object.particles.first + i;
    if (t.segments.joins(object.segments.first + i)) {
      nearest.try_segment(from, from + 1);
    } else {
      nearest.try_particle(from);
      nearest.try_particle(from + 1);
    }
  }
  if (nearest.place.particle_count > 0) return;
  for (std::uint32_t i = 0; i < object.particles.count; ++i) nearest.try_particle(object.particles.first + i);
}

/// Converts a connection point to rows of particles.
HookPlace rows_of(const state::NamedPlace& named, const Deformable& object, const Tables& t) {
  HookPlace place;
  for (std::size_t i = 0; i < named.points.size(); ++i) {
    if (!(named.weights[i] > Real(0))) continue;
    HOOKE_ASSERT(named.points[i] < object.particles.count);
    place.particle[place.particle_count] = row_of(t, object, named.points[i]);
    place.weight[place.particle_count++] = named.weights[i];
  }
  return place;
}

Error stale_end(const char* where) {
  return {ErrorCode::kStaleId, where, "refers to nothing that is in the world"};
}

Result<FoundEnd> find_point(const HookEnd& end, DVec3 anchor, const char* where, const Tables& t) {
  const PointRef point = end.point;
  const std::uint32_t row = state::object_row(t, point);
  if (row == Tables::kNoRow) return stale_end(where);
  const Deformable& object = t.objects[row];
  FoundEnd found = {.is_given = true, .position = object.origin};
  if (!end.connection_point.empty()) {
    const Result<state::NamedPlace> named =
        find_connection_point(*object.connection_points, end.connection_point, where);
    if (!named) return named.error();
    found.place = rows_of(named.value(), object, t);
  } else if (point.index == PointRef::kNearest) {
    found.place = nearest_place(t, object, anchor);
  } else if (point.index < object.particles.count) {
    found.place.particle_count = 1;
    found.place.particle[0] = row_of(t, object, point.index);
    found.place.weight[0] = Real(1);
  } else {
    return Error{ErrorCode::kOutOfRange, where,
                 "names point " + std::to_string(point.index) + " of " +
                     std::to_string(object.particles.count) + "; the first is 0"};
  }
  found.place.object = row;
  state::leave_gap(object, t.segments, found.place);
  for (std::uint32_t i = 0; i < found.place.particle_count; ++i) {
    const Vec3 x = t.particles.position[found.place.particle[i]].x;
    found.position += static_cast<double>(found.place.weight[i]) * vector_cast<double>(x);
  }
  return found;
}

/// The place of a body that is soft now: the nearest one of its solid.
FoundEnd find_soft_body(std::uint32_t object, DVec3 wanted, const Tables& t) {
  FoundEnd found = {.place = nearest_place(t, t.objects[object], wanted),
                    .is_given = true,
                    .position = t.objects[object].origin};
  found.place.object = object;
  for (std::uint32_t i = 0; i < found.place.particle_count; ++i) {
    const Vec3 x = t.particles.position[found.place.particle[i]].x;
    found.position += static_cast<double>(found.place.weight[i]) * vector_cast<double>(x);
  }
  return found;
}

Result<FoundEnd> find_body(const HookEnd& end, DVec3 anchor, const char* where, const Tables& t) {
  FoundEnd found;
  const std::uint32_t body = t.body_slots.find(end.body);
  if (body == Tables::kNoRow) return stale_end(where);
  const std::uint32_t yielding = state::yielding_row(t, body);
  const std::uint32_t soft = yielding == Tables::kNoRow ? yielding : soft_object(t, t.yielding[yielding]);
  found.place.body = body;
  if (end.connection_point.empty()) return soft == Tables::kNoRow ? found : find_soft_body(soft, anchor, t);
  const Result<state::NamedPlace> named =
      find_connection_point(connection_points_of_body(body, t), end.connection_point, where);
  if (!named) return named.error();
  found.is_given = true;
  found.position =
      t.bodies.center[body] + vector_cast<double>(rotate(t.bodies.rotation[body], named.value().position));
  if (soft != Tables::kNoRow) return find_soft_body(soft, found.position, t);
  return found;
}

}  // namespace

HookPlace nearest_place(const Tables& t, const Deformable& object, DVec3 wanted) {
  Nearest nearest = {t, wanted - object.origin};
  find_nearest(object, nearest);
  HOOKE_ASSERT(nearest.place.particle_count > 0);
  return nearest.place;
}

Result<FoundEnd> find_end(const HookEnd& end, DVec3 anchor, const char* where, const Tables& t) {
  const bool names_body = end.body != BodyId{};
  if (end.point.kind != PointRef::Kind::kNone) {
    if (names_body) return Error{ErrorCode::kOutOfRange, where, "names a body and a point: one is meant"};
    return find_point(end, anchor, where, t);
  }
  if (names_body) return find_body(end, anchor, where, t);
  if (end.connection_point.empty()) return FoundEnd{};
  return Error{ErrorCode::kOutOfRange, where, "is the world, which has no connection points"};
}

}  // namespace hooke::build
