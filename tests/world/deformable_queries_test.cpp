#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real kForever = std::numeric_limits<Real>::infinity();

/// A cloth of 3 m x 2 m in the plane z = 0, its front to +z, of 4 x 3 points.
ClothId add_sheet(World& world, double z = 0, const FilterDesc& filter = {}) {
  return take(world.add_cloth({.columns = 4,
                               .rows = 3,
                               .corner = {0, 2, z},
                               .width = 3,
                               .height = 2,
                               .pins = {{.point = 0}},
                               .filter = filter}));
}

RopeId add_line(World& world, DVec3 from, Vec3 direction, Real radius = Real(0.1)) {
  return take(world.add_rope({.hook_point = from,
                              .direction = direction,
                              .masses = 11,
                              .length_at_rest = 10,
                              .pins = {},
                              .radius = radius}));
}

SolidId add_cube(World& world, DVec3 place) {
  return take(world.add_solid({.cells = {3, 3, 3}, .size = {2, 2, 2}, .position = place}));
}

template <class T>
T found(Result<std::optional<T>> result) {
  const std::optional<T> value = take(std::move(result));
  REQUIRE(value.has_value());
  return *value;
}

template <class Points>
DVec3 weighted(const Points& points, const DeformablePlace& place) {
  DVec3 sum;
  for (std::size_t i = 0; i < 3; ++i) sum += d(place.weights[i]) * points[place.corners[i]];
  return sum;
}

bool is_near(DVec3 a, DVec3 b, double within = 1e-5) {
  return length(a - b) < within;
}

}  // namespace

