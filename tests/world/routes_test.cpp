#include "world/make.h"

#include <cstdint>
#include <doctest/doctest.h>
#include <vector>

// StepReport::routes says which way a step solved each contact, hook and rope: src/solver/routes.h.

using hooke::BodyDesc;
using hooke::BodyId;
using hooke::BodyKind;
using hooke::ContactDesc;
using hooke::DVec3;
using hooke::HookKind;
using hooke::Real;
using hooke::RopeId;
using hooke::RouteCounts;
using hooke::Shape;
using hooke::StepReport;
using hooke::World;
using hooke::test::make_world;
using hooke::test::run;
using hooke::test::take;

namespace {

constexpr Real kDt = Real(1) / Real(60);

void add_ground(World& world) {
  take(world.add_body({.kind = BodyKind::kStatic, .shape = Shape::half_space()}));
}

BodyId add_cube(World& world, DVec3 position, Real mass = Real(1)) {
  return take(world.add_body({.kind = BodyKind::kDynamic,
                              .shape = Shape::box({Real(0.25), Real(0.25), Real(0.25)}),
                              .position = position,
                              .mass = mass}));
}

void add_ball_hook(World& world, BodyId a, BodyId b, DVec3 anchor) {
  take(world.add_hook({.kind = HookKind::kBall, .a = {.body = a}, .b = {.body = b}, .anchor = anchor}));
}

RouteCounts routes_of(World& world) {
  const StepReport report = world.step(kDt);
  REQUIRE(report.healthy());
  return report.routes;
}

}  // namespace

