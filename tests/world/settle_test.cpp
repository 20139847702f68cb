#include "hooke/world.h"

#include "constants.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <vector>

using doctest::Approx;
using hooke::BodyId;
using hooke::DVec3;
using hooke::Real;
using hooke::SettleEnd;
using hooke::SettleReport;
using hooke::Vec3;
using hooke::World;

namespace {

/// A prism along z with a regular polygon of that radius, as long as it is wide.
hooke::MeshDesc make_round_prism(std::uint32_t sides, double radius) {
  hooke::MeshDesc mesh;
  for (const double z : {-radius, radius}) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 2 * hooke::test::kPi * i / sides;
      mesh.positions.push_back({Real(radius * std::cos(angle)), Real(radius * std::sin(angle)), Real(z)});
    }
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides;
    mesh.triangles.push_back({i, next, sides + next});
    mesh.triangles.push_back({i, sides + next, sides + i});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({sides, sides + i, sides + next});
  }
  return mesh;
}

/// A world with a rope of 2 m between two places 1.6 m apart, 0.5 kg/m.
World make_rope_world(int workers, hooke::RopeId& rope) {
  World world = World::create({.workers = workers}).value();
  hooke::RopeDesc desc;
  desc.hook_point = {0, 2, 0};
  desc.direction = {Real(1), Real(0), Real(0)};
  desc.total_mass = Real(1);
  desc.masses = 41;
  desc.length_at_rest = Real(2);
  rope = world.add_rope(desc).value();
  REQUIRE(world.pin(hooke::point(rope, 0)).has_value());
  REQUIRE(world.set_position(hooke::point(rope, 40), {1.6, 2, 0}).has_value());
  REQUIRE(world.pin(hooke::point(rope, 40)).has_value());
  return world;
}

SettleReport settled(World& world, const hooke::SettleDesc& desc = {}) {
  auto report = world.settle(desc);
  REQUIRE(report.has_value());
  return report.value();
}

}  // namespace

TEST_SUITE_BEGIN("world/settle");

TEST_CASE("a hanging rope settles on the catenary, and time stands still") {
  hooke::RopeId rope;
  World world = make_rope_world(1, rope);
  const SettleReport report = settled(world, {.residual = 1e-4});
  CHECK(report.converged());
  CHECK(report.sum < 1e-3);
  CHECK(world.time() == 0);
  CHECK(world.step_count() == 0);
  // 2 a sinh(0.8 / a) = 2 gives a, and the sag a (cosh(0.8 / a) - 1).
  double low = 0.1;
  double high = 10;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high);
    (2 * a * std::sinh(0.8 / a) > 2 ? low : high) = a;
  }
  const double sag = low * (std::cosh(0.8 / low) - 1);
  CHECK(2 - world.positions(rope)[20].y == Approx(sag).epsilon(2e-3));
  CHECK(world.tensions(rope)[20] == Approx(0.5 * 9.81 * low).epsilon(0.01));
}

TEST_CASE("the same rest comes out with any number of workers, to the bit") {
  hooke::RopeId rope;
  World one = make_rope_world(1, rope);
  World three = make_rope_world(3, rope);
  const SettleReport a = settled(one);
  const SettleReport b = settled(three);
  CHECK(a.steps == b.steps);
  CHECK(one.state_hash() == three.state_hash());
}

TEST_CASE("a box that falls settles on the ground, awake before and damped after as it was") {
  World world = World::create().value();
  REQUIRE(world.add_body({.shape = hooke::Shape::half_space()}).has_value());
  const BodyId box = world
                         .add_body({.kind = hooke::BodyKind::kDynamic,
                                    .shape = hooke::Shape::box({Real(0.5), Real(0.5), Real(0.5)}),
                                    .position = {0, 1, 0},
                                    .linear_damping = Real(0.5)})
                         .value();
  const SettleReport report = settled(world);
  CHECK(report.end == SettleEnd::kBalanced);
  CHECK(report.sum <= 1e-5);
  CHECK(world.center_of_mass(box).y == Approx(0.5).epsilon(1e-3));
  CHECK(length(world.velocity(box)) == 0);
  // Free of the ground it loses speed as its damping says.
  REQUIRE(world.set_gravity({}).has_value());
  REQUIRE(world.set_velocity(box, {Real(0), Real(1), Real(0)}).has_value());
  for (int i = 0; i < 60; ++i) world.step(Real(1) / 60);
  CHECK(world.velocity(box).y == Approx(std::exp(-0.5)).epsilon(0.01));
}

