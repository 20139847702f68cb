#include "collision/pairs.h"
#include "geometry/meshes.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
const Shape kCube = Shape::box({Real(0.5), Real(0.5), Real(0.5)});
const Shape kBall = Shape::sphere(Real(0.5));

BodyId add(World& world, const Shape& shape, DVec3 position, BodyKind kind = BodyKind::kStatic) {
  return take(world.add_body({.kind = kind, .shape = shape, .position = position}));
}

/// One triangle in the plane y = 0, its front up.
MeshId add_triangle(World& world) {
  return take(world.add_mesh({.positions = {{-5, 0, -5}, {0, 0, 5}, {5, 0, -5}}, .triangles = {{0, 1, 2}}}));
}

/// A few of every shape on a half-space, moving and still.
World make_crowd() {
  World world = make_world();
  add(world, Shape::half_space(), {0, 0, 0});
  const MeshId mesh = take(world.add_mesh(test::make_sphere(2)));
  const Shape shapes[] = {kCube,
                          kBall,
                          Shape::capsule(Real(0.3), Real(0.4)),
                          Shape::cylinder(Real(0.4), Real(0.5)),
                          Shape::cone(Real(0.4), Real(0.5)),
                          Shape::hull_of(mesh)};
  for (int i = 0; i < 90; ++i) {
    const DVec3 place = {1.7 * (i % 5) - 3, 1 + 1.3 * (i / 25), 1.6 * (i / 5 % 5) - 3};
    add(world, shapes[i % 6], place, i % 3 == 0 ? BodyKind::kStatic : BodyKind::kDynamic);
  }
  add(world, Shape::of_mesh(mesh), {0, 8, 0});
  return world;
}

/// Answers to a fixed set of questions, to the last bit.
std::vector<double> answers_of(const World& world) {
  std::vector<double> answers;
  const auto note = [&](const CastHit& hit) {
    for (const double x : {double(hit.body.slot), double(hit.part), double(hit.triangle), hit.fraction,
                           hit.point.x, hit.point.y, d(hit.normal.x), d(hit.normal.z)}) {
      answers.push_back(x);
    }
  };
  for (int i = 0; i < 60; ++i) {
    const DVec3 from = {4 * std::cos(i), 0.3 + 0.15 * i, 5 * std::sin(1.7 * i)};
    const DVec3 motion = DVec3{0.1 * i - 3, 1, 0.4} - from;
    for (const CastHit& hit : take(world.cast_ray_through(from, motion))) note(hit);
    if (const auto hit = take(world.cast_shape(kBall, {from}, motion))) note(*hit);
    if (const auto near = take(world.find_closest(from, 3))) answers.push_back(d(near->distance));
    for (const BodyPart& part : take(world.find_overlaps(kCube, {from}))) answers.push_back(part.body.slot);
  }
  return answers;
}

}  // namespace

