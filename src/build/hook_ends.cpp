#include "build/hook_ends.h"

#include "geometry/closest.h"

#include <algorithm>
#include <array>
#include <span>

namespace hooke::build {

namespace {

using state::Deformable;
using state::HookPlace;
using state::Tables;

/// The nearest place found so far, between particles of one object.
struct Nearest {
  const Tables& t;
  DVec3 wanted = {};  ///< From the object's origin [m].
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
  for (std::uint32_t i = 0; i < object.segments.count; ++i)
    nearest.try_segment(object.particles.first + i, object.particles.first + i + 1);
  if (nearest.place.particle_count > 0) return;
  for (std::uint32_t i = 0; i < object.particles.count; ++i) nearest.try_particle(object.particles.first + i);
}

Result<FoundEnd> find_point(PointRef point, DVec3 anchor, const char* where, const Tables& t) {
  const std::uint32_t row = state::object_row(t, point);
  if (row == Tables::kNoRow)
    return Error{ErrorCode::kStaleId, where, "refers to nothing that is in the world"};
  const Deformable& object = t.objects[row];
  Nearest nearest = {t, anchor - object.origin};
  if (point.index == PointRef::kNearest) {
    find_nearest(object, nearest);
  } else if (point.index < object.particles.count) {
    const std::uint32_t first = object.particles.first;
    nearest.try_particle(first + t.particles.row_of[first + point.index]);
  } else {
    return Error{ErrorCode::kOutOfRange, where,
                 "names point " + std::to_string(point.index) + " of " +
                     std::to_string(object.particles.count) + "; the first is 0"};
  }
  FoundEnd end = {.place = nearest.place, .position = object.origin};
  end.place.object = row;
  for (std::uint32_t i = 0; i < end.place.particle_count; ++i)
    end.position += static_cast<double>(end.place.weight[i]) * nearest.at(end.place.particle[i]);
  return end;
}

}  // namespace

Result<FoundEnd> find_end(const HookEnd& end, DVec3 anchor, const char* where, const Tables& t) {
  const bool names_body = end.body != BodyId{};
  if (end.point.kind != PointRef::Kind::kNone) {
    if (names_body) return Error{ErrorCode::kOutOfRange, where, "names a body and a point: one is meant"};
    return find_point(end.point, anchor, where, t);
  }
  FoundEnd found;
  if (!names_body) return found;
  found.place.body = t.body_slots.find(end.body);
  if (found.place.body != Tables::kNoRow) return found;
  return Error{ErrorCode::kStaleId, where, "refers to nothing that is in the world"};
}

}  // namespace hooke::build
