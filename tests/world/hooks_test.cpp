#include "hooke/hooke.h"
#include "hooke/placement.h"

#include "constants.h"
#include "world/make.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace hooke {
using namespace test;

namespace {

void run_for(World& world, double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(60 * seconds)); ++i) world.step(Real(1) / Real(60));
}

BodyId add_ball(World& world, DVec3 position, Real radius = Real(0.2)) {
  return world
      .add_body({.kind = BodyKind::kDynamic,
                 .shape = {.kind = ShapeKind::kSphere, .radius = radius},
                 .position = position,
                 .mass = Real(2)})
      .value();
}

void add_ground(World& world) {
  (void)world.add_body({.shape = {.kind = ShapeKind::kHalfSpace}}).value();
}

TEST_SUITE("world/hooks") {
  TEST_CASE("a weight hangs on its hook, which reports the force") {
    World world = World::create().value();
    const BodyId ball = add_ball(world, {0, 1, 0});
    const HookId hook = world.add_hook({.b = {ball}, .anchor = {0, 2, 0}}).value();
    run_for(world, 1);
    CHECK(world.center_of_mass(ball).y == doctest::Approx(1).epsilon(1e-5));
    CHECK(d(world.hook_force(hook).force.y) == doctest::Approx(2 * kGravity).epsilon(1e-4));
  }

  TEST_CASE("hinges of planks between two walls have no forces along their axes, however the row is turned") {
    // The last hinge says again what the others have said of all directions but along the row. Errors of 1e-8
    // m in where anchors are gave forces along the axes of a tenth of the weight.
    for (const std::uint32_t seed : {1U, 2U, 5U, 7U}) {
      CAPTURE(seed);
      WorldDesc desc = {.sleeping = false};
      const Placement at = random_placement(seed, desc.gravity);
      World world = World::create(placed(desc, at)).value();
      // On a parabola, which is near to how they hang.
      constexpr int kCount = 12;
      const auto joint = [](int i) {
        const double x = i - kCount / 2.0;
        return DVec3{0.6 * x, 0.05 * x * x, 0};
      };
      HookEnd before = {};
      HookId first;
      for (int i = 0; i <= kCount; ++i) {
        HookEnd next = {};
        if (i < kCount) {
          const DVec3 along = joint(i + 1) - joint(i);
          BodyDesc plank{.kind = BodyKind::kDynamic,
                         .shape = Shape::box({static_cast<Real>(0.5 * length(along)), Real(0.03), Real(0.6)}),
                         .position = 0.5 * (joint(i) + joint(i + 1)),
                         .rotation = quaternion_about(Vec3{0, 0, Real(1)},
                                                      static_cast<Real>(std::atan2(along.y, along.x))),
                         .mass = Real(15)};
          plank.linear_damping = Real(2);
          next.body = world.add_body(placed(plank, at)).value();
        }
        const HookDesc hinge = {
            .kind = HookKind::kHinge, .a = before, .b = next, .anchor = joint(i), .axis = {0, 0, Real(1)}};
        const HookId hook = world.add_hook(placed(hinge, at)).value();
        if (i == 0) first = hook;
        before = next;
      }
      for (int i = 0; i < 300; ++i) world.step(Real(1) / Real(60));
      const DVec3 force = at.own_direction(vector_cast<double>(world.hook_force(first).force));
      CHECK(std::abs(force.y) == doctest::Approx(kCount / 2.0 * 15 * kGravity).epsilon(0.01));
      CHECK(std::abs(force.z) < 0.05 * std::abs(force.y));
    }
  }

  TEST_CASE("two hinges share the weight of a door, however they are turned") {
    // The second hinge says again what the first has said, but for rounding, which made forces of 18 kN.
    for (const bool with_rope : {false, true}) {
      for (const std::uint32_t seed : {1U, 2U, 5U, 7U}) {
        CAPTURE(with_rope);
        CAPTURE(seed);
        WorldDesc desc = without_air();
        const Placement at = random_placement(seed, desc.gravity);
        World world = World::create(placed(desc, at)).value();
        const BodyId door =
            take(world.add_body(placed(BodyDesc{.kind = BodyKind::kDynamic,
                                                .shape = Shape::box({Real(0.4), Real(0.95), Real(0.02)}),
                                                .position = {0.4, 0, 0},
                                                .velocity = {0, 0, Real(-1.2)},
                                                .angular_velocity = {0, 3, 0},
                                                .mass = 20},
                                       at)));
        std::array<HookId, 2> hinges;
        for (std::size_t i = 0; i < hinges.size(); ++i) {
          hinges[i] = take(world.add_hook(placed(HookDesc{.kind = HookKind::kHinge,
                                                          .b = {.body = door},
                                                          .anchor = {0, i == 0 ? 0.8 : -0.8, 0},
                                                          .axis = {0, 1, 0}},
                                                 at)));
        }
        if (with_rope) {
          RopeDesc rope{
              .hook_point = {0.8, 0, 0}, .direction = {0, -1, 0}, .total_mass = Real(0.05), .masses = 6};
          rope.pins.clear();
          const RopeId id = take(world.add_rope(placed(rope, at)));
          take(world.add_hook(placed(
              HookDesc{.a = {.point = point(id, 0)}, .b = {.body = door}, .anchor = {0.8, 0, 0}}, at)));
        }
        for (int i = 0; i < 60; ++i) {
          world.step(Real(1) / Real(60));
          double up = 0;
          for (const HookId hinge : hinges) {
            const DVec3 force = at.own_direction(vector_cast<double>(world.hook_force(hinge).force));
            up += force.y;
            CHECK(length(force) < 2 * 20 * kGravity);
          }
          CHECK(up == doctest::Approx(20 * kGravity).epsilon(0.02));
        }
      }
    }
  }

  TEST_CASE("a blade on the hinge of a free motor comes to any speed, and does not wobble") {
    // A blade has a hundred times less inertia along than across: what rows know of it is wrong after 6
    // degrees.
    for (const int substeps : {4, 8}) {
      for (const double speed : {100.0, 200.0, 400.0, 1000.0}) {
        World world = World::create({.gravity = {}, .substeps = substeps}).value();
        const auto add_box = [&](double y, Vec3 half, double mass) {
          return world
              .add_body({.kind = BodyKind::kDynamic,
                         .shape = Shape::box(half),
                         .position = {0, y, 0},
                         .mass = static_cast<Real>(mass)})
              .value();
        };
        const BodyId motor = add_box(0, {Real(0.2), Real(0.2), Real(0.2)}, 5);
        const BodyId blade = add_box(0.4, {Real(0.5), Real(0.01), Real(0.05)}, 0.5);
        const HookId hinge =
            world
                .add_hook({.kind = HookKind::kHinge,
                           .a = {motor},
                           .b = {blade},
                           .anchor = {0, 0.4, 0},
                           .axis = {Real(0), Real(1), Real(0)},
                           .motor = {.speed = static_cast<Real>(speed), .max_force = Real(50)}})
                .value();
        run_for(world, 10);
        INFO(substeps << " substeps, " << speed << " rad/s");
        const Vec3 of_blade = world.angular_velocity(blade);
        const Vec3 of_motor = world.angular_velocity(motor);
        CHECK(d(of_blade.y - of_motor.y) == doctest::Approx(speed).epsilon(1e-3));
        // I = m (a^2 + b^2) / 12 about y; neither had any angular momentum.
        const double i_blade = 0.5 * (1.0 + 0.01) / 12;
        const double i_motor = 5 * (0.16 + 0.16) / 12;
        CHECK(i_blade * d(of_blade.y) == doctest::Approx(-i_motor * d(of_motor.y)).epsilon(1e-3));
        CHECK(std::hypot(d(of_blade.x), d(of_blade.z)) < 0.01 * speed);
        CHECK(d(world.hook_gap(hinge)) < 1e-3);
      }
    }
  }

  TEST_CASE("a hook that breaks is listed once and is gone") {
    World world = World::create().value();
    const BodyId ball = add_ball(world, {0, 1, 0});
    const HookId kept = world.add_hook({.b = {add_ball(world, {5, 1, 0})}, .anchor = {5, 2, 0}}).value();
    const HookId hook = world.add_hook({.b = {ball}, .anchor = {0, 2, 0}, .break_force = Real(19)}).value();
    world.step(Real(1) / Real(60));
    REQUIRE(world.broken_hooks() == std::vector<HookId>{hook});
    CHECK_FALSE(world.remove(hook));
    CHECK(world.set_motor(hook, {}).error().code == ErrorCode::kStaleId);
    run_for(world, 0.5);
    CHECK(world.broken_hooks().empty());
    CHECK(world.center_of_mass(ball).y < 0);
    CHECK(world.remove(kept));
  }

  TEST_CASE("a spring that is set acts as one that was there from the start") {
    // A rod of 1 m becomes a spring: m g / k = 0.0981 m longer at rest, from 1 m or from where it is set to.
    const auto hanging_at = [](const HookSpring& spring, const HookLimits& limits) {
      World world = World::create({.sleeping = false}).value();
      const BodyId ball = add_ball(world, {0, -1, 0});
      const HookId hook =
          world
              .add_hook(
                  {.kind = HookKind::kDistance, .b = {ball}, .anchor_b = DVec3{0, -1, 0}, .limits = limits})
              .value();
      REQUIRE(world.set_spring(hook, spring));
      run_for(world, 5);
      CHECK(d(world.hook_value(hook)) == doctest::Approx(-world.center_of_mass(ball).y).epsilon(1e-5));
      CHECK(d(world.hook_gap(hook)) < 1e-5);
      return world.center_of_mass(ball).y;
    };
    const HookSpring spring = {.stiffness = Real(200), .damping = Real(20)};
    HookSpring longer = spring;
    longer.target = Real(0.5);
    CHECK(hanging_at(spring, {}) == doctest::Approx(-1 - 2 * kGravity / 200).epsilon(1e-4));
    CHECK(hanging_at(longer, {}) == doctest::Approx(-1.5 - 2 * kGravity / 200).epsilon(1e-4));
    CHECK(hanging_at(spring, {.upper = Real(1.05)}) == doctest::Approx(-1.05).epsilon(1e-3));
    CHECK(hanging_at(longer, {.lower = Real(1), .upper = Real(1)}) == doctest::Approx(-1).epsilon(1e-4));
    // Nothing said, nothing but the rod is left.
    CHECK(hanging_at({}, {}) == doctest::Approx(-1).epsilon(1e-4));
  }

  TEST_CASE("the gap of a hook is the distance of its ends from where it holds them") {
    World world = World::create().value();
    const BodyId ball = add_ball(world, {1, 0, 0});
    const HookId rope = world
                            .add_hook({.kind = HookKind::kDistance,
                                       .b = {ball},
                                       .anchor_b = DVec3{1, 0, 0},
                                       .limits = {.upper = Real(2)}})
                            .value();
    const HookId slider =
        world.add_hook({.kind = HookKind::kSlider, .b = {ball}, .axis = {Real(1), Real(0), Real(0)}}).value();
    CHECK(d(world.hook_gap(rope)) == doctest::Approx(0));
    REQUIRE(world.set_pose(ball, {.position = {3, 0.5, 0}}));
    CHECK(world.hook_anchors(rope)[1] == DVec3{3, 0.5, 0});
    CHECK(d(world.hook_gap(rope)) == doctest::Approx(std::sqrt(9.25) - 2));
    CHECK(d(world.hook_gap(slider)) == doctest::Approx(0.5));
    CHECK(world.measure().largest_gap == doctest::Approx(std::sqrt(9.25) - 2));
  }

  TEST_CASE("a driven wheel rolls with v = omega r") {
    World world = World::create().value();
    add_ground(world);
    const BodyId car =
        world
            .add_body({.kind = BodyKind::kDynamic,
                       .shape = {.kind = ShapeKind::kBox, .half_extents = {1, Real(0.1), Real(0.5)}},
                       .position = {0, 0.6, 0},
                       .mass = Real(20)})
            .value();
    for (const double x : {-0.8, 0.8}) {
      for (const double z : {-0.8, 0.8}) {
        const BodyId wheel = add_ball(world, {x, 0.3, z}, Real(0.3));
        (void)world
            .add_hook({.kind = HookKind::kWheel,
                       .a = {car},
                       .b = {wheel},
                       .anchor = {x, 0.3, z},
                       .second_axis = Vec3{Real(0), Real(0), Real(1)},
                       .limits = {.lower = Real(-0.1), .upper = Real(0.1)},
                       .spring = {.stiffness = Real(2000), .damping = Real(200)},
                       .motor = {.speed = Real(-10), .max_force = Real(5)}})
            .value();
      }
    }
    run_for(world, 5);
    CHECK(d(world.velocity(car).x) == doctest::Approx(10 * 0.3).epsilon(0.02));
    CHECK(std::abs(world.center_of_mass(car).z) < 0.01);
    CHECK(world.center_of_mass(car).y ==
          doctest::Approx(0.6 - 20 * kGravity / 4 / 2000).epsilon(0.02).scale(0));
  }

  TEST_CASE("hooked bodies do not touch each other unless asked to") {
    for (const bool collide : {false, true}) {
      World world = World::create({.gravity = {}}).value();
      const BodyId a = add_ball(world, {0, 0, 0});
      const BodyId b = add_ball(world, {0.3, 0, 0});
      (void)world
          .add_hook({.kind = HookKind::kSlider,
                     .a = {a},
                     .b = {b},
                     .axis = {Real(1), Real(0), Real(0)},
                     .collide = collide})
          .value();
      run_for(world, 1);
      CHECK((length(world.center_of_mass(b) - world.center_of_mass(a)) > 0.35) == collide);
    }
  }

  TEST_CASE("a chain falls asleep as a whole, and wakes as a whole") {
    World world = World::create().value();
    std::vector<BodyId> ball;
    for (int i = 0; i < 4; ++i) {
      ball.push_back(add_ball(world, {0, -1.0 * i, 0}));
      (void)world
          .add_hook({.a = {i == 0 ? BodyId{} : ball[i - 1]}, .b = {ball[i]}, .anchor = {0, 0.5 - i, 0}})
          .value();
    }
    run_for(world, 2);
    for (const BodyId id : ball) CHECK(world.asleep(id));
    REQUIRE(world.apply_impulse(ball[3], {Real(1), Real(0), Real(0)}));
    run_for(world, 0.05);
    for (const BodyId id : ball) CHECK_FALSE(world.asleep(id));
  }

  TEST_CASE("the hooks of a body go with it, and others keep their ids") {
    World world = World::create().value();
    const BodyId a = add_ball(world, {0, 0, 0});
    const BodyId b = add_ball(world, {1, 0, 0});
    const HookId first = world.add_hook({.a = {a}, .b = {b}}).value();
    const HookId second = world.add_hook({.kind = HookKind::kHinge, .b = {b}}).value();
    CHECK(world.remove(a));
    CHECK_FALSE(world.remove(first));
    CHECK(world.set_motor(second, {.speed = Real(1), .max_force = Real(1)}));
    CHECK(world.set_steering(second, Real(0.1)).error().code == ErrorCode::kUnsupported);
    run_for(world, 0.2);
    CHECK(world.remove(second));
  }

  TEST_CASE("bodies that are removed at once take their hooks along, and leave the others as they are") {
    World world = World::create().value();
    std::vector<BodyId> balls;
    std::vector<HookId> hooks;
    for (int i = 0; i < 8; ++i) {
      balls.push_back(add_ball(world, {1.0 * i, 0, 0}));
      hooks.push_back(
          world
              .add_hook({.a = {i == 0 ? BodyId{} : balls[i - 1]}, .b = {balls[i]}, .anchor = {i - 0.5, 0, 0}})
              .value());
    }
    run_for(world, 0.1);
    const std::array<BodyId, 5> gone = {balls[2], balls[5], BodyId{}, balls[2], balls[6]};
    CHECK(world.remove(gone) == 3);
    CHECK(world.remove(gone) == 0);
    run_for(world, 0.5);
    // What was cut off falls freely; what still hangs on the world does not.
    CHECK(d(world.velocity(balls[7]).y) == doctest::Approx(-9.81 * 0.6).epsilon(0.02));
    CHECK(world.pose(balls[7]).position.y < world.pose(balls[0]).position.y - 0.1);
    CHECK(d(world.hook_gap(hooks[0])) < 1e-3);
    CHECK(d(world.hook_gap(hooks[1])) < 1e-3);
    const std::array<bool, 8> stays = {true, true, false, false, true, false, false, false};
    for (std::size_t i = 0; i < hooks.size(); ++i) CHECK(world.remove(hooks[i]) == stays[i]);
  }

  TEST_CASE("a snapshot brings hooks back, and the bits with them") {
    World world = World::create().value();
    const BodyId ball = add_ball(world, {1, 0, 0});
    const HookId hook =
        world.add_hook({.kind = HookKind::kHinge, .b = {ball}, .axis = {Real(0), Real(0), Real(1)}}).value();
    run_for(world, 0.5);
    const Snapshot snapshot = world.snapshot();
    run_for(world, 0.5);
    const std::uint64_t hash = world.state_hash();
    CHECK(world.remove(hook));
    REQUIRE(world.restore(snapshot));
    run_for(world, 0.5);
    CHECK(world.state_hash() == hash);
  }
}

}  // namespace
}  // namespace hooke