TEST_SUITE("world/routes") {
  TEST_CASE("a cube on the ground is a soft contact, and none in the air") {
    World world = make_world();
    add_ground(world);
    add_cube(world, {0, 0.25, 0});
    add_cube(world, {5, 3, 0});
    const RouteCounts routes = routes_of(world);
    CHECK(routes.contacts_soft == 1);
    CHECK(routes.contacts_direct == 0);
    CHECK(routes.contacts_coupled == 0);
    CHECK(routes.contacts_bouncing == 0);
    CHECK(routes.pairs_at_start == 1);
  }

  TEST_CASE("a new tower of ten cubes is one direct island with ten contacts") {
    World world = make_world();
    add_ground(world);
    for (int i = 0; i < 10; ++i) add_cube(world, {0, 0.25 + 0.5 * i, 0});
    const RouteCounts routes = routes_of(world);
    CHECK(routes.direct_islands == 1);
    CHECK(routes.contacts_direct == 10);
    CHECK(routes.contacts_soft == 0);
  }

  TEST_CASE("a ball with restitution that touches bounces") {
    World world = make_world();
    add_ground(world);
    take(world.add_body({.kind = BodyKind::kDynamic,
                         .shape = Shape::sphere(Real(0.5)),
                         .position = {0, 0.5, 0},
                         .contact = {.restitution = Real(0.5)}}));
    CHECK(routes_of(world).contacts_bouncing == 1);
  }

  TEST_CASE("a chain of four bodies is a tree, and closed to a ring a loop") {
    for (const bool closed : {false, true}) {
      World world = make_world();
      std::vector<BodyId> ids;
      const DVec3 place[] = {{0, 5, 0}, {1, 5, 0}, {1, 4, 0}, {0, 4, 0}};
      for (const DVec3 p : place) ids.push_back(add_cube(world, p));
      for (std::size_t i = 0; i + 1 < ids.size(); ++i)
        add_ball_hook(world, ids[i], ids[i + 1], 0.5 * (place[i] + place[i + 1]));
      if (closed) add_ball_hook(world, ids[3], ids[0], 0.5 * (place[3] + place[0]));
      const RouteCounts routes = routes_of(world);
      CHECK(routes.articulations == 1);
      CHECK(routes.hooks_tree == (closed ? 0 : 3));
      CHECK(routes.hooks_loop == (closed ? 4 : 0));
      CHECK(routes.hooks_approximate_tree + routes.hooks_block + routes.hooks_iterative +
                routes.hooks_coupled ==
            0);
    }
  }

  TEST_CASE("hooks of bodies that sleep are solved by none") {
    World world = make_world();
    add_ground(world);
    const BodyId a = add_cube(world, {0, 0.25, 0});
    const BodyId b = add_cube(world, {0.6, 0.25, 0});
    add_ball_hook(world, a, b, {0.3, 0.25, 0});
    CHECK(routes_of(world).hooks_tree == 1);
    run(world, 200);
    REQUIRE(world.asleep(a));
    const RouteCounts routes = routes_of(world);
    CHECK(routes.hooks_tree == 0);
    CHECK(routes.articulations == 0);
  }

  TEST_CASE("a pinned point on a cube is swept") {
    World world = make_world();
    add_ground(world);
    add_cube(world, {0, 0.25, 0});
    hooke::ParticlesDesc desc;
    desc.particles = {{.position = {0, 0.505, 0}, .mass = 1, .radius = Real(0.01)}};
    desc.pins = {hooke::PinDesc{0}};
    take(world.add_particles(desc));
    const RouteCounts routes = routes_of(world);
    CHECK(routes.points_swept == 1);
    CHECK(routes.points_coupled == 0);
  }

  TEST_CASE("a net of 30 x 30 hooked balls is beyond the budget, and iterated") {
    World world = make_world();
    constexpr int kSide = 30;
    std::vector<BodyId> ids;
    for (int i = 0; i < kSide * kSide; ++i) {
      ids.push_back(take(world.add_body({.kind = BodyKind::kDynamic,
                                         .shape = Shape::sphere(Real(0.2)),
                                         .position = {i % kSide * 0.5, 10, i / kSide * 0.5}})));
    }
    for (int i = 0; i < kSide * kSide; ++i) {
      const DVec3 at = {i % kSide * 0.5, 10, i / kSide * 0.5};
      if (i % kSide > 0) add_ball_hook(world, ids[i - 1], ids[i], at - DVec3{0.25, 0, 0});
      if (i >= kSide) add_ball_hook(world, ids[i - kSide], ids[i], at - DVec3{0, 0, 0.25});
    }
    const RouteCounts routes = routes_of(world);
    CHECK(routes.hooks_block + routes.hooks_iterative == 2 * kSide * (kSide - 1));
    CHECK(routes.articulations == 0);
  }

  TEST_CASE("a rope alone is a rope system, and with a load on its end part of a coupled group") {
    World world = make_world();
    take(world.add_rope({.hook_point = {0, 5, 0}}));
    const RopeId rope =
        take(world.add_rope({.hook_point = {3, 5, 0}, .direction = {0, -1, 0}, .masses = 16}));
    const DVec3 end = world.positions(rope)[15];
    const BodyId load = add_cube(world, end - DVec3{0, 0.25, 0}, Real(50));
    take(world.add_hook(
        {.kind = HookKind::kBall, .a = {.point = point(rope, 15)}, .b = {.body = load}, .anchor = end}));
    const RouteCounts routes = routes_of(world);
    CHECK(routes.ropes_alone == 1);
    CHECK(routes.ropes_coupled == 1);
    CHECK(routes.coupled_groups == 1);
    CHECK(routes.hooks_coupled == 1);
  }

  TEST_CASE("a ton on a plank that hangs on hooks is solved with them") {
    World world = make_world();
    const BodyId wall = take(world.add_body({.kind = BodyKind::kStatic,
                                             .shape = Shape::box({Real(0.1), Real(1), Real(1)}),
                                             .position = {-2, 1, 0}}));
    const BodyId plank = take(world.add_body({.kind = BodyKind::kDynamic,
                                              .shape = Shape::box({Real(1), Real(0.05), Real(0.5)}),
                                              .position = {0, 1, 0},
                                              .mass = Real(5)}));
    take(world.add_hook({.kind = HookKind::kHinge,
                         .a = {.body = wall},
                         .b = {.body = plank},
                         .anchor = {-1.5, 1, 0},
                         .axis = {Real(0), Real(0), Real(1)}}));
    add_cube(world, {0, 1.3, 0}, Real(1000));
    run(world, 2);
    const RouteCounts routes = routes_of(world);
    CHECK(routes.contacts_coupled == 1);
    CHECK(routes.hooks_coupled == 1);
    CHECK(routes.hooks_tree == 0);
  }

  TEST_CASE("points of a group of particles on the ground are swept") {
    World world = make_world();
    add_ground(world);
    take(world.add_particles({.particles = {{.position = {0, 0.01, 0}, .mass = Real(1)},
                                            {.position = {1, 0.01, 0}, .mass = Real(1)}}}));
    const RouteCounts routes = routes_of(world);
    CHECK(routes.points_swept == 2);
    CHECK(routes.points_in_ropes + routes.points_coupled == 0);
  }
}