TEST_CASE("a prism of any size and number of sides comes to rest on a facet") {
  for (const double radius : {0.01, 0.04, 1.0}) {
    for (const std::uint32_t sides : {8u, 24u, 60u}) {
      CAPTURE(radius);
      CAPTURE(sides);
      World world = World::create().value();
      REQUIRE(world.add_body({.shape = hooke::Shape::half_space()}).has_value());
      const auto mesh = world.add_mesh(make_round_prism(sides, radius)).value();
      // Turned about its axis by a third of a facet, so that it begins on an edge.
      const BodyId prism = world
                               .add_body({.kind = hooke::BodyKind::kDynamic,
                                          .shape = hooke::Shape::of_mesh(mesh),
                                          .position = {0, 1.2 * radius, 0},
                                          .rotation = hooke::quaternion_about(
                                              Vec3{0, 0, 1}, Real(2 * hooke::test::kPi / (3.0 * sides)))})
                               .value();
      double deepest = 0;
      // Facets that are nearly in one plane lose little at each impact: a minute for the largest.
      for (int i = 0; i < 3600 && !world.asleep(prism); ++i) {
        world.step(Real(1) / 60);
        if (i > 60) deepest = std::max(deepest, double(world.measure().largest_penetration));
      }
      CHECK(world.asleep(prism));
      CHECK(deepest < 2e-4);
      CHECK(world.center_of_mass(prism).y ==
            Approx(radius * std::cos(hooke::test::kPi / sides)).epsilon(1e-4 + 2e-5 / radius));
    }
  }
}

TEST_CASE("a pendulum settles below its hinge, and what never rests says what moves") {
  World world = World::create().value();
  const BodyId bob = world
                         .add_body({.kind = hooke::BodyKind::kDynamic,
                                    .shape = hooke::Shape::sphere(Real(0.1)),
                                    .position = {1, 0, 0}})
                         .value();
  hooke::HookDesc hook;
  hook.b.body = bob;
  REQUIRE(world.add_hook(hook).has_value());
  CHECK(settled(world).converged());
  CHECK(length(world.center_of_mass(bob) - DVec3{0, -1, 0}) < 1e-3);
  REQUIRE(world
              .add_body({.kind = hooke::BodyKind::kDynamic,
                         .shape = hooke::Shape::sphere(Real(0.1)),
                         .position = {5, 0, 0}})
              .has_value());
  const SettleReport falls = settled(world, {.seconds = 2});
  CHECK(falls.end == SettleEnd::kOutOfTime);
  CHECK(falls.unrest.body != bob);
  CHECK(falls.residual > 0.1);
}

TEST_CASE("what breaks on the way to rest ends it") {
  World world = World::create().value();
  const BodyId bob = world
                         .add_body({.kind = hooke::BodyKind::kDynamic,
                                    .shape = hooke::Shape::sphere(Real(0.1)),
                                    .position = {1, 0, 0},
                                    .mass = Real(10)})
                         .value();
  hooke::HookDesc hook;
  hook.b.body = bob;
  hook.break_force = Real(50);
  REQUIRE(world.add_hook(hook).has_value());
  CHECK(settled(world).end == SettleEnd::kBroke);
  CHECK(world.events().breaks.size() == 1);
}

TEST_CASE("fields out of range are refused, and a world without weight needs a force") {
  World world = World::create({.gravity = {}}).value();
  CHECK(world.settle().error().where == "settle.force");
  CHECK(world.settle({.dt = Real(0)}).error().where == "settle.dt");
  CHECK(world.settle({.residual = std::numeric_limits<double>::quiet_NaN()}).error().where ==
        "settle.residual");
  CHECK(world.settle({.seconds = -1}).error().where == "settle.seconds");
  CHECK(world.settle({.force = 1}).has_value());
}

TEST_SUITE_END();
