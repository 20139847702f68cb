/// Whoever changes what acts on a body that sleeps wakes it: each call of the API in turn, on a box that has
/// come to rest.

#include "world/make.h"

#include <cmath>
#include <functional>

namespace hooke {

using namespace test;

namespace {

constexpr Real kDt = Real(1) / Real(60);
constexpr double kGravity = 9.81;
constexpr Real kFriction = Real(0.25);

/// A box of 1 kg and 1 m^3 that sleeps on a plate.
struct Rest {
  World world;
  BodyId plate = {};
  BodyId box = {};
};

Rest make_rest(Real drag = 0) {
  Rest r{.world = make_world()};
  const ContactDesc surface = {.friction = kFriction};
  r.plate = take(r.world.add_body(
      {.shape = Shape::box({8, Real(0.5), 8}), .position = {0, -0.5, 0}, .contact = surface}));
  r.box = take(r.world.add_body({.kind = BodyKind::kDynamic,
                                 .shape = Shape::box({Real(0.5), Real(0.5), Real(0.5)}),
                                 .position = {0, 0.5, 0},
                                 .density = 1,
                                 .drag_coefficient = drag,
                                 .contact = surface}));
  run(r.world, 60);
  REQUIRE(r.world.asleep(r.box));
  return r;
}

/// How far the box goes in half a second after a call.
DVec3 way_after(Rest& r, const std::function<void(Rest&)>& call) {
  const DVec3 start = r.world.pose(r.box).position;
  call(r);
  run(r.world, 30);
  return r.world.pose(r.box).position - start;
}

/// From rest at an acceleration.
double way_at(double acceleration) {
  return 0.5 * acceleration * 0.5 * 0.5;
}

}  // namespace

TEST_SUITE("world/waking") {
  TEST_CASE("gravity that changes wakes, gravity that is set to what it is does not") {
    Rest r = make_rest();
    const DVec3 up = way_after(r, [](Rest& s) { CHECK(s.world.set_gravity({0, Real(3), 0}).has_value()); });
    CHECK(up.y == doctest::Approx(way_at(3)).epsilon(0.05));
    Rest still = make_rest();
    CHECK(still.world.set_gravity({0, Real(-kGravity), 0}).has_value());
    CHECK(still.world.asleep(still.box));
  }

  TEST_CASE("wind that changes wakes what it can move") {
    Rest r = make_rest(Real(1));
    const WindDesc wind = {.velocity = {Real(12), 0, 0}};
    const DVec3 way = way_after(r, [&](Rest& s) { CHECK(s.world.set_wind(wind).has_value()); });
    // rho C A v^2 / 2 = 88 N on 1 kg at first; it is far from 12 m/s times half a second.
    CHECK(way.x > 2);
    CHECK(way.x < 6);
    run(r.world, 600);
    Rest still = make_rest(Real(1));
    CHECK(still.world.set_wind(still.world.desc().wind).has_value());
    CHECK(still.world.asleep(still.box));
  }

  TEST_CASE("a field that comes wakes, and so does one that goes") {
    Rest r = make_rest();
    FieldId field;
    const DVec3 pulled = way_after(r, [&](Rest& s) {
      field = take(s.world.add_field({.kind = FieldDesc::Kind::kUniform, .vector = {10, 0, 0}}));
    });
    CHECK(pulled.x == doctest::Approx(way_at(10 - 0.25 * kGravity)).epsilon(0.05));

    // Held up the plate's underside by a field; without it the box falls.
    Rest held = make_rest();
    const FieldId lift = take(held.world.add_field({.vector = {0, Real(2 * kGravity), 0}}));
    CHECK(held.world.set_pose(held.box, {{0, -1.5, 0}}).has_value());
    CHECK(held.world.set_velocity(held.box, {}).has_value());
    run(held.world, 90);
    REQUIRE(held.world.asleep(held.box));
    const DVec3 fallen = way_after(held, [&](Rest& s) { CHECK(s.world.remove(lift)); });
    CHECK(fallen.y == doctest::Approx(-way_at(kGravity)).epsilon(0.05));
  }

  TEST_CASE("a law of bodies that comes wakes, and so does one that goes") {
    Rest r = make_rest();
    ForceLawId law;
    const DVec3 pushed = way_after(r, [&](Rest& s) {
      law = take(s.world.add_force_law(BodyForceLaw([](BodyForceView& view) {
        for (std::size_t i = 0; i < view.size(); ++i) view.add_force(i, {0, 0, 8});
      })));
    });
    CHECK(pushed.z == doctest::Approx(way_at(8 - 0.25 * kGravity)).epsilon(0.05));

    Rest held = make_rest();
    const ForceLawId lift = take(held.world.add_force_law(BodyForceLaw([](BodyForceView& view) {
      for (std::size_t i = 0; i < view.size(); ++i) view.add_force(i, {0, Real(2 * kGravity), 0});
    })));
    CHECK(held.world.set_pose(held.box, {{0, -1.5, 0}}).has_value());
    CHECK(held.world.set_velocity(held.box, {}).has_value());
    run(held.world, 90);
    REQUIRE(held.world.asleep(held.box));
    const DVec3 fallen = way_after(held, [&](Rest& s) { CHECK(s.world.remove(lift)); });
    CHECK(fallen.y == doctest::Approx(-way_at(kGravity)).epsilon(0.05));
  }

  TEST_CASE("a static body that is put into one that sleeps wakes it") {
    const auto put = [](Rest& s, BodyId wall) {
      CHECK(s.world.set_pose(wall, {{-0.75, 0.5, 0}}).has_value());
    };
    const BodyDesc desc = {.shape = Shape::box({Real(0.5), Real(0.5), Real(0.5)}), .position = {0, 50, 0}};
    Rest moved = make_rest();
    const BodyId wall = take(moved.world.add_body(desc));
    CHECK(way_after(moved, [&](Rest& s) { put(s, wall); }).x == doctest::Approx(0.25).epsilon(0.1));
    Rest added = make_rest();
    CHECK(way_after(added, [&](Rest& s) {
            BodyDesc there = desc;
            there.position = {-0.75, 0.5, 0};
            take(s.world.add_body(there));
          }).x == doctest::Approx(0.25).epsilon(0.1));
    Rest far = make_rest();
    take(far.world.add_body(desc));
    CHECK(far.world.asleep(far.box));
  }

  TEST_CASE("a body on a cloth falls when the cloth is removed or unpinned") {
    const auto fall = [](const std::function<void(World&, ClothId)>& call) {
      World world = make_world();
      const ClothId cloth = take(world.add_cloth({.columns = 9,
                                                  .rows = 9,
                                                  .corner = {-0.5, 5, -0.5},
                                                  .row_direction = {0, 0, 1},
                                                  .damping = Real(1),
                                                  .air_friction = Real(1),
                                                  .pins = {{0}, {8}, {72}, {80}}}));
      const BodyId box = take(world.add_body({.kind = BodyKind::kDynamic,
                                              .shape = Shape::box({Real(0.2), Real(0.2), Real(0.2)}),
                                              .position = {0, 5.05, 0},
                                              .mass = Real(0.1),
                                              .linear_damping = 5,
                                              .angular_damping = 5}));
      for (int i = 0; i < 1200; ++i) REQUIRE(world.step(kDt).healthy());
      const double before = world.pose(box).position.y;
      call(world, cloth);
      run(world, 60);
      return before - world.pose(box).position.y;
    };
    CHECK(fall([](World& w, ClothId cloth) { CHECK(w.remove(cloth)); }) > 1);
    CHECK(fall([](World& w, ClothId cloth) {
            for (const std::uint32_t i : {0U, 8U, 72U, 80U}) CHECK(w.unpin(point(cloth, i)).has_value());
          }) > 1);
    CHECK(fall([](World&, ClothId) {}) < 0.01);
  }

  TEST_CASE("a body on a jelly goes along when the jelly sinks") {
    World world = make_world();
    const BodyId lift = take(world.add_body({.kind = BodyKind::kKinematic,
                                             .shape = Shape::box({Real(0.5), Real(0.1), Real(0.5)}),
                                             .position = {0, -0.1, 0}}));
    take(world.add_solid({.cells = {3, 3, 3},
                          .size = {Real(0.4), Real(0.4), Real(0.4)},
                          .position = {0, 0.2, 0},
                          .young_modulus = Real(1e6)}));
    const BodyId box = take(world.add_body({.kind = BodyKind::kDynamic,
                                            .shape = Shape::box({Real(0.2), Real(0.05), Real(0.2)}),
                                            .position = {0, 0.45, 0},
                                            .mass = 20}));
    run(world, 120);
    const double before = world.pose(box).position.y;
    const MotionDesc down = {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = {0, Real(-0.1), 0}};
    CHECK(world.set_motion(lift, down).has_value());
    run(world, 120);
    CHECK(before - world.pose(box).position.y == doctest::Approx(0.2).epsilon(0.02));
  }
}

}  // namespace hooke
