/// Rows that one stage lists and a later one uses: of pairs that are put to sleep meanwhile, of bodies that
/// were there before a restore, of hooks whose bodies nothing moves. The asserts of the dev build see what is
/// stale.

#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// Boxes that fall asleep one after the other, and rods that roll and bounce among them.
void add_sleepers_and_rollers(World& world, int seed) {
  take(world.add_body({.shape = Shape::half_space()}));
  for (int i = 0; i < 12; ++i) {
    const int k = (i * 7 + seed * 5) % 12;
    BodyDesc desc = {.kind = BodyKind::kDynamic, .position = {0.9 * k, 0.2 + 0.15 * (k % 5), 0.7 * (k % 3)}};
    if (i % 3 == 0) {
      desc.shape = Shape::capsule(Real(0.1), Real(0.3));
      desc.position.y = 0.1 + 0.2 * (k % 4);
      desc.rotation = quaternion_about(Vec3{Real(1), Real(0), Real(0)}, Real(1.5707963));
      desc.angular_velocity = {Real(0), Real(0), Real(-20 + k)};
      desc.can_sleep = false;
    } else {
      desc.shape = Shape::box({Real(0.2), Real(0.2), Real(0.2)});
      desc.contact.restitution = i % 2 == 0 ? Real(0.4) : Real(0);
    }
    take(world.add_body(desc));
  }
}

/// Two balls that are hooked together stand on a static floor to which a door is hinged.
World world_of_door_and_load(HookKind kind, Real load, bool door_first) {
  World world = make_world();
  const BodyId ground =
      take(world.add_body({.shape = Shape::box({Real(20), Real(0.5), Real(20)}), .position = {0, -0.5, 0}}));
  const auto add_door = [&] {
    const BodyId door = take(world.add_body({.kind = BodyKind::kDynamic,
                                             .shape = Shape::box({Real(0.5), Real(1), Real(0.05)}),
                                             .position = {5.5, 1.2, 0},
                                             .mass = Real(20)}));
    take(world.add_hook(
        {.kind = HookKind::kHinge, .a = {.body = ground}, .b = {.body = door}, .anchor = {5, 1.2, 0}}));
  };
  if (door_first) add_door();
  BodyDesc desc = {.kind = BodyKind::kDynamic,
                   .shape = Shape::box({Real(0.5), Real(0.5), Real(0.5)}),
                   .position = {0, 0.5, 0},
                   .mass = Real(1)};
  const BodyId foot = take(world.add_body(desc));
  desc.position = {0, 1.5, 0};
  desc.mass = load;
  const BodyId top = take(world.add_body(desc));
  take(world.add_hook({.kind = kind, .a = {.body = foot}, .b = {.body = top}, .anchor = {0, 1, 0}}));
  if (!door_first) add_door();
  run(world, 60);
  CHECK(world.pose(top).position.y == doctest::Approx(1.5).epsilon(1e-3));
  return world;
}

/// A slab that leans, and a ball before it that gets there at `speed`. Whether the ball stays before it.
struct Slab {
  Real lean = Real(0.6);
  double dt = 1.0 / 60;
  DVec3 place = {};
};
DVec3 normal_of(const Slab& slab) {
  return {-std::sin(double(slab.lean)), std::cos(double(slab.lean)), 0};
}
BodyId add_slab(World& world, const Slab& slab) {
  return take(world.add_body({.shape = Shape::box({Real(10), Real(0.2), Real(10)}),
                              .position = slab.place,
                              .rotation = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, slab.lean)}));
}
BodyId add_ball(World& world, DVec3 position) {
  return take(world.add_body({.kind = BodyKind::kDynamic,
                              .shape = Shape::sphere(Real(0.2)),
                              .position = position,
                              .can_sleep = false}));
}
void check_held(World& world, BodyId ball, const Slab& slab, double speed, double seconds) {
  const DVec3 n = normal_of(slab);
  REQUIRE(world.set_velocity(ball, vector_cast<Real>(-speed * n)).has_value());
  double lowest = 1e9;
  for (double t = 0; t < seconds; t += slab.dt) {
    world.step(static_cast<Real>(slab.dt));
    lowest = std::min(lowest, dot(world.pose(ball).position - slab.place, n));
  }
  CHECK(lowest > 0.39);
  CHECK(lowest < 0.41);
}

}  // namespace