TEST_SUITE("world/queries") {
  TEST_CASE("a ray meets boxes in the order in which they stand") {
    World world = make_world();
    const BodyId far = add(world, kCube, {7, 0, 0});
    const BodyId near = add(world, kCube, {3, 0, 0});
    const auto hit = take(world.cast_ray({0, 0.25, 0}, {10, 0, 0}));
    REQUIRE(hit);
    CHECK(hit->body == near);
    CHECK(hit->distance == doctest::Approx(2.5));
    CHECK(hit->fraction == doctest::Approx(0.25));
    CHECK(length(hit->point - DVec3{2.5, 0.25, 0}) < 1e-9);
    CHECK(hit->normal == Vec3{-1, 0, 0});
    const auto all = take(world.cast_ray_through({0, 0.25, 0}, {10, 0, 0}));
    REQUIRE(all.size() == 2);
    CHECK(all[1].body == far);
    CHECK(all[1].distance == doctest::Approx(6.5));
    CHECK(take(world.is_ray_blocked({0, 0.25, 0}, {10, 0, 0})));
    CHECK_FALSE(take(world.is_ray_blocked({0, 0.25, 0}, {2.4, 0, 0})));
    CHECK_FALSE(take(world.cast_ray({0, 0.6, 0}, {10, 0, 0})));
  }

  TEST_CASE("of equally near bodies the one created first is met, also where a removed one left a hole") {
    World world = make_world();
    const BodyId gone = add(world, kCube, {3, 0, 0});
    const BodyId first = add(world, kCube, {3, 0, 0});
    CHECK(world.remove(gone));
    add(world, kCube, {3, 0, 0});  // in the rows of the one that is gone
    CHECK(take(world.cast_ray({0, 0, 0}, {10, 0, 0}))->body == first);
    CHECK(take(world.cast_shape(kBall, {}, {10, 0, 0}))->body == first);
    CHECK(take(world.find_closest({0, 0, 0}, 5))->body == first);
    CHECK(take(world.find_overlaps(kBall, {{3, 0, 0}}))[0].body == first);
    CHECK(take(world.find_in_box({3, 0, 0}, {3, 0, 0}))[0].body == first);
  }

  TEST_CASE("the filter finds what would collide with it, and neither sensors nor what is only drawn") {
    World world = make_world();
    const auto put = [&](double x, const FilterDesc& filter, bool sensor, bool collides) {
      BodyDesc desc;
      desc.shape = kCube;
      desc.position = {x, 0, 0};
      desc.filter = filter;
      desc.sensor = sensor;
      desc.collides = collides;
      return take(world.add_body(desc));
    };
    put(2, {}, false, false);
    const BodyId sensor = put(4, {}, true, true);
    const BodyId second = put(6, {.category = 2}, false, true);
    const BodyId third = put(8, {.category = 4, .mask = 2}, false, true);
    const auto first_of = [&](const QueryFilter& filter) {
      const auto hit = take(world.cast_ray({0, 0, 0}, {20, 0, 0}, filter));
      return hit ? hit->body : BodyId{};
    };
    CHECK(first_of({}) == second);
    CHECK(first_of({.sensors = true}) == sensor);
    CHECK(first_of({.skip = second}) == BodyId{});  // the third does not want category 1
    CHECK(first_of({.filter = {.category = 2}, .skip = second}) == third);
    CHECK(first_of({.filter = {.mask = 1}}) == BodyId{});
  }

  TEST_CASE("a ball swept onto each shape stops at its surface") {
    World world = make_world();
    const MeshId mesh =
        take(world.add_mesh({.positions = {{-1, -1, -1}, {3, -1, -1}, {-1, 3, -1}, {-1, -1, 3}},
                             .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}}));
    struct Case {
      Shape shape;
      DVec3 start;
      DVec3 motion;
      double distance;  // of the ball of radius 0.5 along the motion
    };
    const double slant = 0.5 * std::sqrt(5.0) / 2;  // how far ahead of a side of slope 2 the center stays
    const Case cases[] = {
        {Shape::half_space(), {0, 3, 0}, {0, -6, 0}, 2.5},
        {kBall, {-4, 0.6, 0}, {8, 0, 0}, 4 - 0.8},
        {kCube, {-4, 0, 0}, {8, 0, 0}, 3},
        {kCube, {-4, 0.8, 0}, {8, 0, 0}, 4 - 0.5 - 0.4},  // the edge: sqrt(0.5^2 - 0.3^2) ahead
        {Shape::capsule(Real(0.5), Real(1)), {0, 5, 0.6}, {0, -9, 0}, 5 - 1 - 0.8},
        {Shape::cylinder(Real(1), Real(1)), {4, 0.5, 0}, {-8, 0, 0}, 2.5},
        {Shape::cone(Real(1), Real(1)), {4, 0, 0}, {-8, 0, 0}, 4 - 0.5 - slant},
        {Shape::hull_of(mesh), {-4, 0, 0}, {8, 0, 0}, 2.5},
        {Shape::of_mesh(mesh), {-4, 0, 0}, {8, 0, 0}, 2.5},
    };
    for (const Case& c : cases) {
      CAPTURE(static_cast<int>(c.shape.kind));
      const BodyId body = add(world, c.shape, {100, 20, 0});
      const auto hit = take(world.cast_shape(kBall, {c.start + DVec3{100, 20, 0}}, c.motion));
      REQUIRE(hit);
      CHECK(hit->body == body);
      CHECK(hit->distance == doctest::Approx(c.distance).epsilon(2e-5));
      const DVec3 center = c.start + DVec3{100, 20, 0} + hit->fraction * c.motion;
      CHECK(length(hit->point - center) == doctest::Approx(0.5).epsilon(1e-4));
      CHECK(length(center - hit->point - 0.5 * vector_cast<double>(hit->normal)) < 1e-3);
      world.remove(body);
    }
  }

  TEST_CASE("a swept shape of any kind overlaps nothing before its hit, and all but touches there") {
    World world = make_world();
    const MeshId mesh = take(world.add_mesh(test::make_sphere(1)));
    const Shape shapes[] = {Shape::box({Real(0.5), Real(0.3), Real(0.7)}),
                            kBall,
                            Shape::capsule(Real(0.3), Real(0.4)),
                            Shape::cylinder(Real(0.4), Real(0.5)),
                            Shape::cone(Real(0.4), Real(0.5)),
                            Shape::hull_of(mesh),
                            Shape::of_mesh(mesh),
                            Shape::half_space()};
    std::mt19937 random(5);
    const auto place = [&](double size) {
      const double x = d(test::uniform(random, -size, size));
      const double y = d(test::uniform(random, -size, size));
      return DVec3{x, y, d(test::uniform(random, -size, size))};
    };
    int hits = 0;
    int misses = 0;
    for (int i = 0; i < 600; ++i) {
      const Shape& target = shapes[i % 8];
      const Shape& moved = shapes[i / 8 % 6];
      const BodyId body = take(
          world.add_body({.shape = target, .position = place(1), .rotation = test::random_turn(random)}));
      const Pose start = {place(4), test::random_turn(random)};
      const DVec3 motion = place(1) - 1.5 * start.position;
      const auto overlaps = [&](DVec3 position) {
        return !take(world.find_overlaps(moved, {position, start.rotation})).empty();
      };
      const auto hit = take(world.cast_shape(moved, start, motion));
      const double end = hit ? hit->fraction : 1.0;
      CAPTURE(i);
      for (int k = 0; k <= 40 && end > 0; ++k)
        REQUIRE_FALSE(overlaps(start.position + k / 40.0 * end * motion));
      if (hit) {
        const DVec3 in = -1e-3 * vector_cast<double>(hit->normal);
        CHECK(overlaps(start.position + end * motion + in));
      }
      ++(hit ? hits : misses);
      world.remove(body);
    }
    CHECK(hits > 200);
    CHECK(misses > 50);
  }

  TEST_CASE("a swept box meets corners, and passes what its path only grazes") {
    World world = make_world();
    add(world, kCube, {5, 0, 0});
    const Quat eighth = quaternion_about(Vec3{0, 0, 1}, Real(std::atan(1.0)));
    const auto edge = take(world.cast_shape(kCube, {{0, 0, 0}, eighth}, {10, 0, 0}));
    REQUIRE(edge);
    CHECK(edge->distance == doctest::Approx(4.5 - std::sqrt(0.5)).epsilon(1e-5));
    CHECK(take(world.cast_shape(kCube, {{0, 0.999, 0}}, {10, 0, 0})));
    CHECK_FALSE(take(world.cast_shape(kCube, {{0, 1.001, 0}}, {10, 0, 0})));
    CHECK_FALSE(take(world.cast_shape(kCube, {{0, 0, 0}}, {3.999, 0, 0})));
    CHECK_FALSE(take(world.cast_shape(kCube, {{0, 0, 0}}, {-10, 0, 0})));
  }

  TEST_CASE("a shape that overlaps at the start is met at once, with the normal of the shortest exit") {
    World world = make_world();
    const BodyId body = add(world, kCube, {0, 0, 0});
    const auto hit = take(world.cast_shape(kBall, {{0.1, 0.8, 0}}, {5, 0, 0}));
    REQUIRE(hit);
    CHECK(hit->body == body);
    CHECK(hit->fraction == 0.0);
    CHECK(d(hit->normal.y) == doctest::Approx(1));
    // On a floor, at rest: sideways is free.
    world.remove(body);
    add(world, Shape::half_space(), {0, 0, 0});
    CHECK(take(world.cast_shape(kBall, {{0, 0.4, 0}}, {5, 0, 0}))->fraction == 0.0);
    CHECK_FALSE(take(world.cast_shape(kBall, {{0, 0.501, 0}}, {5, 0, 0})));
  }

  TEST_CASE("a shape swept over a kilometer, far from the origin, is right to a tenth of a millimeter") {
    World world = make_world();
    add(world, kCube, {1e6, 0, 1e6});
    const auto hit = take(world.cast_shape(kBall, {{1e6 - 1000, 0, 1e6}}, {2000, 0, 0}));
    REQUIRE(hit);
    CHECK(std::abs(hit->distance - 999) < 1e-4);
  }

  TEST_CASE("a mesh is met from both sides, and the triangle is told") {
    World world = make_world();
    const BodyId body = add(world, Shape::of_mesh(add_triangle(world)), {0, 1, 0});
    for (const double side : {1.0, -1.0}) {
      const auto ray = take(world.cast_ray({0, 1 + 2 * side, 0}, {0, -4 * side, 0}));
      REQUIRE(ray);
      CHECK(ray->body == body);
      CHECK(ray->distance == doctest::Approx(2));
      CHECK(ray->triangle == 0);
      const auto ball = take(world.cast_shape(kBall, {{0, 1 + 2 * side, 0}}, {0, -4 * side, 0}));
      REQUIRE(ball);
      CHECK(ball->distance == doctest::Approx(1.5).epsilon(1e-4));
      CHECK(d(ball->normal.y) == doctest::Approx(side));
      const auto near = take(world.find_closest({0, 1 + 2 * side, 0}, 3));
      REQUIRE(near);
      CHECK(d(near->distance) == doctest::Approx(2));
      CHECK(d(near->normal.y) == doctest::Approx(side));
    }
    CHECK(take(world.find_overlaps(kBall, {{0, 1.4, 0}})).size() == 1);
    CHECK(take(world.find_overlaps(kBall, {{0, 1.6, 0}})).empty());
    CHECK(take(world.find_overlaps(kBall, {{4.9, 1.4, 4}})).empty());
  }

  TEST_CASE("overlaps and boxes list parts in the order of creation") {
    World world = make_world();
    const BodyId ground = add(world, Shape::half_space(), {0, 0, 0});
    const BodyId dumbbell = take(world.add_body(
        {.kind = BodyKind::kDynamic,
         .shape = Shape::compound(),
         .parts = {{.shape = kBall, .position = {-2, 0, 0}}, {.shape = kBall, .position = {2, 0, 0}}},
         .position = {0, 0.6, 0}}));
    const std::vector<BodyPart> right = {{ground, 0}, {dumbbell, 1}};
    CHECK(take(world.find_overlaps(kCube, {{2.2, 0.4, 0}})) == right);
    CHECK(take(world.find_overlaps(kCube, {{0, 1, 0}})).empty());
    // The corner of the ball's box is empty, which only the exact question tells.
    CHECK(take(world.find_in_box({1.52, 0.9, 0.4}, {1.6, 1.09, 0.49})) == right);
    CHECK(take(world.find_overlaps(Shape::box({Real(0.04), Real(0.05), Real(0.04)}), {{1.56, 1, 0.44}}))
              .empty());
    CHECK(take(world.cast_ray({2, 5, 0}, {0, -9, 0}))->part == 1);
  }

  TEST_CASE("the closest point is on the nearest surface, inside at a negative distance") {
    World world = make_world();
    add(world, Shape::half_space(), {0, 0, 0});
    const BodyId ball = add(world, kBall, {3, 2, 0});
    const auto outside = take(world.find_closest({3, 4, 0}, 10));
    REQUIRE(outside);
    CHECK(outside->body == ball);
    CHECK(d(outside->distance) == doctest::Approx(1.5));
    CHECK(length(outside->point - DVec3{3, 2.5, 0}) < 1e-6);
    CHECK(d(outside->normal.y) == doctest::Approx(1));
    CHECK(d(take(world.find_closest({3, 2.2, 0}, 0))->distance) == doctest::Approx(-0.3));
    CHECK_FALSE(take(world.find_closest({3, 4, 0}, Real(1.4))));
    const auto endless = take(world.find_closest({3, 1e6, 0}, std::numeric_limits<Real>::infinity()));
    REQUIRE(endless);
    CHECK(endless->body == ball);
  }

  TEST_CASE("queries see where bodies are now: after a step, a pose set by hand, a removal, a restoration") {
    World world = make_world(test::empty_space());
    const BodyId body = add(world, kCube, {5, 0, 0}, BodyKind::kDynamic);
    const auto distance = [&] {
      const auto hit = take(world.cast_ray({0, 0, 0}, {1000, 0, 0}));
      return hit ? hit->distance : -1.0;
    };
    CHECK(distance() == doctest::Approx(4.5));
    REQUIRE(world.set_velocity(body, {60, 0, 0}));
    const Snapshot before = world.snapshot();
    run(world, 1);
    CHECK(distance() == doctest::Approx(5.5));
    REQUIRE(world.set_pose(body, {{205, 0, 0}}));
    CHECK(distance() == doctest::Approx(204.5));
    REQUIRE(world.restore(before));
    CHECK(distance() == doctest::Approx(4.5));
    CHECK(world.remove(body));
    CHECK(distance() == -1.0);
    // What stands is entered when it is placed, not in each step.
    run(world, 1);
    const BodyId wall = add(world, kCube, {9, 0, 0});
    CHECK(distance() == doctest::Approx(8.5));
    run(world, 1);
    REQUIRE(world.set_pose(wall, {{90, 0, 0}}));
    CHECK(distance() == doctest::Approx(89.5));
  }

  TEST_CASE("queries change nothing, so a world with queries in every step makes the same steps") {
    World quiet = make_crowd();
    World asked = make_crowd();
    for (int i = 0; i < 150; ++i) {
      run(quiet, 1);
      CHECK(take(asked.cast_ray({0, 20, 0}, {0.1, -30, 0})));
      run(asked, 1);
      REQUIRE(asked.state_hash() == quiet.state_hash());
    }
    CHECK(answers_of(asked) == answers_of(quiet));
    World restored = make_crowd();
    REQUIRE(restored.restore(quiet.snapshot()));
    CHECK(answers_of(restored) == answers_of(quiet));
  }

  TEST_CASE("many threads may make queries at once") {
    World world = make_crowd();
    run(world, 20);
    std::vector<std::vector<double>> answers(4);
    std::vector<std::thread> threads;
    for (auto& answer : answers) threads.emplace_back([&] { answer = answers_of(world); });
    for (std::thread& thread : threads) thread.join();
    CHECK(answers[0].size() > 300);
    for (const auto& answer : answers) CHECK(answer == answers[0]);
  }

  TEST_CASE("an invalid query is an error that names what is wrong") {
    World world = make_world();
    const BodyId body = add(world, kCube, {0, 0, 0});
    const auto wrong = [](const auto& result) {
      return result ? std::string("answered") : result.error().where;
    };
    const auto nan = static_cast<double>(kNan);
    CHECK(wrong(world.cast_ray({nan, 0, 0}, {1, 0, 0})) == "query.origin");
    CHECK(wrong(world.cast_ray({0, 0, 0}, {1, nan, 0})) == "query.motion");
    CHECK(wrong(world.cast_ray({0, 0, 0}, {0, 0, 0})) == "query.motion");
    CHECK(wrong(world.cast_ray_through({1e10, 0, 0}, {1, 0, 0})) == "query.origin");
    CHECK(wrong(world.is_ray_blocked({0, 0, 0}, {0, 1e300, 0})) == "query.motion");
    CHECK(wrong(world.cast_shape(kBall, {}, {0, 0, 0})) == "query.motion");
    CHECK(wrong(world.cast_shape(Shape::sphere(kNan), {}, {1, 0, 0})) == "shape.radius");
    CHECK(wrong(world.cast_shape(Shape::half_space(), {}, {1, 0, 0})) == "shape.kind");
    CHECK(wrong(world.cast_shape(Shape::hull_of({}), {}, {1, 0, 0})) == "shape.mesh");
    CHECK(wrong(world.find_overlaps(kBall, {{0, 0, 0}, {0, 0, 0, 0}})) == "query.pose.rotation");
    CHECK(wrong(world.find_overlaps(kBall, {{nan, 0, 0}})) == "query.pose.position");
    CHECK(wrong(world.find_in_box({1, 0, 0}, {0, 1, 1})) == "query.upper");
    CHECK(wrong(world.find_closest({0, 0, 0}, Real(-1))) == "query.reach");
    CHECK(wrong(world.find_closest({0, 0, 0}, kNan)) == "query.reach");
    CHECK(world.remove(body));
    const auto stale = world.cast_ray({0, 0, 0}, {1, 0, 0}, {.skip = body});
    REQUIRE_FALSE(stale);
    CHECK(stale.error().code == ErrorCode::kStaleId);
    CHECK_FALSE(take(world.cast_ray({0, 0, 0}, {1e-100, 0, 0})));
    std::string during;
    take(world.add_particles({.particles = {{.position = {0, 3, 0}}}}));
    take(world.add_force_law([&](ForceView&) { during = wrong(world.cast_ray({0, 0, 0}, {1, 0, 0})); }));
    run(world, 1);
    CHECK(during == "query");
  }
}

}  // namespace hooke
