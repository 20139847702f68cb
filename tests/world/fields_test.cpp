#include "world/make.h"

#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <numbers>
#include <string>

using namespace hooke;
using namespace hooke::test;

namespace {

BodyDesc ball(DVec3 position, double radius = 0.5) {
  return {
      .kind = BodyKind::kDynamic, .shape = Shape::sphere(static_cast<Real>(radius)), .position = position};
}

FieldDesc uniform(Vec3 acceleration) {
  return {.kind = FieldDesc::Kind::kUniform, .vector = acceleration};
}

}  // namespace

TEST_SUITE("world/fields") {
  TEST_CASE("a uniform field moves a body as it moves a particle, whatever gravity does to it") {
    World world = make_world(empty_space());
    take(world.add_field(uniform({Real(2), 0, 0})));
    BodyDesc desc = ball({0, 5, 0});
    desc.gravity_scale = 0;
    const BodyId body = take(world.add_body(desc));
    const ParticlesId particle = take(world.add_particles({.particles = {ParticleDesc{}}}));
    const double energy = world.measure().energy.total();
    run(world, 60);
    CHECK(world.velocity(body).x == doctest::Approx(2.0).epsilon(1e-5));
    CHECK(world.center_of_mass(body).x == doctest::Approx(world.positions(particle)[0].x).epsilon(1e-5));
    CHECK(std::abs(world.velocity(body).y) < Real(1e-6));
    CHECK(std::abs(world.measure().energy.total() - energy) < 0.01 * world.measure().energy.kinetic);
  }

  TEST_CASE("a body comes round a center of attraction after 2 pi sqrt(a^3 / GM), whatever its mass") {
    World world = make_world(empty_space());
    take(world.add_field({.kind = FieldDesc::Kind::kInverseSquare, .strength = 4.0}));
    BodyDesc desc = ball({2, 0, 0});
    desc.velocity = {0, Real(std::sqrt(2.0)), 0};
    desc.density = Real(5);
    const BodyId body = take(world.add_body(desc));
    const double period = 2 * std::numbers::pi * std::sqrt(8.0 / 4.0);
    const int steps = static_cast<int>(std::lround(period * 120));
    run(world, steps, static_cast<Real>(period / steps));
    CHECK(world.center_of_mass(body).x == doctest::Approx(2.0).epsilon(1e-3));
    CHECK(std::abs(world.center_of_mass(body).y) < 3e-2);
  }

  TEST_CASE("bodies that stand still or are moved by hand feel no field") {
    World world = make_world(empty_space());
    take(world.add_field(uniform({Real(2), 0, 0})));
    BodyDesc desc = ball({});
    desc.kind = BodyKind::kStatic;
    const BodyId still = take(world.add_body(desc));
    desc.kind = BodyKind::kKinematic;
    desc.position = {0, 5, 0};
    const BodyId moved = take(world.add_body(desc));
    run(world, 10);
    CHECK(world.center_of_mass(still) == DVec3{});
    CHECK(world.center_of_mass(moved) == DVec3{0, 5, 0});
  }

  TEST_CASE("a sleeper wakes when a field comes, and when it goes") {
    World world = make_world(without_air());
    take(world.add_body({.shape = Shape::half_space()}));
    const BodyId body = take(world.add_body(ball({0, 0.5, 0})));
    run(world, 120);
    REQUIRE(world.asleep(body));
    const FieldId lift = take(world.add_field(uniform({0, Real(9.81), 0})));
    CHECK_FALSE(world.asleep(body));
    run(world, 120);
    REQUIRE(world.asleep(body));
    REQUIRE(world.remove(lift));
    CHECK_FALSE(world.asleep(body));
    take(world.add_field(uniform({0, Real(12.81), 0})));
    run(world, 60);
    CHECK(world.velocity(body).y == doctest::Approx(3.0).epsilon(1e-3));
  }

  TEST_CASE("a box floats as deep as its density says and heaves with T = 2 pi sqrt(m / (rho g A))") {
    WorldDesc desc = without_air();
    desc.sleeping = false;
    World world = make_world(desc);
    take(world.add_field({.kind = FieldDesc::Kind::kLiquid, .height = 3.0, .density = 1000}));
    BodyDesc box = {.kind = BodyKind::kDynamic,
                    .shape = Shape::box({Real(0.5), Real(0.25), Real(0.4)}),
                    .position = {7, 3 + 0.25 - 0.6 * 0.5 - 0.05, 2},
                    .density = Real(600)};
    const BodyId id = take(world.add_body(box));
    const double rest = 3 + 0.25 - 0.6 * 0.5;
    const double period = 2 * std::numbers::pi * std::sqrt(0.6 * 0.5 / 9.81);
    const int steps = 2000;
    const Real dt = static_cast<Real>(2 * period / steps);
    run(world, steps / 4, dt);
    CHECK(world.center_of_mass(id).y - rest == doctest::Approx(0.05).epsilon(0.01));
    run(world, steps / 8, dt);
    CHECK(std::abs(world.center_of_mass(id).y - rest) < 1e-3);
    run(world, steps / 8, dt);
    CHECK(world.center_of_mass(id).y - rest == doctest::Approx(-0.05).epsilon(0.01));
    CHECK(length(world.angular_velocity(id)) < Real(1e-4));
  }

  TEST_CASE("a tilted plank rights itself, drag brings it to rest, and a stone sinks at g (1 - 1 / s)") {
    World world = make_world(without_air());
    take(world.add_field({.kind = FieldDesc::Kind::kLiquid, .density = 1000, .drag = 2}));
    const BodyId plank = take(world.add_body({.kind = BodyKind::kDynamic,
                                              .shape = Shape::box({Real(1), Real(0.1), Real(1)}),
                                              .rotation = quaternion_about(Vec3{0, 0, Real(1)}, Real(0.4)),
                                              .density = Real(500)}));
    run(world, 900);
    CHECK(world.center_of_mass(plank).y == doctest::Approx(0.0).epsilon(1e-3));
    CHECK(rotate(world.pose(plank).rotation, Vec3{0, Real(1), 0}).y > Real(0.9999));

    World clear = make_world(without_air());
    take(clear.add_field({.kind = FieldDesc::Kind::kLiquid, .height = 1e3, .density = 1000}));
    BodyDesc stone = ball({});
    stone.density = Real(2500);
    const BodyId sinks = take(clear.add_body(stone));
    const ParticlesId bubble = take(
        clear.add_particles({.particles = {{.position = {5, 0, 0}, .mass = Real(2), .radius = Real(0.1)}}}));
    run(clear, 60);
    CHECK(clear.velocity(sinks).y == doctest::Approx(-9.81 * (1 - 1 / 2.5)).epsilon(1e-4));
    const double displaced = 1000 * 4.0 / 3 * std::numbers::pi * 1e-3;
    CHECK(clear.velocities(bubble)[0].y == doctest::Approx(9.81 * (displaced / 2 - 1)).epsilon(1e-4));
  }

  TEST_CASE("in a current everything ends up drifting with it, however strong the drag") {
    for (const double drag : {3.0, 1e6}) {
      World world = make_world(empty_space());
      take(world.add_field(
          {.kind = FieldDesc::Kind::kLiquid, .vector = {Real(1.5), 0, 0}, .height = 100, .drag = drag}));
      BodyDesc desc = ball({});
      desc.angular_velocity = {0, Real(4), 0};
      const BodyId body = take(world.add_body(desc));
      const ParticlesId particle =
          take(world.add_particles({.particles = {{.position = {9, 0, 0}, .radius = Real(0.1)}}}));
      run(world, 300);
      CHECK(world.velocity(body).x == doctest::Approx(1.5).epsilon(1e-4));
      CHECK(length(world.angular_velocity(body)) < Real(1e-4));
      CHECK(world.velocities(particle)[0].x == doctest::Approx(1.5).epsilon(1e-2));
    }
  }

  TEST_CASE("suction pulls by (1 - r / reach)^n up to its reach, and nothing at its center") {
    World world = make_world(empty_space());
    take(world.add_field(
        {.kind = FieldDesc::Kind::kSuction, .center = {0, 1, 0}, .strength = 8, .reach = 4, .falloff = 2}));
    const BodyId near = take(world.add_body(ball({0, 1, 2})));
    const BodyId far = take(world.add_body(ball({0, 6, 0})));
    const BodyId inside = take(world.add_body(ball({0, 1, 0})));
    const ParticlesId dust = take(world.add_particles({.particles = {{.position = {1, 1, 0}}}}));
    run(world, 1, Real(1e-3));
    CHECK(world.velocity(near).z == doctest::Approx(-8e-3 * 0.25).epsilon(1e-4));
    CHECK(world.velocity(far) == Vec3{});
    CHECK(world.velocity(inside) == Vec3{});
    CHECK(world.velocities(dust)[0].x == doctest::Approx(-8e-3 * 0.5625).epsilon(1e-4));
  }

  TEST_CASE("a vortex turns counter-clockwise about its axis") {
    World world = make_world(empty_space());
    take(world.add_field({.kind = FieldDesc::Kind::kVortex,
                          .vector = {0, Real(3), 0},
                          .center = {1, 0, 0},
                          .strength = 6,
                          .reach = 4}));
    const BodyId body = take(world.add_body(ball({3, 7, 0})));
    run(world, 1, Real(1e-3));
    const Vec3 v = world.velocity(body);
    CHECK(v.z == doctest::Approx(-6e-3 * 0.5).epsilon(1e-4));
    CHECK(std::abs(v.x) < Real(1e-6));
    CHECK(v.y == Real(0));
  }

  TEST_CASE("an explosion pushes once, at its time, and wakes what sleeps within its reach") {
    World world = make_world(without_air());
    take(world.add_body({.shape = Shape::half_space()}));
    BodyDesc smooth = ball({2, 0.5, 0});
    smooth.contact.friction = 0;
    const BodyId near = take(world.add_body(smooth));
    const BodyId far = take(world.add_body(ball({20, 0.5, 0})));
    take(world.add_field({.kind = FieldDesc::Kind::kExplosion,
                          .center = {0, 0.5, 0},
                          .strength = 10,
                          .reach = 4,
                          .time = 2.01}));
    const ParticlesId dust = take(world.add_particles({.particles = {{.position = {0, 1e3, 0}}}}));
    run(world, 120);
    REQUIRE(world.asleep(near));
    CHECK(length(world.velocities(dust)[0]) > 19);
    run(world, 1);
    CHECK(world.velocity(near).x == doctest::Approx(5.0).epsilon(0.01));
    CHECK(world.asleep(far));
    run(world, 1);
    CHECK(world.velocity(near).x < Real(5.001));
  }

  TEST_CASE("an explosion falls into exactly one step, whatever the step") {
    for (const double dt : {1 / 60.0, 0.1, 1 / 3.0, 0.0123}) {
      World world = make_world(empty_space());
      for (const double time : {0.0, 0.5, 0.3, 1.0}) {
        take(world.add_field(
            {.kind = FieldDesc::Kind::kExplosion, .strength = 1, .reach = 1e6, .falloff = 0, .time = time}));
      }
      const BodyId body = take(world.add_body(ball({2, 0, 0})));
      run(world, static_cast<int>(2 / dt), static_cast<Real>(dt));
      CHECK(world.velocity(body).x == doctest::Approx(4.0).epsilon(1e-5));
    }
  }

  TEST_CASE("a falling ball in air goes v_t tanh(g t / v_t), and drifts with the wind") {
    WorldDesc desc;
    desc.sleeping = false;
    World world = make_world(desc);
    BodyDesc body = ball({}, 0.1);
    body.mass = Real(0.05);
    body.drag_coefficient = Real(0.47);
    const BodyId id = take(world.add_body(body));
    const double area = std::numbers::pi * 0.01;
    const double terminal = std::sqrt(2 * 0.05 * 9.81 / (1.225 * 0.47 * area));
    run(world, 60);
    CHECK(-world.velocity(id).y == doctest::Approx(terminal * std::tanh(9.81 / terminal)).epsilon(1e-3));
    run(world, 600);
    CHECK(-world.velocity(id).y == doctest::Approx(terminal).epsilon(1e-4));

    desc.gravity = {};
    desc.wind.velocity = {Real(20), 0, 0};
    World windy = make_world(desc);
    const BodyId drifting = take(windy.add_body(body));
    run(windy, 3000);
    CHECK(windy.velocity(drifting).x == doctest::Approx(20).epsilon(0.02));
  }

  TEST_CASE("backspin lifts a ball by C rho V omega v and leaves its speed") {
    WorldDesc desc;
    desc.gravity = {};
    World world = make_world(desc);
    BodyDesc body = ball({}, 0.1);
    body.mass = Real(0.05);
    body.magnus_coefficient = Real(0.75);
    body.velocity = {Real(10), 0, 0};
    body.angular_velocity = {0, 0, Real(30)};  // its top runs backward
    const BodyId id = take(world.add_body(body));
    // Across its spin the velocity turns at C rho V omega / m.
    const double rate = 0.75 * 1.225 * 4.0 / 3 * std::numbers::pi * 1e-3 * 30 / 0.05;
    run(world, 30);
    CHECK(world.velocity(id).y == doctest::Approx(10 * std::sin(0.5 * rate)).epsilon(1e-3));
    CHECK(length(world.velocity(id)) == doctest::Approx(10.0).epsilon(1e-5));
  }

  TEST_CASE("a field that is not finite or out of range is an error that names the key") {
    World world = make_world();
    const double nan = std::nan("");
    const auto where = [&](const FieldDesc& desc) {
      const Result<FieldId> made = world.add_field(desc);
      return made ? std::string("made") : made.error().where;
    };
    using Kind = FieldDesc::Kind;
    CHECK(where({.kind = Kind::kSuction, .strength = nan}) == "field.strength");
    CHECK(where({.kind = Kind::kSuction, .reach = 0}) == "field.reach");
    CHECK(where({.kind = Kind::kSuction, .reach = nan}) == "field.reach");
    CHECK(where({.kind = Kind::kSuction, .falloff = 9}) == "field.falloff");
    CHECK(where({.kind = Kind::kVortex}) == "field.vector");
    CHECK(where({.kind = Kind::kLiquid, .height = nan}) == "field.height");
    CHECK(where({.kind = Kind::kLiquid, .density = -1}) == "field.density");
    CHECK(where({.kind = Kind::kLiquid, .drag = nan}) == "field.drag");
    CHECK(where({.kind = Kind::kExplosion, .time = nan}) == "field.time");
    BodyDesc body = ball({});
    body.drag_coefficient = Real(-1);
    CHECK(world.add_body(body).error().where == "body.drag_coefficient");
    body.drag_coefficient = Real(0);
    body.magnus_coefficient = static_cast<Real>(nan);
    CHECK(world.add_body(body).error().where == "body.magnus_coefficient");
  }

  TEST_CASE("floating bodies end in the same bits for any number of workers") {
    std::uint64_t hash = 0;
    for (const int workers : {1, 3}) {
      WorldDesc desc;
      desc.workers = workers;
      World world = make_world(desc);
      take(world.add_field({.kind = FieldDesc::Kind::kLiquid, .drag = 1}));
      take(world.add_field(
          {.kind = FieldDesc::Kind::kVortex, .vector = {0, 1, 0}, .strength = 3, .reach = 20}));
      for (int i = 0; i < 200; ++i) {
        BodyDesc body = ball({1.5 * (i % 20) - 15, 1.5, 1.5 * (i / 20) - 7}, 0.4);
        if (i % 3 == 1) body.shape = Shape::box({Real(0.4), Real(0.3), Real(0.5)});
        if (i % 3 == 2) body.shape = Shape::capsule(Real(0.2), Real(0.3));
        body.drag_coefficient = Real(1);
        body.density = Real(300 + 5 * i);
        take(world.add_body(body));
      }
      run(world, 60);
      if (workers == 1) hash = world.state_hash();
      CHECK(world.state_hash() == hash);
    }
  }
}
