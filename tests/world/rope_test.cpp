#include "solver/soft/particle_kernels.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// Times at which x changes sign, interpolated.
template <class Position>
std::vector<double> zero_crossings(World& world, std::size_t count, Position&& x) {
  std::vector<double> times;
  double before = x();
  while (times.size() < count && world.time() < 60) {
    world.step(Real(1) / Real(60));
    const double now = x();
    if ((before > 0) != (now > 0)) times.push_back(world.time() - now / (now - before) / 60.0);
    before = now;
  }
  return times;
}

}  // namespace

TEST_SUITE("world/rope") {
  TEST_CASE("a hanging rope stretches by Mg/K + mg/2K whatever the number of its segments") {
    // 1 kg rope, 2 kg load, K = 100 N/m: 0.1962 + 0.04905 m.
    for (const int segments : {4, 16, 64, 256}) {
      World world = make_world(without_air());
      RopeDesc desc;
      desc.direction = {Real(0), Real(-1), Real(0)};
      desc.masses = segments + 1;
      desc.stiffness = Real(100);
      desc.inner_friction = Real(20);
      desc.loads = {{static_cast<std::uint32_t>(segments), Real(2)}};
      const RopeId rope = take(world.add_rope(desc));
      run(world, 1200);
      const double extension = -1.0 - world.positions(rope)[static_cast<std::size_t>(segments)].y;
      CHECK(extension == doctest::Approx(0.24525).epsilon(1e-3).scale(0));
    }
  }

  TEST_CASE("as in the paper, stiffness given per segment makes a longer rope of more segments") {
    for (const int segments : {4, 16}) {
      World world = make_world(without_air());
      RopeDesc desc;
      desc.direction = {Real(0), Real(-1), Real(0)};
      desc.masses = segments + 1;
      desc.stiffness = Real(100);
      desc.inner_friction = Real(20);
      desc.stiffness_of = RopeDesc::StiffnessOf::kSegment;
      const RopeId rope = take(world.add_rope(desc));
      run(world, 2400);
      const double extension = -1.0 - world.positions(rope)[static_cast<std::size_t>(segments)].y;
      CHECK(extension == doctest::Approx(0.04905 * segments).epsilon(2e-3).scale(0));
    }
  }

  TEST_CASE("a pendulum from 90 degrees has the period of the elliptic integral") {
    // T / T0 = 2 K(sin 45) / pi = 1.180341, from the first to the third zero crossing.
    World world = make_world(without_air());
    RopeDesc desc;
    desc.points = {{0, 0, 0}, {1, 0, 0}};
    const RopeId rope = take(world.add_rope(desc));
    const auto t = zero_crossings(world, 3, [&] { return world.positions(rope)[1].x; });
    REQUIRE(t.size() == 3);
    const double small_swing = 2 * std::numbers::pi * std::sqrt(1.0 / 9.81);
    CHECK((t[2] - t[0]) / small_swing == doctest::Approx(1.180341).epsilon(2e-4));
  }

  TEST_CASE("a rope of one segment or more that goes round a cone pulls with m g / cos") {
    // At 40 degrees the load goes round with v^2 = g L sin tan. Some ropes side by side, in all directions.
    const double angle = 40 * std::numbers::pi / 180;
    const double length = 0.8;
    const double speed = std::sqrt(9.81 * length * std::sin(angle) * std::tan(angle));
    for (const std::uint32_t segments : {1U, 2U, 5U}) {
      for (const int count : {1, 5}) {
        World world = make_world(without_air());
        std::vector<RopeId> ropes;
        for (int k = 0; k < count; ++k) {
          const double turn = 0.3 + 1.1 * k;
          const DVec3 out = {std::cos(turn), 0, std::sin(turn)};
          RopeDesc desc{.total_mass = Real(0.002), .loads = {{.point = segments, .mass = Real(2)}}};
          for (std::uint32_t i = 0; i <= segments; ++i)
            desc.points.push_back((length * i / segments) *
                                  (std::sin(angle) * out - DVec3{0, std::cos(angle), 0}));
          ropes.push_back(take(world.add_rope(desc)));
          const Vec3 along = vector_cast<Real>(speed * DVec3{-std::sin(turn), 0, std::cos(turn)});
          REQUIRE(world.set_velocity(point(ropes.back(), segments), along).has_value());
        }
        run(world, 30);
        for (int i = 0; i < 60; ++i) {
          run(world, 1);
          for (const RopeId rope : ropes)
            CHECK(d(world.tensions(rope).back()) ==
                  doctest::Approx(2.001 * 9.81 / std::cos(angle)).epsilon(0.01));
        }
      }
    }
  }

  TEST_CASE("a swing from the horizontal gains no energy, measured at any step") {
    World world = make_world(without_air());
    RopeDesc desc;
    desc.masses = 2;
    desc.total_mass = Real(2);
    desc.stiffness = kRigid;
    take(world.add_rope(desc));
    const double start = world.measure().energy.total();
    double largest = 0;
    for (int i = 0; i < 180; ++i) {
      run(world, 1);
      largest = std::max(largest, std::abs(world.measure().energy.total() - start));
    }
    // Of 9.81 J. With positions half a substep ahead of velocities it was 0.028 J.
    CHECK(largest < 0.005);
  }

  TEST_CASE("any stiffness is stable and a stiff rope holds a ton on a kilogram") {
    for (const double stiffness : {1e4, 1e6, 1e9, 1e30}) {
      World world = make_world(without_air());
      RopeDesc desc;
      desc.masses = 33;
      desc.stiffness = static_cast<Real>(stiffness);
      desc.loads = {{32, Real(1000)}};
      take(world.add_rope(desc));
      const double start = world.measure().energy.total();
      run(world, 300);
      const Measurement m = world.measure();
      CHECK(m.energy.total() <= start + 10.0);  // of a swing of 9810 J
      if (stiffness >= 1e9) CHECK(m.largest_stretch < 2e-4);
    }
  }

  TEST_CASE("the tension of a resting rope is the weight below each segment") {
    World world = make_world(without_air());
    RopeDesc desc;
    desc.direction = {Real(0), Real(-1), Real(0)};
    desc.masses = 11;
    desc.stiffness = Real(1000);
    desc.inner_friction = Real(50);
    const RopeId rope = take(world.add_rope(desc));
    run(world, 1200);
    const std::vector<Real> tension = world.tensions(rope);
    REQUIRE(tension.size() == 10);
    for (std::size_t i = 0; i < 10; ++i) {
      CHECK(tension[i] ==
            doctest::Approx(9.81 * (1.0 - 0.1 * static_cast<double>(i) - 0.05)).epsilon(1e-3).scale(0));
    }
  }

  TEST_CASE("a rope that nothing holds falls freely and keeps its momentum") {
    World world = make_world(without_air());
    RopeDesc desc;
    desc.pins = {};
    desc.velocity = {Real(1), Real(0), Real(0.5)};
    const RopeId rope = take(world.add_rope(desc));
    run(world, 60);
    const Measurement m = world.measure();
    CHECK(m.momentum.x == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(m.momentum.y == doctest::Approx(-9.81).epsilon(1e-5));
    CHECK(m.largest_stretch < 1e-5);
    static_cast<void>(rope);
  }

  TEST_CASE("a rope pinned at both ends hangs in the elastic limit of a catenary") {
    // Span 1, length 1.5: sag 0.502633 (Bernoulli; a = 0.308236).
    World world = make_world(without_air());
    RopeDesc desc;
    const int segments = 150;
    const double fall = std::sqrt(0.75 * 0.75 - 0.25);
    for (int i = 0; i <= segments; ++i) {
      const double s = static_cast<double>(i) / segments;
      desc.points.push_back({s, -2 * fall * (s < 0.5 ? s : 1 - s), 0});
    }
    desc.pins = {{0}, {static_cast<std::uint32_t>(segments)}};
    desc.air_friction = Real(2);
    desc.drag_coefficient = Real(0);
    const RopeId rope = take(world.add_rope(desc));
    run(world, 1800);
    double lowest = 0;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(segments); ++i) {
      lowest = std::min(lowest, world.positions(rope)[i].y);
    }
    CHECK(-lowest == doctest::Approx(0.502633).epsilon(2e-3));
  }

  TEST_CASE("the extension limit holds a soft rope at its longest") {
    World world = make_world(without_air());
    RopeDesc desc;
    desc.direction = {Real(0), Real(-1), Real(0)};
    desc.stiffness = Real(50);
    desc.inner_friction = Real(5);
    desc.extension_max = Real(0.1);
    desc.loads = {{15, Real(10)}};  // would stretch it by 2 m
    const RopeId rope = take(world.add_rope(desc));
    run(world, 600);
    CHECK(-1.0 - world.positions(rope)[15].y == doctest::Approx(0.1).epsilon(1e-2).scale(0));
  }

  TEST_CASE("a folded rope with ten thousand times its mass snaps taut and stays whole") {
    World world = make_world(without_air());
    RopeDesc desc;
    for (int i = 0; i <= 50; ++i) desc.points.push_back({i <= 25 ? 0.02 * i : 1.0 - 0.02 * i, 0, 0.001 * i});
    desc.total_mass = Real(0.05);
    desc.loads = {{50, Real(500)}};
    take(world.add_rope(desc));
    const double start = world.measure().energy.total();
    run(world, 600);
    const Measurement m = world.measure();
    CHECK(m.energy.total() <= start + 5.0);  // of 4905 J
    CHECK(m.largest_stretch < 0.01);
  }

  TEST_CASE("a rod bent to a quarter circle holds EI L / 2 R^2") {
    World world = make_world(test::empty_space());
    RopeDesc desc;
    desc.bend_stiffness = Real(0.3);
    desc.pins = {};
    for (std::uint32_t i = 0; i <= 64; ++i) {
      const double angle = std::numbers::pi / 2 * i / 64;
      desc.points.push_back({2 * std::sin(angle), 2 * std::cos(angle), 0});
      desc.pins.push_back({.point = i});
    }
    take(world.add_rope(desc));
    // 63 of 64 parts: at its ends it does not bend.
    const double length = std::numbers::pi * 63 / 64;
    CHECK(world.measure().energy.elastic == doctest::Approx(0.3 * length / 8).epsilon(1e-3));
  }

  TEST_CASE("a rope lies still on the ground and slides down a slope that is too steep for it") {
    for (const bool steep : {false, true}) {
      World world = make_world(without_air());
      const double angle = steep ? 0.6 : 0.3;  // friction 0.5 holds up to 0.4636
      BodyDesc ground;
      ground.shape = Shape::half_space();
      ground.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, static_cast<Real>(angle));
      take(world.add_body(ground));
      RopeDesc desc;
      const DVec3 down = {-std::cos(angle), -std::sin(angle), 0};
      const DVec3 up = {-std::sin(angle), std::cos(angle), 0};
      for (int i = 0; i < 11; ++i) desc.points.push_back(0.0051 * up + (0.1 * i) * down);
      desc.pins = {};
      const RopeId rope = take(world.add_rope(desc));
      run(world, 60);
      const DVec3 before = world.positions(rope)[5];
      run(world, 60);
      const double way = dot(world.positions(rope)[5] - before, down);
      // a = g (sin - mu cos): from rest, the second second covers 3/2 a.
      const double expected = steep ? 1.5 * 9.81 * (std::sin(angle) - 0.5 * std::cos(angle)) : 0.0;
      CHECK(way == doctest::Approx(expected).epsilon(0.02).scale(1e-3));
      if (!steep) CHECK(std::abs(way) < 1e-5);
      CHECK(world.measure().largest_penetration < 1e-4);
    }
  }

  TEST_CASE("ropes side by side move as each alone, to the bit, with every instruction set") {
    const auto rope_of = [](int k) {
      RopeDesc desc;
      for (int i = 0; i <= 12; ++i)
        desc.points.push_back({0.1 * k + 0.02 * i, 0.35 + 0.03 * k, 0.01 * k * i});
      desc.total_mass = Real(0.01 * (1 + k));
      desc.stiffness = k % 3 == 0 ? kRigid : Real(10 * (k + 1));
      desc.extension_max = k % 3 == 1 ? Real(0.05) : kRigid;
      desc.bend_stiffness = k < 10 ? Real(0) : Real(1e-4);  // only neighbors that both bend share lanes
      if (k % 4 == 0) desc.pins = {};
      return desc;
    };
    const auto places = [](const World& world, RopeId rope) {
      std::vector<DVec3> points;
      for (std::size_t i = 0; i < 13; ++i) points.push_back(world.positions(rope)[i]);
      return points;
    };
    const auto add_floor = [](World& world) {
      take(world.add_body({.kind = BodyKind::kStatic, .shape = {.kind = ShapeKind::kHalfSpace}}));
    };
    constexpr int kCount = 19;
    std::vector<std::vector<DVec3>> alone;
    for (int k = 0; k < kCount; ++k) {
      World world = make_world();
      add_floor(world);
      const RopeId rope = take(world.add_rope(rope_of(k)));
      run(world, 90);
      alone.push_back(places(world, rope));
    }
    for (const std::string& target : solver::wide::targets()) {
      REQUIRE(solver::wide::use_target(target));
      World world = make_world();
      add_floor(world);
      std::vector<RopeId> ropes;
      for (int k = 0; k < kCount; ++k) ropes.push_back(take(world.add_rope(rope_of(k))));
      run(world, 90);
      for (int k = 0; k < kCount; ++k) CHECK_MESSAGE(places(world, ropes[k]) == alone[k], target, " ", k);
    }
    solver::wide::use_target("");
  }
}

}  // namespace hooke