TEST_SUITE("world/rows") {
  TEST_CASE("pairs that are put to sleep leave the row numbers of refreshed pairs right") {
    for (int seed = 0; seed < 24; ++seed) {
      CAPTURE(seed);
      World world = make_world();
      add_sleepers_and_rollers(world, seed);
      run(world, 150);
    }
  }

  TEST_CASE("a door and a load on the same ground do not mix their hooks") {
    for (const HookKind kind : {HookKind::kFixed, HookKind::kHinge}) {
      for (const double load : {1.0, 10.0, 100.0, 1000.0}) {
        for (const bool door_first : {false, true}) {
          CAPTURE(load);
          world_of_door_and_load(kind, static_cast<Real>(load), door_first);
        }
      }
    }
  }

  TEST_CASE("one body of a sleeping group that presses the ground can be woken") {
    World world = world_of_door_and_load(HookKind::kFixed, Real(100), false);
    run(world, 120);
    const std::vector<BodyContact> contacts = world.body_contacts();
    REQUIRE(!contacts.empty());
    REQUIRE(world.apply_impulse(contacts[0].b, {}).has_value());
    run(world, 60);
  }

  TEST_CASE("bodies that a restore took away can be added and removed again") {
    for (const int count : {1, 5, 300}) {
      World world = make_world();
      const Snapshot before = world.snapshot();
      BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.5))};
      for (int i = 0; i < count; ++i) {
        desc.position.x = 2.0 * i;
        take(world.add_body(desc));
      }
      REQUIRE(world.restore(before).has_value());
      CHECK(world.remove(take(world.add_body(desc))));
      run(world, 2);
    }
  }

  TEST_CASE("a body that is placed in front of a slab, or that comes from far away, does not pass it") {
    for (const double hz : {60.0, 240.0}) {
      for (const double speed : {0.1, 1.0, 1.8, 5.0}) {
        CAPTURE(hz);
        CAPTURE(speed);
        for (const int times : {1, 2, 100}) {
          const Slab slab = {.dt = 1 / hz};
          World world = make_world(empty_space());
          const BodyId wall = add_slab(world, slab);
          const BodyId ball = add_ball(world, {0, 30, 0});
          for (int i = 0; i < times; ++i) {
            REQUIRE(world.set_pose(ball, {2.4 * normal_of(slab), {}}).has_value());
            REQUIRE(world.set_pose(wall, world.pose(wall)).has_value());
          }
          check_held(world, ball, slab, speed, 2.2 / speed);
        }
      }
    }
    const Slab far = {.place = {3e6, 0, 0}};
    World world = make_world(empty_space());
    add_slab(world, far);
    const BodyId ball = add_ball(world, far.place + 2.4 * normal_of(far) - DVec3{3e6, 0, 0});
    REQUIRE(world.set_velocity(ball, {Real(3e6), Real(0), Real(0)}).has_value());
    run(world, 60);
    const DVec3 there = far.place + 2.4 * normal_of(far);
    REQUIRE(length(world.pose(ball).position - there) < 1.0);
    REQUIRE(world.set_pose(ball, {there, {}}).has_value());
    check_held(world, ball, far, 1.0, 2.4);
  }

  TEST_CASE("pairs that are apart are tested again in time, however long they drifted") {
    // A gap of 3 m that shrinks by less than the last digit of its number in a step.
    const double speed = 1e-4;
    World world = make_world(empty_space());
    const BodyId ball = add_ball(world, {0, 0.4 + 3e-3, 0});
    add_slab(world, {.lean = Real(0)});
    check_held(world, ball, {.lean = Real(0), .dt = 1.0 / 60}, speed, 60);
  }
}

}  // namespace hooke