TEST_SUITE("world/deformable_queries") {
  TEST_CASE("a ray meets a cloth on the triangle that its corners and weights name, from both sides") {
    World world = make_world(empty_space());
    const ClothId sheet = add_sheet(world);
    for (const double side : {1.0, -1.0}) {
      const auto hit = found(world.cast_ray_on_deformables({1.3, 0.4, 5 * side}, {0, 0, -20 * side}));
      CHECK(hit.fraction == doctest::Approx(0.25).epsilon(1e-6));
      CHECK(hit.distance == doctest::Approx(5).epsilon(1e-6));
      CHECK(is_near(hit.place.point, {1.3, 0.4, 0}));
      CHECK(d(hit.place.normal.z) == doctest::Approx(side));
      CHECK(is_near(weighted(world.positions(sheet), hit.place), {1.3, 0.4, 0}));
      const auto corners = world.triangles(sheet)[hit.place.element];
      CHECK(hit.place.corners == corners);
      const auto most = std::max_element(hit.place.weights.begin(), hit.place.weights.end());
      const auto index = hit.place.corners[static_cast<std::size_t>(most - hit.place.weights.begin())];
      CHECK(hit.place.nearest == point(sheet, index));
    }
    CHECK_FALSE(take(world.cast_ray_on_deformables({1.3, 0.4, 5}, {0, 0, -4.9})).has_value());
    CHECK_FALSE(take(world.cast_ray_on_deformables({3.01, 0.4, 5}, {0, 0, -20})).has_value());
  }

  TEST_CASE("no ray slips through an edge or a corner of a cloth or a solid") {
    World world = make_world(empty_space());
    add_sheet(world);
    add_cube(world, {10, 0, 0});
    for (double x = 0.5; x < 3; x += 0.5) {
      for (double y = 0.5; y < 2; y += 0.5)
        CHECK(take(world.cast_ray_on_deformables({x, y, 1}, {0, 0, -2})).has_value());
    }
    for (double x = 9 + 1.0 / 3; x < 10.9; x += 1.0 / 3)
      CHECK(take(world.cast_ray_on_deformables({x, 5, 1.0 / 3}, {0, -10, 0})).has_value());
  }

  TEST_CASE("a ray meets a rope as a tube with round ends, and a margin makes it thicker") {
    World world = make_world(empty_space());
    const RopeId rope = add_line(world, {0, 1, 0}, {1, 0, 0});
    // Across the middle line at 0.06 beside it: the tube of radius 0.1 begins 0.08 before it.
    const auto side = found(world.cast_ray_on_deformables({3.25, 1.06, 2}, {0, 0, -4}));
    CHECK(side.distance == doctest::Approx(1.92).epsilon(1e-6));
    CHECK(is_near(vector_cast<double>(side.place.normal), {0, 0.6, 0.8}));
    CHECK(side.place.element == 3);
    CHECK(d(side.place.weights[1]) == doctest::Approx(0.25).epsilon(1e-5));
    CHECK(side.place.nearest == point(rope, 3));
    // Along the rope from its end: the cap.
    const auto end = found(world.cast_ray_on_deformables({12, 1, 0}, {-4, 0, 0}));
    CHECK(end.distance == doctest::Approx(1.9).epsilon(1e-6));
    CHECK(end.place.nearest == point(rope, 10));
    // A ray that begins inside meets it at once.
    CHECK(found(world.cast_ray_on_deformables({5, 1.05, 0}, {0, 3, 0})).fraction == 0);
    CHECK_FALSE(take(world.cast_ray_on_deformables({5, 1.25, 2}, {0, 0, -4})).has_value());
    CHECK(take(world.cast_ray_on_deformables({5, 1.25, 2}, {0, 0, -4}, {.margin = Real(0.2)})).has_value());
  }

  TEST_CASE("a ray meets the surface of a solid and a particle's ball, the nearest of all first") {
    World world = make_world(empty_space());
    const SolidId cube = add_cube(world, {10, 0, 0});
    const ParticlesId dust =
        take(world.add_particles({.particles = {{.position = {3, 0, 0}, .radius = Real(0.5)},
                                                {.position = {5, 0.3, 0}, .radius = Real(0.5)}}}));
    const auto first = found(world.cast_ray_on_deformables({0, 0.3, 0.1}, {20, 0, 0}));
    CHECK(first.place.nearest == point(dust, 0));
    CHECK(first.distance == doctest::Approx(3 - std::sqrt(0.25 - 0.1)).epsilon(1e-5));
    const auto second =
        found(world.cast_ray_on_deformables({0, 0.3, 0.1}, {20, 0, 0}, {.skip = point(dust, 1)}));
    CHECK(second.distance == doctest::Approx(9).epsilon(1e-6));
    CHECK(second.place.nearest.kind == PointRef::Kind::kSolid);
    CHECK(is_near(vector_cast<double>(second.place.normal), {-1, 0, 0}));
    CHECK(is_near(weighted(world.surface(cube), second.place), {9, 0.3, 0.1}));
    CHECK(world.triangles(cube)[second.place.element] == second.place.corners);
    // The point with the largest share is one of the nearest four.
    CHECK(length(world.positions(cube)[second.place.nearest.index] - second.place.point) < 0.5);
    // From within, the other side is met, and its normal is outward.
    const auto within = found(world.cast_ray_on_deformables({10, 0.3, 0.1}, {20, 0, 0}));
    CHECK(within.distance == doctest::Approx(1).epsilon(1e-5));
    CHECK(d(within.place.normal.x) == doctest::Approx(1));
  }

  TEST_CASE("filters leave out kinds, and cloths that a cloth with the filter would not touch") {
    World world = make_world(empty_space());
    const ClothId near = add_sheet(world, 1, {.category = 2});
    const ClothId far = add_sheet(world, 0, {.category = 4});
    const DVec3 origin = {1.3, 0.4, 5};
    const DVec3 motion = {0, 0, -20};
    const auto slot = [&](const DeformableFilter& filter) {
      return found(world.cast_ray_on_deformables(origin, motion, filter)).place.nearest.slot;
    };
    CHECK(slot({}) == near.slot);
    CHECK(slot({.filter = {.mask = 4}}) == far.slot);
    CHECK(slot({.skip = point(near, 0)}) == far.slot);
    CHECK_FALSE(take(world.cast_ray_on_deformables(origin, motion, {.cloths = false})).has_value());
    CHECK_FALSE(take(world.cast_ray_on_deformables(origin, motion, {.filter = {.mask = 8}})).has_value());
  }

  TEST_CASE("the nearest place is at the distance of plane, tube and ball, and inside it is negative") {
    World world = make_world(empty_space());
    const ClothId sheet = add_sheet(world);
    const auto on_sheet = found(world.find_closest_deformable({1.3, 0.4, -2}, kForever));
    CHECK(d(on_sheet.distance) == doctest::Approx(2).epsilon(1e-6));
    CHECK(is_near(on_sheet.place.point, {1.3, 0.4, 0}));
    CHECK(d(on_sheet.place.normal.z) == doctest::Approx(-1));
    const auto at_corner = found(world.find_closest_deformable({-3, -4, 0}, 6));
    CHECK(d(at_corner.distance) == doctest::Approx(5).epsilon(1e-6));
    CHECK(at_corner.place.nearest == point(sheet, 8));
    CHECK_FALSE(take(world.find_closest_deformable({-3, -4, 0}, Real(4.9))).has_value());

    add_line(world, {0, -5, 0}, {1, 0, 0});
    const auto in_rope = found(world.find_closest_deformable({5, -5.04, 0}, 0));
    CHECK(d(in_rope.distance) == doctest::Approx(-0.06).epsilon(1e-5));
    CHECK(is_near(in_rope.place.point, {5, -5.1, 0}));

    const SolidId cube = add_cube(world, {20, 0, 0});
    const auto in_cube = found(world.find_closest_deformable({20.7, 0.1, 0.2}, 0));
    CHECK(in_cube.place.nearest.slot == cube.slot);
    CHECK(d(in_cube.distance) == doctest::Approx(-0.3).epsilon(1e-5));
    CHECK(is_near(in_cube.place.point, {21, 0.1, 0.2}));
    CHECK(d(in_cube.place.normal.x) == doctest::Approx(1));
  }

  TEST_CASE("a sphere finds what it touches and what it is in, in order of creation") {
    World world = make_world(empty_space());
    const SolidId cube = add_cube(world, {0, 0, 0});
    const RopeId rope = add_line(world, {-5, 1.5, 0}, {1, 0, 0});
    add_cube(world, {50, 0, 0});
    const auto inside = take(world.find_deformables({0, 0, 0}, Real(0.1)));
    REQUIRE(inside.size() == 1);
    CHECK(inside[0].place.nearest.kind == PointRef::Kind::kSolid);
    CHECK(inside[0].place.nearest.slot == cube.slot);
    CHECK(d(inside[0].distance) == doctest::Approx(-1).epsilon(1e-5));
    const auto both = take(world.find_deformables({0, 1.2, 0}, Real(0.21)));
    REQUIRE(both.size() == 2);
    CHECK(both[0].place.nearest.slot == cube.slot);
    CHECK(both[1].place.nearest.kind == PointRef::Kind::kRope);
    CHECK(both[1].place.nearest.slot == rope.slot);
    CHECK(take(world.find_deformables({0, 1.2, 0}, Real(0.15))).empty());
  }

  TEST_CASE("what the nearest place says agrees with a search over all points, in a world that moves") {
    WorldDesc desc = without_air();
    World world = make_world(desc);
    const ClothId sheet = add_sheet(world);
    const SolidId cube = add_cube(world, {1, -2, 0});
    take(world.add_body({.shape = Shape::half_space(), .position = {0, -4, 0}}));
    run(world, 40);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 40; ++i) {
      const DVec3 asked = {5 * share(random) - 1, 6 * share(random) - 4, 3 * share(random) - 1};
      double nearest = 1e9;
      for (std::size_t k = 0; k < world.positions(sheet).size(); ++k)
        nearest = std::fmin(nearest, length(world.positions(sheet)[k] - asked));
      for (const DVec3 x : world.surface(cube)) nearest = std::fmin(nearest, length(x - asked));
      const auto closest = found(world.find_closest_deformable(asked, kForever));
      CHECK(std::fabs(d(closest.distance)) <= nearest + 1e-5);
      CHECK(length(closest.place.point - asked) ==
            doctest::Approx(std::fabs(d(closest.distance))).epsilon(1e-4));
      const bool is_cloth = closest.place.nearest.kind == PointRef::Kind::kCloth;
      const DVec3 again = is_cloth ? weighted(world.positions(sheet), closest.place)
                                   : weighted(world.surface(cube), closest.place);
      CHECK(is_near(again, closest.place.point, 1e-4));
      // A ray to that place meets it there; through an edge it may slip past the border.
      const auto [a, b, c] = closest.place.weights;
      if (d(closest.distance) > 1e-3 && std::min({a, b, c}) > Real(0.01)) {
        const auto hit = found(world.cast_ray_on_deformables(asked, 1.01 * (closest.place.point - asked)));
        CHECK(hit.distance == doctest::Approx(d(closest.distance)).epsilon(1e-3));
      }
    }
  }

  TEST_CASE("bad questions are errors that name what is wrong") {
    World world = make_world();
    const RopeId rope = add_line(world, {0, 0, 0}, {1, 0, 0});
    CHECK(world.cast_ray_on_deformables({0, 0, 0}, {0, 0, 0}).error().where == "query.motion");
    CHECK(world.cast_ray_on_deformables({1e10, 0, 0}, {1, 0, 0}).error().where == "query.origin");
    CHECK(world.cast_ray_on_deformables({0, 0, 0}, {1, 0, 0}, {.margin = -1}).error().where ==
          "query.filter.margin");
    CHECK(world.find_closest_deformable({0, 0, 0}, kNan).error().where == "query.reach");
    CHECK(world.find_deformables({0, 0, 0}, -1).error().where == "query.radius");
    world.remove(rope);
    const auto stale = world.find_deformables({0, 0, 0}, 1, {.skip = point(rope, 0)});
    REQUIRE_FALSE(stale.has_value());
    CHECK(stale.error().code == ErrorCode::kStaleId);
    CHECK(take(world.find_deformables({0, 0, 0}, kForever)).empty());
  }

  TEST_CASE("the mass of a deformable is that of its description and its loads") {
    World world = make_world();
    const RopeId rope =
        take(world.add_rope({.total_mass = Real(0.4), .loads = {{.point = 15, .mass = Real(2)}}}));
    CHECK(d(world.mass(rope)) == doctest::Approx(2.4).epsilon(1e-5));
    const ClothId sheet = add_sheet(world);
    CHECK(d(world.mass(sheet)) == doctest::Approx(0.2 * 6).epsilon(1e-5));
    CHECK(d(world.mass(add_cube(world, {0, 0, 9}))) == doctest::Approx(8000).epsilon(1e-5));
    world.remove(rope);
    CHECK(world.mass(rope) == Real(0));
  }
}

}  // namespace hooke
