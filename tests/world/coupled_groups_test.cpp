#include "constants.h"
#include "world/make.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

BodyId add_box(World& world, DVec3 position, Real mass, Vec3 half = {Real(0.2), Real(0.2), Real(0.2)}) {
  return take(world.add_body({.kind = BodyKind::kDynamic,
                              .shape = {.kind = ShapeKind::kBox, .half_extents = half},
                              .position = position,
                              .mass = mass}));
}

/// A rope of n segments between two places, not held anywhere.
RopeId add_rope(World& world, DVec3 from, DVec3 to, int segments, Real mass, Real stiffness = kRigid) {
  std::vector<DVec3> points;
  for (int i = 0; i <= segments; ++i)
    points.push_back(from + (i / static_cast<double>(segments)) * (to - from));
  return take(world.add_rope({.total_mass = mass, .stiffness = stiffness, .points = points, .pins = {}}));
}

HookId tie(World& world, BodyId body, PointRef point) {
  return take(world.add_hook({.a = {.body = body}, .b = {.point = point}}));
}

}  // namespace

TEST_SUITE("world/coupled_groups") {
  TEST_CASE("a ton does not stretch a kilogram of rope, whose tension is that of statics") {
    World world = make_world(without_air());
    const RopeId rope = take(world.add_rope({.hook_point = {0, 10, 0},
                                             .direction = {0, Real(-1), 0},
                                             .total_mass = 1,
                                             .masses = 51,
                                             .length_at_rest = 5}));
    const BodyId load = add_box(world, {0, 4.5, 0}, 1000, {Real(0.5), Real(0.5), Real(0.5)});
    const HookId hook = tie(world, load, point(rope, 50));
    double worst = 0;
    for (int i = 0; i < 600; ++i) {
      REQUIRE(world.step(Real(1) / Real(60)).healthy());
      worst = std::max(worst, world.measure().largest_stretch);
    }
    CHECK(worst < 1e-4);
    CHECK(std::abs(d(world.hook_force(hook).force.y) + 1000 * kGravity) < 1e-3 * 1000 * kGravity);
    CHECK(std::abs(d(world.tensions(rope).front()) - 1001 * kGravity) < 1e-3 * 1000 * kGravity);
    CHECK(std::abs(world.center_of_mass(load).y - 4.5) < 1e-3);
    CHECK(d(world.hook_gap(hook)) < 1e-4);
  }

  TEST_CASE("ropes that hang on what does not give way pull with their weight and follow where it goes") {
    World world = make_world(without_air());
    const BodyId beam = take(world.add_body({.kind = BodyKind::kKinematic,
                                             .shape = {.kind = ShapeKind::kBox, .half_extents = {1, 1, 1}},
                                             .position = {0, 5, 0}}));
    std::vector<RopeId> ropes;
    std::vector<HookId> hooks;
    for (int k = 0; k < 10; ++k) {
      const DVec3 top = {-0.9 + 0.2 * k, 4, 0};
      ropes.push_back(add_rope(world, top, top - DVec3{0, 1, 0}, 16, static_cast<Real>(1 + k)));
      hooks.push_back(
          k % 2 == 0 ? tie(world, beam, point(ropes.back(), 0))
                     : take(world.add_hook({.a = {.point = point(ropes.back(), 0)}, .b = {.body = beam}})));
    }
    run(world, 120);
    for (int k = 0; k < 10; ++k) {
      // On b, which is the rope's end or the beam.
      const double sign = k % 2 == 0 ? 1 : -1;
      CHECK(d(world.hook_force(hooks[k]).force.y) ==
            doctest::Approx(sign * (1 + k) * kGravity).epsilon(1e-3));
    }
    REQUIRE(world.set_velocity(beam, {Real(0.5), 0, 0}));
    run(world, 60);
    for (int k = 0; k < 10; ++k) {
      CHECK(world.positions(ropes[k])[0].x == doctest::Approx(-0.9 + 0.2 * k + 0.5).epsilon(1e-3));
      CHECK(world.positions(ropes[k])[0].y == doctest::Approx(4).epsilon(1e-4));
    }
  }

  TEST_CASE("a table hangs on four ropes, each with its share") {
    for (const int particle_substeps : {1, 2}) {
      WorldDesc desc = without_air();
      desc.particle_substeps = particle_substeps;
      World world = make_world(desc);
      const BodyId top = add_box(world, {0, 0, 0}, 40, {Real(0.5), Real(0.03), Real(0.5)});
      std::vector<HookId> hooks;
      for (const double x : {-0.5, 0.5}) {
        for (const double z : {-0.5, 0.5}) {
          const RopeId rope = take(
              world.add_rope({.total_mass = Real(1),
                              .axial_stiffness = Real(1e6),
                              .points = {{1.2 * x, 2.03, 1.2 * z}, {1.1 * x, 1.03, 1.1 * z}, {x, 0.03, z}}}));
          hooks.push_back(tie(world, top, point(rope, 2)));
        }
      }
      run(world, 600);
      for (const HookId hook : hooks)
        CHECK(std::abs(d(world.hook_force(hook).force.y) + 10 * kGravity) < 1e-3 * 10 * kGravity);
      CHECK(std::abs(world.center_of_mass(top).y) < 1e-3);
      CHECK(std::abs(d(world.pose(top).rotation.w)) > 1 - 1e-6);
    }
  }

  TEST_CASE("two bodies on a rope in empty space keep momentum and angular momentum") {
    World world = make_world(empty_space());
    const BodyId light = add_box(world, {-1, 0, 0}, 1);
    const BodyId heavy = add_box(world, {1, 0, 0}, 50);
    const RopeId rope = add_rope(world, {-0.8, 0.1, 0}, {0.8, 0, 0.1}, 16, Real(0.1));
    tie(world, light, point(rope, 0));
    tie(world, heavy, point(rope, 16));
    REQUIRE(world.set_velocity(light, {0, 3, 1}).has_value());
    const Measurement before = world.measure();
    run(world, 300);
    const Measurement after = world.measure();
    CHECK(length(after.momentum - before.momentum) < 1e-5 * 3);
    CHECK(length(after.angular_momentum - before.angular_momentum) < 5e-3 * length(before.angular_momentum));
    CHECK(after.largest_stretch < 1e-3);
    CHECK(after.energy.total() < 1.001 * before.energy.total());
    CHECK(after.energy.total() > 0.9 * before.energy.total());
  }

  TEST_CASE("a rope or a cloth hooked to the middles of two bodies is not pushed out of them") {
    for (const bool is_rope : {true, false}) {
      CAPTURE(is_rope);
      World world = make_world(empty_space());
      const BodyId light = add_box(world, {-1, 0, 0}, 1);
      const BodyId heavy = add_box(world, {1, 0, 0}, 3);
      if (is_rope) {
        const RopeId rope = add_rope(world, {-1, 0, 0}, {1, 0, 0}, 20, Real(0.1));
        tie(world, light, point(rope, 0));
        tie(world, heavy, point(rope, 20));
      } else {
        const ClothId cloth = take(world.add_cloth({.columns = 11,
                                                    .rows = 5,
                                                    .corner = {-1, 0, 0},
                                                    .width = Real(2),
                                                    .height = Real(0.4),
                                                    .damping = Real(1)}));
        tie(world, light, point(cloth, 0));
        tie(world, heavy, point(cloth, 10));
      }
      REQUIRE(world.set_velocity(light, {0, 1, 0}).has_value());
      REQUIRE(world.set_velocity(heavy, {0, -1, 0}).has_value());
      const Measurement before = world.measure();
      run(world, 120);
      const Measurement after = world.measure();
      CHECK(length(after.momentum - before.momentum) < 1e-5 * 4);
      CHECK(length(after.angular_momentum - before.angular_momentum) <
            1e-4 * length(before.angular_momentum));
      CHECK(after.energy.kinetic < 1.001 * before.energy.kinetic);
    }
  }

  TEST_CASE("Atwood's machine with a massive pulley accelerates as the textbook says") {
    World world = make_world(without_air());
    const BodyId wheel = take(world.add_body(
        {.kind = BodyKind::kDynamic,
         .shape = {.kind = ShapeKind::kCylinder, .radius = Real(0.25), .half_height = Real(0.1)},
         .position = {0, 5, 0},
         .rotation = quaternion_about(Vec3{1, 0, 0}, Real(std::numbers::pi / 2)),
         .mass = Real(4),
         .contact = {.friction = Real(3)}}));
    (void)take(world.add_hook(
        {.kind = HookKind::kHinge, .b = {.body = wheel}, .anchor = {0, 5, 0}, .axis = {0, 0, 1}}));
    std::vector<DVec3> points;
    const double r = 0.255;
    for (int i = 60; i > 0; --i) points.push_back({-r, 5 - 0.03 * i, 0});
    for (int i = 0; i <= 26; ++i) {
      const double a = std::numbers::pi * (1 - i / 26.0);
      points.push_back({r * std::cos(a), 5 + r * std::sin(a), 0});
    }
    for (int i = 1; i <= 60; ++i) points.push_back({r, 5 - 0.03 * i, 0});
    const RopeId rope = take(world.add_rope(
        {.total_mass = Real(0.002), .points = points, .pins = {}, .contact = {.friction = Real(3)}}));
    const BodyId a = add_box(world, {-r, 3, 0}, 2);
    const BodyId b = add_box(world, {r, 3, 0}, 3);
    tie(world, a, point(rope, 0));
    tie(world, b, point(rope, static_cast<std::uint32_t>(points.size()) - 1));
    run(world, 45);
    const double expected = (3.0 - 2.0) * kGravity / (3.0 + 2.0 + 4.0 / 2.0 * (0.25 * 0.25) / (r * r));
    const double way = 0.5 * (world.center_of_mass(a).y - world.center_of_mass(b).y);
    const double turned = 0.5 * d(world.angular_velocity(wheel).z) * world.time();
    INFO("a = ", 2 * way / (0.75 * 0.75), " of ", expected, ", wheel ", -turned * r, " of ", way);
    CHECK(std::abs(2 * way / (0.75 * 0.75) - expected) < 5e-3 * expected);
    CHECK(std::abs(-turned * r - way) < 0.02 * way);
  }

  TEST_CASE("a bead on a cycloid needs the same time from any start") {
    // x = R (t - sin t), y = -R (1 - cos t): from rest to the bottom in pi sqrt(R/g).
    const double radius = 0.5;
    for (const double start : {0.3, 1.2, 2.2}) {
      World world = make_world(without_air());
      std::vector<DVec3> points;
      std::vector<PinDesc> pins;
      for (int i = 0; i <= 400; ++i) {
        const double t = 2 * std::numbers::pi * i / 400;
        points.push_back({radius * (t - std::sin(t)), -radius * (1 - std::cos(t)), 0});
        pins.push_back({.point = static_cast<std::uint32_t>(i)});
      }
      const RopeId wire = take(world.add_rope({.points = points, .pins = pins}));
      const ParticlesId bead =
          take(world.add_particles({.particles = {{.position = {radius * (start - std::sin(start)),
                                                                -radius * (1 - std::cos(start)), 0},
                                                   .mass = Real(0.1)}}}));
      (void)take(
          world.add_hook({.kind = HookKind::kRopeSlide,
                          .a = {.point = point(wire, PointRef::kNearest)},
                          .b = {.point = point(bead, 0)},
                          .anchor = points[static_cast<std::size_t>(400 * start / (2 * std::numbers::pi))]}));
      const double bottom = std::numbers::pi * radius;
      double before = world.positions(bead)[0].x;
      double time = 0;
      for (int i = 0; i < 200 && time == 0; ++i) {
        REQUIRE(world.step(Real(1) / Real(60)).healthy());
        const double now = world.positions(bead)[0].x;
        if (now >= bottom) time = world.time() - (now - bottom) / (now - before) / 60.0;
        before = now;
      }
      const double expected = std::numbers::pi * std::sqrt(radius / kGravity);
      INFO("from ", start, ": ", time, " of ", expected);
      CHECK(std::abs(time - expected) < 5e-3 * expected);
    }
  }

  TEST_CASE("a body hangs on a corner of a cloth, and on a point inside a triangle") {
    WorldDesc fine = without_air();
    fine.particle_substeps = 8;  // four kilograms on cells of three grams
    World world = make_world(fine);
    ClothDesc desc;
    desc.columns = desc.rows = 9;
    desc.width = desc.height = Real(1);
    desc.damping = Real(2);
    desc.stretch_stiffness = Real(1e4);
    for (std::uint32_t i = 0; i < 9; ++i) desc.pins.push_back({.point = i});
    const ClothId cloth = take(world.add_cloth(desc));
    const BodyId at_point = add_box(world, {1, -1.05, 0}, 2, {Real(0.05), Real(0.05), Real(0.05)});
    const BodyId inside = add_box(world, {0.3, -1.05, 0}, 2, {Real(0.05), Real(0.05), Real(0.05)});
    const HookId corner = tie(world, at_point, point(cloth, 80));
    const HookId middle = take(world.add_hook({.a = {.body = inside},
                                               .b = {.point = point(cloth, PointRef::kNearest)},
                                               .anchor = {0.3, -0.97, 0}}));
    run(world, 600);
    for (const HookId hook : {corner, middle}) {
      CHECK(std::abs(d(world.hook_force(hook).force.y) + 2 * kGravity) < 0.05 * 2 * kGravity);
      CHECK(d(world.hook_gap(hook)) < 1e-3);
    }
    CHECK(world.center_of_mass(at_point).y > -1.2);
  }

  TEST_CASE("a spring between a body and a particle swings as two masses do") {
    World world = make_world(empty_space());
    const BodyId body = add_box(world, {0, 0, 0}, 3);
    const ParticlesId other =
        take(world.add_particles({.particles = {{.position = {1, 0, 0}, .mass = Real(1)}}}));
    (void)take(world.add_hook({.kind = HookKind::kDistance,
                               .a = {.body = body},
                               .b = {.point = point(other, 0)},
                               .spring = {.stiffness = Real(30)}}));
    REQUIRE(world.set_velocity(point(other, 0), {1, 0, 0}).has_value());
    REQUIRE(world.set_velocity(body, {Real(-1) / 3, 0, 0}).has_value());
    const double period = 2 * std::numbers::pi / std::sqrt(30.0 / 0.75);
    std::vector<double> crossings;
    double before = 1;
    while (crossings.size() < 4 && world.time() < 10) {
      world.step(Real(1) / Real(60));
      const double now = world.positions(other)[0].x - world.center_of_mass(body).x;
      if ((now > 1) != (before > 1) && world.time() > 0.1)
        crossings.push_back(world.time() - (now - 1) / (now - before) / 60.0);
      before = now;
    }
    REQUIRE(crossings.size() == 4);
    CHECK(std::abs(crossings[2] - crossings[0] - period) < 0.01 * period);
  }

  TEST_CASE("a hook at a rope holds with a strength 1 % above its load and breaks with one 1 % below it") {
    for (const double share : {1.01, 0.99}) {
      World world = make_world(without_air());
      const RopeId rope = take(world.add_rope(
          {.hook_point = {0, 2, 0}, .direction = {0, Real(-1), 0}, .total_mass = Real(0.1), .masses = 11}));
      const BodyId load = add_box(world, {0, 0.8, 0}, 10);
      const HookId hook = take(world.add_hook({.a = {.body = load},
                                               .b = {.point = point(rope, 10)},
                                               .break_force = static_cast<Real>(share * 10 * kGravity)}));
      bool broke = false;
      for (int i = 0; i < 600; ++i) {
        world.step(Real(1) / Real(60));
        broke = broke || world.broken_hooks() == std::vector<HookId>{hook};
      }
      CHECK(broke == (share < 1));
      CHECK((world.center_of_mass(load).y < 0) == broke);
    }
  }

  TEST_CASE("hooks at ropes are removed with what they hold, and other objects stay whole") {
    World world = make_world(without_air());
    const RopeId gone = add_rope(world, {5, 2, 0}, {5, 1, 0}, 8, 1);
    const RopeId rope =
        take(world.add_rope({.hook_point = {0, 2, 0}, .direction = {0, Real(-1), 0}, .masses = 9}));
    const BodyId a = add_box(world, {0, 0.8, 0}, 3);
    const BodyId b = add_box(world, {5, 0.8, 0}, 3);
    const HookId held = tie(world, a, point(rope, 8));
    const HookId lost = tie(world, b, point(gone, 8));
    run(world, 5);
    CHECK(world.remove(gone));
    CHECK_FALSE(world.remove(lost));
    run(world, 120);
    CHECK(std::abs(world.center_of_mass(a).y - 0.8) < 1e-3);
    CHECK(world.center_of_mass(b).y < -5);
    CHECK(world.remove(a));
    CHECK_FALSE(world.remove(held));
    run(world, 10);
  }

  TEST_CASE("coupled groups have the same bits for any number of workers and after a restore") {
    check_same_bits({}, [](World& world) {
      for (int k = 0; k < 5; ++k) {
        const RopeId rope = take(
            world.add_rope({.hook_point = {2.0 * k, 4, 0}, .direction = {1, Real(-1), 0}, .masses = 20}));
        const BodyId load = add_box(world, world.positions(rope)[19] - DVec3{0, 0.2, 0}, 5);
        tie(world, load, point(rope, 19));
      }
    });
  }

  TEST_CASE("a ball flies into a cloth in empty space: neither passes, and momentum stays") {
    WorldDesc desc = empty_space();
    desc.particle_substeps = 2;
    World world = make_world(desc);
    const ClothId cloth = take(world.add_cloth({.columns = 17,
                                                .rows = 17,
                                                .corner = {-0.5, 0.5, 0},
                                                .areal_density = Real(0.5),
                                                .damping = Real(1)}));
    const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                             .shape = {.kind = ShapeKind::kSphere, .radius = Real(0.1)},
                                             .position = {0.05, 0, 0.6},
                                             .velocity = {0, 0, -3},
                                             .mass = Real(0.5)}));
    const DVec3 before = world.measure().momentum;
    double deepest = 0;
    for (int i = 0; i < 120; ++i) {
      REQUIRE(world.step(Real(1) / Real(60)).healthy());
      deepest = std::max(deepest, world.measure().largest_penetration);
    }
    CHECK(length(world.measure().momentum - before) < 1e-5 * length(before));
    CHECK(deepest < 0.005);
    double front = 0;
    for (std::size_t i = 0; i < 289; ++i) front = std::min(front, world.positions(cloth)[i].z);
    CHECK(front < world.center_of_mass(ball).z - 0.1);
    CHECK(d(world.velocity(ball).z) > -2.5);
  }

  TEST_CASE("a belt carries what lies on it, and a moving wall pushes it") {
    World world = make_world(without_air());
    (void)take(world.add_body({.shape = {.kind = ShapeKind::kHalfSpace},
                               .contact = {.friction = Real(0.5), .surface_velocity = {Real(0.4), 0, 0}}}));
    const ParticlesId grains =
        take(world.add_particles({.particles = {{.position = {0, 0.01, 0}}, {.position = {0, 0.01, 5}}},
                                  .contact = {.friction = Real(0.5)}}));
    run(world, 90);
    CHECK(std::abs(d(world.velocities(grains).offset(0).x) - 0.4) < 1e-3);
    const BodyId wall =
        take(world.add_body({.kind = BodyKind::kKinematic,
                             .shape = {.kind = ShapeKind::kBox, .half_extents = {Real(0.1), 1, 1}},
                             .position = {-1, 1, 5},
                             .velocity = {3, 0, 0}}));
    run(world, 60);
    CHECK(world.positions(grains)[1].x > world.center_of_mass(wall).x + 0.1);
    CHECK(std::abs(d(world.velocities(grains).offset(1).x) - 3) < 0.05);
  }

  TEST_CASE("a rope that falls on a crate asleep wakes it, and slides off with friction") {
    World world = make_world(without_air());
    (void)take(world.add_body({.shape = {.kind = ShapeKind::kHalfSpace}}));
    const BodyId crate = add_box(world, {0, 0.2, 0}, 1);
    run(world, 120);
    REQUIRE(world.asleep(crate));
    const RopeId rope = add_rope(world, {-0.3, 1.5, 0.02}, {0.3, 1.5, 0.02}, 12, 2);
    bool woke = false;
    for (int i = 0; i < 120; ++i) {
      world.step(Real(1) / Real(60));
      woke = woke || !world.asleep(crate);
    }
    CHECK(woke);
    CHECK(world.positions(rope)[6].y > 0.39);
    CHECK(std::abs(world.center_of_mass(crate).y - 0.2) < 0.005);
  }

  TEST_CASE("an impossible hook at a point is an error that says why") {
    World world = make_world();
    const RopeId rope = take(world.add_rope({}));
    const BodyId body = add_box(world, {0, 0, 0}, 1);
    const auto why = [&](const HookDesc& desc) {
      const Result<HookId> hook = world.add_hook(desc);
      REQUIRE_FALSE(hook.has_value());
      return hook.error().where + " " + hook.error().message;
    };
    CHECK(why({.kind = HookKind::kHinge, .a = {.body = body}, .b = {.point = point(rope, 3)}}) ==
          "hook.kind must be ball, slider, distance or rope_slide: a point has no rotation");
    CHECK(why({.a = {.body = body}, .b = {.point = point(rope, 99)}}) ==
          "hook.b names point 99 of 16; the first is 0");
    CHECK(why({.a = {.body = body}, .b = {.body = body, .point = point(rope, 1)}}) ==
          "hook.b names a body and a point: one is meant");
    CHECK(why({.a = {.point = point(rope, 3)}, .b = {.point = point(rope, 3)}}) ==
          "hook.b must be another place than `a`");
    CHECK(why({.kind = HookKind::kRopeSlide, .a = {.body = body}, .b = {.point = point(rope, 3)}}) ==
          "hook.a must be a rope, along which `b` slides");
    CHECK(why({.kind = HookKind::kSlider, .a = {.point = point(rope, 3)}, .b = {.body = body}}) ==
          "hook.a must be a body or the world: a point has no axes to slide along");
  }

  TEST_CASE("a slide whose rope is elsewhere is refused with the distance and the nearest place") {
    World world = make_world(empty_space());
    const RopeId rope = take(world.add_rope({.points = {{-0.5, 0, 0}, {0, 0, 0}, {0.5, 0, 0}}, .pins = {}}));
    const auto at = [&](double height) {
      return world.add_hook({.kind = HookKind::kRopeSlide,
                             .a = {.point = point(rope, PointRef::kNearest)},
                             .anchor = {0.2, height, 0}});
    };
    const Result<HookId> off = at(0.1);
    REQUIRE_FALSE(off.has_value());
    CHECK(off.error().where == "hook.anchor");
    CHECK(off.error().message.find("is 0.100000 m off the rope") != std::string::npos);
    CHECK(off.error().message.find("put it at (0.200000, 0.000000, 0.000000)") != std::string::npos);
    take(at(0.04));  // within a tenth of a segment
    run(world, 30);
    CHECK(world.measure().energy.total() < 0.05);
  }
}

}  // namespace hooke
