#include "build/connection_points.h"

#include "base/assert.h"
#include "build/common.h"
#include "build/hook_ends.h"

#include <algorithm>

namespace hooke::build {

namespace {

using state::NamedPlace;
using state::NamedPlaces;
using state::Tables;

/// A side, an edge or a corner of a box or grid, given by its end along each axis: -1, 1, or 0 for the
/// middle.
struct Side {
  std::array<int, 3> end = {};
};

/// Joins the words for the ends along the axes, the vertical axis first, as in "top_left_front".
std::string name_of(const Side& side) {
  struct Word {
    int axis;
    const char* low;
    const char* high;
  };
  constexpr Word kWords[] = {{1, "bottom", "top"}, {0, "left", "right"}, {2, "back", "front"}};
  std::string name;
  for (const Word& word : kWords) {
    const int end = side.end[static_cast<std::size_t>(word.axis)];
    if (end == 0) continue;
    name += (name.empty() ? "" : "_") + std::string(end < 0 ? word.low : word.high);
  }
  return name.empty() ? "center" : name;
}

/// Returns the sides along the first `axes` axes, in the order left, right, bottom, top, back, front.
std::vector<Side> faces(int axes) {
  std::vector<Side> result;
  for (int axis = 0; axis < axes; ++axis) {
    for (const int end : {-1, 1}) result.emplace_back().end[static_cast<std::size_t>(axis)] = end;
  }
  return result;
}

/// Returns the corners, where sides along all of the first `axes` axes meet.
std::vector<Side> corners(int axes) {
  std::vector<Side> result;
  for (int corner = 0; corner < 1 << axes; ++corner) {
    Side& side = result.emplace_back();
    for (int axis = 0; axis < axes; ++axis)
      side.end[static_cast<std::size_t>(axis)] = (corner >> axis & 1) != 0 ? 1 : -1;
  }
  return result;
}

/// Returns the connection point at a side of a lattice with `counts` points along its axes, x fastest. It is
/// a point, or the middle between two or four points.
NamedPlace lattice_point(std::array<std::uint32_t, 3> counts, const Side& side) {
  NamedPlace place = {.name = name_of(side)};
  std::array<std::vector<std::uint32_t>, 3> along;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t last = counts[axis] - 1;
    const std::uint32_t twice = side.end[axis] == 0 ? last : side.end[axis] < 0 ? 0 : 2 * last;
    along[axis].push_back(twice / 2);
    if (twice % 2 != 0) along[axis].push_back(twice / 2 + 1);
  }
  const std::size_t count = along[0].size() * along[1].size() * along[2].size();
  // Only the center of an odd box is between eight points, and it has a point of its own.
  HOOKE_ASSERT(count <= place.points.size());
  std::size_t used = 0;
  for (const std::uint32_t z : along[2]) {
    for (const std::uint32_t y : along[1]) {
      for (const std::uint32_t x : along[0]) {
        place.points[used] = (z * counts[1] + y) * counts[0] + x;
        place.weights[used++] = Real(1) / static_cast<Real>(count);
      }
    }
  }
  return place;
}

/// Half of the size of a shape whose sides have names [m]; zero for other shapes.
Vec3 half_size(const Shape& shape) {
  switch (shape.kind) {
    case ShapeKind::kBox:
      return shape.half_extents;
    case ShapeKind::kSphere:
      return {shape.radius, shape.radius, shape.radius};
    case ShapeKind::kCapsule:
      return {shape.radius, shape.half_height + shape.radius, shape.radius};
    case ShapeKind::kCylinder:
    case ShapeKind::kCone:
      return {shape.radius, shape.half_height, shape.radius};
    default:
      return {};
  }
}

/// Returns the named sides and corners that lie on the surface of a shape.
std::vector<Side> sides_of(ShapeKind kind) {
  if (kind == ShapeKind::kCone) return {Side{.end = {0, -1, 0}}, Side{.end = {0, 1, 0}}};
  std::vector<Side> sides = faces(3);
  if (kind != ShapeKind::kBox) return sides;
  for (const Side& corner : corners(3)) sides.push_back(corner);
  return sides;
}

/// Appends the connection points whose names are not taken yet.
void append_missing(const NamedPlaces& more, NamedPlaces& places) {
  for (const NamedPlace& place : more) {
    const auto same = [&](const NamedPlace& one) { return one.name == place.name; };
    if (std::none_of(places.begin(), places.end(), same)) places.push_back(place);
  }
}

/// Converts a place between rows of an object to point numbers in the order of its maker.
NamedPlace from_rows(const state::HookPlace& rows, const state::Deformable& object, const Tables& t) {
  NamedPlace place;
  for (std::uint32_t i = 0; i < rows.particle_count; ++i) {
    const auto first = t.particles.row_of.begin() + object.particles.first;
    const auto found =
        std::find(first, first + object.particles.count, rows.particle[i] - object.particles.first);
    place.points[i] = static_cast<std::uint32_t>(found - first);
    place.weights[i] = rows.weight[i];
  }
  return place;
}

}  // namespace

