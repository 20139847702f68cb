#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hooke {

using namespace test;

namespace {

WorldDesc awake(int substeps = 8, int particle_substeps = 1) {
  WorldDesc desc = without_air();
  desc.sleeping = false;
  desc.substeps = substeps;
  desc.particle_substeps = particle_substeps;
  return desc;
}

BodyId add_box(World& world, DVec3 position, double mass, Vec3 half = {Real(0.05), Real(0.05), Real(0.05)}) {
  return take(world.add_body({.kind = BodyKind::kDynamic,
                              .shape = Shape::box(half),
                              .position = position,
                              .mass = static_cast<Real>(mass),
                              .collides = false}));
}

/// A drum about z at `center`, of radius 0.1 m; its moment of inertia is m r^2 / 2.
BodyId add_drum(World& world, DVec3 center, double mass, bool collides = false) {
  BodyDesc desc{.kind = BodyKind::kDynamic,
                .shape = {.kind = ShapeKind::kCylinder, .radius = Real(0.1), .half_height = Real(0.05)},
                .position = center,
                .rotation = quaternion_about(Vec3{1, 0, 0}, static_cast<Real>(kPi / 2)),
                .mass = static_cast<Real>(mass),
                .collides = collides};
  desc.contact.friction = Real(0.5);
  return take(world.add_body(desc));
}

HookId add_axle(World& world, BodyId body, DVec3 at, HookMotor motor = {}, HookSpring spring = {},
                HookLimits limits = {}) {
  return take(world.add_hook({.kind = HookKind::kHinge,
                              .b = {.body = body},
                              .anchor = at,
                              .axis = {0, 0, 1},
                              .limits = limits,
                              .spring = spring,
                              .motor = motor}));
}

RopeId add_rope(World& world, const std::vector<DVec3>& points, double mass = 0.02) {
  return take(world.add_rope({.total_mass = static_cast<Real>(mass), .points = points, .pins = {}}));
}

std::vector<DVec3> line(DVec3 from, DVec3 to, int segments) {
  std::vector<DVec3> points;
  for (int i = 0; i <= segments; ++i)
    points.push_back(from + (i / static_cast<double>(segments)) * (to - from));
  return points;
}

HookId tie(World& world, BodyId body, RopeId rope, std::size_t index) {
  return take(
      world.add_hook({.a = {.body = body}, .b = {.point = point(rope, static_cast<std::uint32_t>(index))}}));
}

/// A load that hangs by a rope of 1 m, of twenty segments, on the place `at` of a body.
BodyId hang_load(World& world, BodyId on, DVec3 at, double mass) {
  const DVec3 end = at - DVec3{0, 1, 0};
  const BodyId load = add_box(world, end - DVec3{0, 0.05, 0}, mass);
  const RopeId rope = add_rope(world, line(at, end, 20));
  tie(world, on, rope, 0);
  tie(world, load, rope, 20);
  return load;
}

/// Over a drum of radius r with the rope's middle at `radius`, from its left side down to its right one.
std::vector<DVec3> over_drum(DVec3 center, double radius, double left, double right) {
  std::vector<DVec3> points;
  constexpr double kStep = 0.03;
  const int on_left = static_cast<int>(std::lround(left / kStep));
  const int on_right = static_cast<int>(std::lround(right / kStep));
  for (int i = on_left; i > 0; --i) points.push_back(center + DVec3{-radius, -kStep * i, 0});
  for (int i = 0; i <= 12; ++i) {
    const double angle = kPi * (1 - i / 12.0);
    points.push_back(center + DVec3{radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  for (int i = 1; i <= on_right; ++i) points.push_back(center + DVec3{radius, -kStep * i, 0});
  return points;
}

double value(const World& world, HookId hook) {
  return d(world.hook_value(hook));
}

}  // namespace

TEST_SUITE("world/coupled_articulations") {
  TEST_CASE("a brake holds what hangs on its drum by a rope, however light the drum") {
    for (const auto& [substeps, particle_substeps] :
         {std::pair{4, 1}, std::pair{8, 1}, std::pair{8, 3}, std::pair{32, 1}}) {
      for (const double mass : {0.02, 2.0, 50.0}) {
        World world = make_world(awake(substeps, particle_substeps));
        const BodyId drum = add_drum(world, {}, mass);
        const HookId axle = add_axle(world, drum, {}, {.max_force = Real(1000)});
        const BodyId load = hang_load(world, drum, {-0.1, 0, 0}, 5);
        run(world, 120);
        INFO(substeps, " x ", particle_substeps, " substeps, drum of ", mass, " kg");
        CHECK(std::abs(value(world, axle)) < 1e-6);
        CHECK(d(world.hook_gap(axle)) < 1e-6);
        CHECK(std::abs(world.center_of_mass(load).y + 1.05) < 1e-5);
      }
    }
  }

  TEST_CASE("a brake that is weaker than its load lets it go as the textbook says") {
    // Drum I = m r^2 / 2, load M, brake T: alpha (I + M r^2) = M g r - T while the rope pulls along its
    // tangent.
    World world = make_world(awake());
    const BodyId drum = add_drum(world, {}, 4);
    const double torque = 2;
    const HookId axle = add_axle(world, drum, {}, {.max_force = static_cast<Real>(torque)});
    hang_load(world, drum, {-0.1, 0, 0}, 5);
    run(world, 3);
    const double alpha = (5 * kGravity * 0.1 - torque) / (0.5 * 4 * 0.01 + 5 * 0.01);
    CHECK(d(world.angular_velocity(drum).z) == doctest::Approx(alpha * world.time()).epsilon(5e-3));
    CHECK(d(world.hook_gap(axle)) < 1e-5);
  }

  TEST_CASE("a winch lifts its load at its speed, and no more than its torque can") {
    // The rope runs over the drum to its other side and is hooked there.
    constexpr double kRadius = 0.105;
    const auto lift = [&](double torque, double mass, int steps, HookForce& force) {
      World world = make_world(awake());
      const BodyId drum = add_drum(world, {}, 2, true);
      const HookId axle =
          add_axle(world, drum, {}, {.speed = Real(-0.5), .max_force = static_cast<Real>(torque)});
      const std::vector<DVec3> points = over_drum({}, kRadius, 0.9, 0);
      const BodyId load = add_box(world, points.front() - DVec3{0, 0.05, 0}, mass);
      const RopeId rope = add_rope(world, points, 0.004 * mass);
      tie(world, load, rope, 0);
      tie(world, drum, rope, points.size() - 1);
      run(world, steps);
      const double before = world.center_of_mass(load).y;
      run(world, steps);
      force = world.hook_force(axle);
      CHECK(d(world.hook_gap(axle)) < 1e-5);
      return world.center_of_mass(load).y - before;
    };
    HookForce force;
    for (const double mass : {5.0, 500.0}) {
      INFO("load of ", mass, " kg");
      CHECK(lift(1e4, mass, 60, force) == doctest::Approx(0.5 * kRadius).epsilon(0.01));
      CHECK(std::abs(d(force.torque.z)) == doctest::Approx(mass * kGravity * kRadius).epsilon(0.02));
    }
    // 5 kg ask for 5.15 N m: 6 lift it, 4.5 do not.
    CHECK(lift(6, 5, 60, force) == doctest::Approx(0.5 * kRadius).epsilon(0.01));
    CHECK(lift(4.5, 5, 12, force) < 0);
    CHECK(std::abs(d(force.torque.z)) == doctest::Approx(4.5).epsilon(1e-3));
  }

  TEST_CASE("an elevator's motor needs only what its counterweight leaves") {
    const auto ride = [](double limit, double& force) {
      World world = make_world(awake());
      const BodyId wheel = add_drum(world, {0, 3, 0}, 4, true);
      (void)add_axle(world, wheel, {0, 3, 0});
      const std::vector<DVec3> points = over_drum({0, 3, 0}, 0.105, 1.5, 1.5);
      const RopeId rope = add_rope(world, points, 2);
      const BodyId cabin = add_box(world, points.front() - DVec3{0, 0.05, 0}, 500);
      const BodyId weight = add_box(world, points.back() - DVec3{0, 0.05, 0}, 450);
      tie(world, cabin, rope, 0);
      tie(world, weight, rope, points.size() - 1);
      const HookId shaft =
          take(world.add_hook({.kind = HookKind::kSlider,
                               .b = {.body = cabin},
                               .anchor = world.center_of_mass(cabin),
                               .axis = {0, 1, 0},
                               .motor = {.speed = Real(0.2), .max_force = static_cast<Real>(limit)}}));
      run(world, 30);
      const double before = world.center_of_mass(cabin).y;
      force = 0;
      for (int i = 0; i < 60; ++i) {
        run(world, 1);
        force += std::abs(d(world.hook_force(shaft).force.y)) / 60;
      }
      const double way = world.center_of_mass(cabin).y - before;
      CHECK(world.measure().largest_gap < 1e-4);
      return way;
    };
    double force = 0;
    CHECK(ride(5000, force) == doctest::Approx(0.2).epsilon(1e-3));
    CHECK(force == doctest::Approx(50 * kGravity).epsilon(0.02));
    // 400 N hold less than what is missing: the cabin sinks.
    CHECK(ride(400, force) < -0.05);
    CHECK(force == doctest::Approx(400).epsilon(1e-3));
  }

  TEST_CASE("a spring hinge with a load on a rope bends to the angle of statics") {
    // k theta = g (M L + m L / 2) cos theta, from the horizontal, for an arm of 2 kg and 1 m.
    const double stiffness = 60;
    for (const double mass : {1.0, 10.0, 40.0}) {
      World world = make_world(awake());
      const BodyId arm = add_box(world, {0.5, 0, 0}, 2, {Real(0.5), Real(0.02), Real(0.02)});
      const HookId hinge =
          add_axle(world, arm, {}, {},
                   {.stiffness = static_cast<Real>(stiffness), .damping = static_cast<Real>(10 + mass)});
      hang_load(world, arm, {1, 0, 0}, mass);
      run(world, 1800);
      double mean = 0;
      for (int i = 0; i < 300; ++i) {
        run(world, 1);
        mean += value(world, hinge) / 300;
      }
      double theta = 0.5;
      for (int i = 0; i < 50; ++i) {
        const double moment = kGravity * (mass + 1 + 0.02);
        theta -= (stiffness * theta - moment * std::cos(theta)) / (stiffness + moment * std::sin(theta));
      }
      INFO("load of ", mass, " kg");
      CHECK(mean == doctest::Approx(-theta).epsilon(1e-3));
    }
  }

  TEST_CASE("a limit stops an arm that a load pulls down by a rope") {
    for (const double mass : {5.0, 5000.0}) {
      World world = make_world(awake());
      const BodyId arm = add_box(world, {0.5, 0, 0}, 2, {Real(0.5), Real(0.02), Real(0.02)});
      const HookId hinge = add_axle(world, arm, {}, {}, {}, {.lower = Real(-0.3), .upper = Real(0.3)});
      const BodyId load = hang_load(world, arm, {1, 0, 0}, mass);
      run(world, 1200);
      INFO("load of ", mass, " kg");
      CHECK(value(world, hinge) == doctest::Approx(-0.3).epsilon(1e-4));
      CHECK(world.center_of_mass(load).y == doctest::Approx(-1.05 - std::sin(0.3)).epsilon(0.02));
    }
  }

  TEST_CASE("a braked flap holds the cloth and the particles that lie on it") {
    World world = make_world(awake());
    const BodyId flap = take(world.add_body({.kind = BodyKind::kDynamic,
                                             .shape = Shape::box({Real(0.5), Real(0.02), Real(0.5)}),
                                             .position = {0.5, -0.02, 0},
                                             .mass = Real(1)}));
    const HookId hinge = add_axle(world, flap, {0, -0.02, 0}, {.max_force = Real(1e4)});
    (void)take(world.add_cloth({.columns = 17,
                                .rows = 17,
                                .corner = {0.1, 0.01, -0.4},
                                .row_direction = {0, 0, 1},
                                .width = Real(0.8),
                                .height = Real(0.8),
                                .total_mass = Real(30)}));
    run(world, 180);
    CHECK(std::abs(value(world, hinge)) < 1e-6);
  }

  TEST_CASE("hinged bodies with a rope between them keep momentum and gain no energy in empty space") {
    WorldDesc desc = empty_space();
    desc.sleeping = false;
    World world = make_world(desc);
    std::array<BodyId, 4> arms;
    for (std::size_t i = 0; i < arms.size(); ++i) {
      arms[i] = add_box(world, {0.5 + static_cast<double>(i), 0, 0}, i == 3 ? 20 : 1,
                        {Real(0.5), Real(0.05), Real(0.1)});
      if (i == 0) continue;
      (void)take(world.add_hook({.kind = HookKind::kHinge,
                                 .a = {.body = arms[i - 1]},
                                 .b = {.body = arms[i]},
                                 .anchor = {static_cast<double>(i), 0, 0},
                                 .axis = {0, 0, 1}}));
    }
    const RopeId rope = add_rope(world, line({0, 0, 0}, {0, 2, 0}, 20), 0.5);
    const BodyId ball = add_box(world, {0, 2.05, 0}, 3);
    tie(world, arms[0], rope, 0);
    tie(world, ball, rope, 20);
    REQUIRE(world.set_velocity(ball, {4, 0, 1}).has_value());
    REQUIRE(world.set_velocity(arms[1], {0, 3, 0}).has_value());
    const Measurement start = world.measure();
    double gap = 0;
    for (int i = 0; i < 1200; ++i) {
      run(world, 1);
      gap = std::max(gap, world.measure().largest_gap);
    }
    const Measurement end = world.measure();
    INFO("energy ", start.energy.total(), " J, then ", end.energy.total());
    CHECK(length(end.momentum - start.momentum) < 1e-5 * length(start.momentum));
    CHECK(end.energy.total() < 1.001 * start.energy.total());
    CHECK(gap < 2e-3);
  }

  TEST_CASE("a winch has the same bits for any number of workers and after a restoration") {
    check_same_bits(awake(), [](World& world) {
      const BodyId drum = add_drum(world, {}, 2, true);
      (void)add_axle(world, drum, {}, {.speed = Real(-2), .max_force = Real(20)});
      hang_load(world, drum, {-0.1, 0, 0}, 5);
      hang_load(world, drum, {0.1, 0, 0}, 1);
    });
  }
}

}  // namespace hooke