void check_connection_points(Checks& checks, const std::vector<ConnectionPointDesc>& given,
                             std::size_t count) {
  constexpr std::size_t kLongestName = 64;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const ConnectionPointDesc& one = given[i];
    const std::string where = "connection_points." + one.name;
    const auto same = [&](const ConnectionPointDesc& other) { return other.name == one.name; };
    checks
        .require(!one.name.empty() && one.name.size() <= kLongestName, indexed("connection_points", i),
                 "needs a name of 1 to 64 bytes")
        .require(std::none_of(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(i), same), where,
                 "is the name of another one too")
        .place(where, one.position);
    if (!one.point) continue;
    checks.require(count > 0, where, "must be a place [x, y, z]: a body has no points");
    checks.in_range(where, *one.point, 0, static_cast<double>(count) - 1);
  }
}

std::shared_ptr<const NamedPlaces> connection_points_of(const std::vector<ConnectionPointDesc>& given,
                                                        Vec3 center) {
  if (given.empty()) return nullptr;
  auto places = std::make_shared<NamedPlaces>();
  for (const ConnectionPointDesc& one : given)
    places->push_back({.name = one.name, .position = vector_cast<Real>(one.position) - center});
  return places;
}

void append_connection_points(const std::vector<ConnectionPointDesc>& given,
                              const ConnectionPointFrame& frame, const NamedPlaces& of_its_kind, Tables& t) {
  state::Deformable& object = t.objects.back();
  auto places = std::make_shared<NamedPlaces>();
  const Quaternion<double> turn =
      normalize(Quaternion<double>{frame.rotation.x, frame.rotation.y, frame.rotation.z, frame.rotation.w});
  for (const ConnectionPointDesc& one : given) {
    const DVec3 at = frame.position + rotate(turn, one.position);
    NamedPlace place =
        one.point ? named_point("", *one.point) : from_rows(nearest_place(t, object, at), object, t);
    place.name = one.name;
    places->push_back(place);
  }
  append_missing(of_its_kind, *places);
  object.connection_points = std::move(places);
}

NamedPlace named_point(const char* name, std::uint32_t point) {
  return {.name = name, .points = {point}, .weights = {Real(1)}};
}

NamedPlaces connection_points_of_grid(std::uint32_t columns, std::uint32_t rows) {
  NamedPlaces places;
  const auto add = [&](Side side) {
    NamedPlace place = lattice_point({columns, rows, 1}, side);
    side.end[1] = -side.end[1];  // Rows of points count downward.
    place.name = name_of(side);
    places.push_back(place);
  };
  for (const Side& side : corners(2)) add(side);
  for (const Side& side : faces(2)) add(side);
  add({});
  return places;
}

NamedPlaces connection_points_of_box(std::array<std::int32_t, 3> cells) {
  std::array<std::uint32_t, 3> counts = {};
  for (std::size_t axis = 0; axis < 3; ++axis) counts[axis] = static_cast<std::uint32_t>(cells[axis]) + 1;
  NamedPlaces places;
  for (const Side& side : faces(3)) places.push_back(lattice_point(counts, side));
  for (const Side& side : corners(3)) places.push_back(lattice_point(counts, side));
  const bool in_a_cell = cells[0] % 2 != 0 && cells[1] % 2 != 0 && cells[2] % 2 != 0;
  if (!in_a_cell) {
    places.push_back(lattice_point(counts, {}));
    return places;
  }
  std::uint32_t cell = 0;
  for (std::size_t axis = 3; axis-- > 0;)
    cell = cell * static_cast<std::uint32_t>(cells[axis]) + static_cast<std::uint32_t>(cells[axis]) / 2;
  places.push_back(named_point("center", counts[0] * counts[1] * counts[2] + cell));
  return places;
}

NamedPlaces connection_points_of_body(std::uint32_t body, const Tables& t) {
  NamedPlaces places;
  if (t.bodies.connection_points[body]) places = *t.bodies.connection_points[body];
  NamedPlaces of_its_kind = {{.name = "center"}, {.name = "origin", .position = -t.bodies.mass[body].center}};
  const std::uint32_t collider = t.bodies.first_collider[body];
  const Shape& shape = t.colliders.shape[collider].shape;
  const Vec3 half = half_size(shape);
  if (t.bodies.collider_count[body] == 1 && half != Vec3{}) {
    for (const Side& side : sides_of(shape.kind)) {
      const Vec3 at = {static_cast<Real>(side.end[0]) * half.x, static_cast<Real>(side.end[1]) * half.y,
                       static_cast<Real>(side.end[2]) * half.z};
      of_its_kind.push_back(
          {.name = name_of(side),
           .position = t.colliders.position[collider] + rotate(t.colliders.rotation[collider], at)});
    }
  }
  append_missing(of_its_kind, places);
  return places;
}

Result<NamedPlace> find_connection_point(const NamedPlaces& places, const std::string& name,
                                         const char* where) {
  std::vector<std::string> names;
  for (const NamedPlace& place : places) {
    if (place.name == name) return place;
    names.push_back(place.name);
  }
  return no_such_name("connection point", name, names, where);
}

}  // namespace hooke::build
