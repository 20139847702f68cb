#include "solver/soft/particle_kernels.h"
#include "world/make.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

struct Stage {
  World world;
  RopeId rope;
  ClothId flag;
  ParticlesId net;
  BodyId ball;
};

/// A bit of everything: ropes, a flag in gusts with limits and tethers, springs of all forms, contacts,
/// fields.
Stage make_stage(int workers = 1) {
  WorldDesc desc;
  desc.workers = workers;
  desc.wind.velocity = {Real(5), 0, Real(1)};
  desc.wind.gust = Real(0.5);
  desc.wind.side_gust = Real(0.2);
  Stage s{make_world(desc), {}, {}, {}, {}};
  take(s.world.add_body({.shape = Shape::half_space()}));
  s.ball = take(s.world.add_body({.shape = Shape::sphere(Real(0.4)), .position = {-0.6, 1.3, 1}}));
  for (int i = 0; i < 3; ++i) {
    RopeDesc rope;
    rope.hook_point = {0, 2.0 + i, 1};
    rope.masses = 20 + i;
    rope.stiffness = i == 0 ? kRigid : Real(1e4);
    s.rope = take(s.world.add_rope(rope));
  }
  ClothDesc flag;
  flag.columns = 40;
  flag.rows = 25;
  flag.corner = {0, 2, 0};
  flag.width = Real(1.5);
  flag.pins = {{0}, {40 * 24}};
  flag.extension_max = Real(0.05);
  flag.tethers = true;
  s.flag = take(s.world.add_cloth(flag));
  ParticlesDesc net;
  for (int i = 0; i < 40; ++i) {
    net.particles.push_back(
        {.position = {0.1 * (i % 8), 1 + 0.1 * static_cast<int>(i / 8), 2}, .charge = Real(0.1)});
    if (i > 0)
      net.springs.push_back(
          {static_cast<std::uint32_t>(i - 1), static_cast<std::uint32_t>(i), Real(500), Real(1)});
    if (i > 7)
      net.springs.push_back({static_cast<std::uint32_t>(i - 8), static_cast<std::uint32_t>(i), Real(700)});
  }
  net.direction = ParticlesDesc::Direction::kPredicted;
  s.net = take(s.world.add_particles(net));
  take(s.world.add_field({.kind = FieldDesc::Kind::kMagnetic, .vector = {0, Real(0.3), 0}}));
  return s;
}

std::vector<std::uint64_t> hashes(Stage& stage, int steps) {
  std::vector<std::uint64_t> result;
  for (int i = 0; i < steps; ++i) {
    stage.world.step(Real(1) / Real(60));
    result.push_back(stage.world.state_hash());
  }
  return result;
}

}  // namespace

TEST_SUITE("world/state") {
  TEST_CASE("a world has the same bits for any number of workers") {
    Stage one = make_stage(1);
    const auto expected = hashes(one, 60);
    for (const int workers : {2, 3, 8}) {
      Stage other = make_stage(workers);
      CHECK(hashes(other, 60) == expected);
    }
  }

  TEST_CASE("a world has the same bits for every instruction set") {
    std::vector<std::uint64_t> expected;
    for (const std::string& target : solver::wide::targets()) {
      REQUIRE(solver::wide::use_target(target));
      Stage stage = make_stage();
      const auto got = hashes(stage, 60);
      if (expected.empty()) expected = got;
      CHECK_MESSAGE(got == expected, target);
    }
    solver::wide::use_target("");
  }

  TEST_CASE("the hash notices the smallest change") {
    Stage a = make_stage();
    Stage b = make_stage();
    REQUIRE(a.world.apply_impulse(point(a.rope, 5), {Real(1e-6), 0, 0}));
    CHECK(a.world.state_hash() != b.world.state_hash());
  }

  TEST_CASE("a restored world goes on with the same bits, in this world and in another") {
    Stage stage = make_stage();
    hashes(stage, 37);
    const Snapshot snapshot = stage.world.snapshot();
    const std::uint64_t at_snapshot = stage.world.state_hash();
    const auto expected = hashes(stage, 30);
    REQUIRE(stage.world.restore(snapshot));
    CHECK(stage.world.state_hash() == at_snapshot);
    CHECK(hashes(stage, 30) == expected);
    Stage other = make_stage(2);
    hashes(other, 11);
    CHECK(other.world.remove(other.flag));
    REQUIRE(other.world.restore(snapshot));
    CHECK(hashes(other, 30) == expected);
    CHECK_FALSE(other.world.restore(Snapshot{}));
  }

  TEST_CASE("a restored world goes on alike, whatever stood beside its bodies and was removed") {
    World world = make_world();
    take(world.add_body({.contact = {.restitution = Real(0.5)}}));
    const auto add = [&](DVec3 position, const Shape& shape) {
      return take(world.add_body({.kind = BodyKind::kDynamic,
                                  .shape = shape,
                                  .position = position,
                                  .velocity = {0, -3, 0},
                                  .contact = {.restitution = Real(0.5)}}));
    };
    const Shape box = Shape::box({Real(0.1), Real(0.1), Real(0.1)});
    add({0, 0.15, 0}, Shape::sphere(Real(0.1)));
    add({1, 0.2, 0}, box);
    add({1.05, 0.405, 0}, box);
    const BodyId removed = add({3, 5, 0}, box);
    run(world, 3);
    CHECK(world.remove(removed));
    World other = make_world();
    REQUIRE(other.restore(world.snapshot()));
    for (int i = 0; i < 8; ++i) {
      CHECK(world.state_hash() == other.state_hash());
      run(world, 1);
      run(other, 1);
    }
  }

  TEST_CASE("an id made between a snapshot and its restoration is stale afterwards") {
    Stage stage = make_stage();
    const Snapshot snapshot = stage.world.snapshot();
    const RopeId late = take(stage.world.add_rope({}));
    REQUIRE(stage.world.restore(snapshot));
    const RopeId later = take(stage.world.add_rope({}));
    CHECK(stage.world.positions(late).empty());
    CHECK(stage.world.positions(later).size() == 16);
  }

  TEST_CASE("removing an object changes no bit of the others") {
    Stage with = make_stage();
    Stage without = make_stage();
    const RopeId middle = {.slot = 2, .generation = 1};
    CHECK(without.world.remove(middle));
    CHECK_FALSE(without.world.remove(middle));
    CHECK(without.world.positions(middle).empty());
    run(with.world, 40);
    run(without.world, 40);
    for (std::size_t i = 0; i < with.world.positions(with.flag).size(); ++i) {
      CHECK(with.world.positions(with.flag)[i] == without.world.positions(without.flag)[i]);
    }
    for (std::size_t i = 0; i < 40; ++i) {
      CHECK(with.world.positions(with.net)[i] == without.world.positions(without.net)[i]);
    }
    CHECK(without.world.remove(without.ball));
    run(without.world, 10);
  }

  TEST_CASE("ropes that touch ropes bear one force that is infinite") {
    World world = make_world();
    for (const double z : {0.0, 0.03})
      take(world.add_rope(
          {.hook_point = {0, 3, z}, .masses = 8, .radius = Real(0.02), .touches_ropes = true}));
    bool pushes = false;
    take(world.add_force_law([&](ForceView& view) {
      if (pushes) view.add_force(view.size() / 2, {std::numeric_limits<Real>::infinity(), 0, 0});
    }));
    std::uint32_t quarantined = 0;
    for (int i = 0; i < 6; ++i) {
      pushes = i == 2;
      quarantined += world.step(Real(1) / Real(60)).rows_quarantined;
    }
    CHECK(quarantined > 0);
    CHECK(std::isfinite(world.measure().energy.total()));
  }

  TEST_CASE("a force law that returns nonsense freezes its object and no other") {
    Stage clean = make_stage();
    Stage dirty = make_stage();
    const std::uint32_t slot = dirty.rope.slot;
    take(dirty.world.add_force_law([slot](ForceView& view) {
      if (view.kind() != PointRef::Kind::kRope || view.slot() != slot) return;
      view.add_force(7, {std::numeric_limits<Real>::quiet_NaN(), 0, 0});
    }));
    std::uint32_t quarantined = 0;
    for (int i = 0; i < 20; ++i) {
      clean.world.step(Real(1) / Real(60));
      quarantined += dirty.world.step(Real(1) / Real(60)).rows_quarantined;
    }
    CHECK(quarantined > 0);
    for (std::size_t i = 0; i < dirty.world.positions(dirty.rope).size(); ++i) {
      CHECK(is_finite(dirty.world.positions(dirty.rope)[i]));
    }
    CHECK(dirty.world.positions(dirty.flag)[333] == clean.world.positions(clean.flag)[333]);
  }

  TEST_CASE(
      "one force that is no number stops a body for one step, and not what it touches or is hooked to for "
      "good") {
    for (const bool hooked : {false, true}) {
      World world = make_world({.sleeping = false});
      take(world.add_body({.kind = BodyKind::kStatic, .shape = Shape::half_space()}));
      const BodyId crate = world
                               .add_body({.kind = BodyKind::kDynamic,
                                          .shape = Shape::box({Real(0.25), Real(0.25), Real(0.25)}),
                                          .position = {0, 0.25, 0},
                                          .mass = Real(10),
                                          .contact = {.friction = Real(0)}})
                               .value();
      HookId hook;
      HookId string;
      if (hooked) {
        const BodyId other = world
                                 .add_body({.kind = BodyKind::kDynamic,
                                            .shape = Shape::sphere(Real(0.1)),
                                            .position = {0, 1, 0},
                                            .mass = Real(1)})
                                 .value();
        hook = take(world.add_hook({.a = {.body = crate}, .b = {.body = other}, .anchor = {0, 0.7, 0}}));
        string = take(world.add_hook({.kind = HookKind::kDistance,
                                      .a = {.body = crate},
                                      .b = {.body = other},
                                      .anchor = {0, 0.5, 0},
                                      .anchor_b = DVec3{0, 1, 0}}));
      }
      Real force = Real(0);
      take(world.add_force_law([&](BodyForceView& bodies) {
        bodies.add_force(0, {force, Real(0), Real(0)});
      }));
      const auto quarantined = [&](int steps) {
        std::uint32_t count = 0;
        for (int i = 0; i < steps; ++i) count += world.step(Real(1) / Real(60)).rows_quarantined;
        return count;
      };
      CHECK(quarantined(30) == 0);
      force = std::numeric_limits<Real>::quiet_NaN();
      CHECK(quarantined(1) > 0);
      CHECK(std::isfinite(length(world.hook_force(hook).force)));
      CHECK(std::isfinite(length(world.hook_force(hook).torque)));
      CHECK(std::isfinite(world.hook_value(string)));
      force = Real(0);
      CHECK(quarantined(10) == 0);
      if (hooked) continue;
      // Without friction it then slides as v = F t / m says: 0.5 s at 20 N and 10 kg are 1 m/s.
      force = Real(20);
      CHECK(quarantined(30) == 0);
      CHECK(static_cast<double>(world.velocity(crate).x) == doctest::Approx(1).epsilon(0.001));
    }
  }

  TEST_CASE(
      "a net with a force that is no number on one ball is quarantined once, and then falls on as a whole") {
    constexpr int kSide = 30;  // beyond the budget of an exact solution: ball hooks side by side
    World world = make_world({.sleeping = false});
    std::vector<BodyId> balls;
    const auto place_of = [](int i) { return DVec3{0.5 * (i % kSide), 10, 0.5 * (i / kSide)}; };
    for (int i = 0; i < kSide * kSide; ++i)
      balls.push_back(take(world.add_body(
          {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.2)), .position = place_of(i)})));
    const auto hook = [&](int a, int b) {
      take(world.add_hook({.a = {.body = balls[static_cast<std::size_t>(a)]},
                           .b = {.body = balls[static_cast<std::size_t>(b)]},
                           .anchor = 0.5 * (place_of(a) + place_of(b))}));
    };
    for (int i = 0; i < kSide * kSide; ++i) {
      if (i % kSide > 0) hook(i - 1, i);
      if (i >= kSide) hook(i - kSide, i);
    }
    Real force = std::numeric_limits<Real>::quiet_NaN();
    take(world.add_force_law([&](BodyForceView& bodies) { bodies.add_force(0, {force, Real(0), Real(0)}); }));
    CHECK(world.step(Real(1) / Real(60)).rows_quarantined > 0);
    force = Real(0);
    for (int i = 0; i < 30; ++i) CHECK(world.step(Real(1) / Real(60)).rows_quarantined == 0);
  }

  TEST_CASE("a force law sees every particle in order and its force acts") {
    World world = make_world(test::empty_space());
    const ParticlesId id =
        take(world.add_particles({.particles = {{.mass = Real(2)}, {.position = {1, 0, 0}}}}));
    take(world.add_force_law([](ForceView& view) {
      for (std::size_t i = 0; i < view.size(); ++i) view.add_force(i, {0, view.mass(i) * Real(3), 0});
      view.add_force(99, {Real(1), 0, 0});
    }));
    run(world, 60);
    CHECK(world.velocities(id)[0].y == doctest::Approx(3.0).epsilon(1e-5));
    CHECK(world.velocities(id)[1].y == doctest::Approx(3.0).epsilon(1e-5));
    CHECK(world.velocities(id)[0].x == 0.0);
  }

  TEST_CASE("an external force acts for one step") {
    World world = make_world(test::empty_space());
    const ParticlesId id = take(world.add_particles({.particles = {{.mass = Real(2)}}}));
    REQUIRE(world.apply_force(point(id, 0), {Real(12), 0, 0}));
    run(world, 1);
    CHECK(world.velocities(id)[0].x == doctest::Approx(12.0 / 2 / 60).epsilon(1e-5));
    run(world, 5);
    CHECK(world.velocities(id)[0].x == doctest::Approx(12.0 / 2 / 60).epsilon(1e-5));
  }

  TEST_CASE("a thousand kilometers from the origin a rope swings as at home") {
    const DVec3 far = {1e6, -3e5, 2e6};
    World home = make_world();
    World away = make_world();
    RopeDesc desc;
    const RopeId a = take(home.add_rope(desc));
    desc.hook_point = far;
    const RopeId b = take(away.add_rope(desc));
    run(home, 120);
    run(away, 120);
    for (std::size_t i = 0; i < 16; ++i) {
      // Sums of double coordinates of this size are rounded to 2e-10 m, in each of 960 substeps.
      CHECK(length(away.positions(b)[i] - far - home.positions(a)[i]) < 1e-8);
    }
  }

  TEST_CASE("the origin follows an object that flies far without a jump") {
    World world = make_world(test::empty_space());
    ParticlesDesc desc;
    desc.particles = {{.velocity = {Real(100), 0, 0}},
                      {.position = {0, 1, 0}, .velocity = {Real(100), 0, 0}}};
    desc.springs = {{0, 1, Real(1000)}};
    const ParticlesId id = take(world.add_particles(desc));
    run(world, 600);
    CHECK(world.positions(id)[0].x == doctest::Approx(1000.0).epsilon(1e-5));
    CHECK(std::abs(world.positions(id).offset(0).x) <= Real(66));
    CHECK(length(world.positions(id)[1] - world.positions(id)[0]) == doctest::Approx(1.0).epsilon(1e-5));
  }

  TEST_CASE("pins can be set and taken away") {
    World world = make_world();
    const ParticlesId id = take(world.add_particles({.particles = {{.position = {0, 5, 0}}}}));
    REQUIRE(world.pin(point(id, 0)));
    run(world, 60);
    CHECK(world.positions(id)[0] == DVec3{0, 5, 0});
    REQUIRE(world.unpin(point(id, 0)));
    run(world, 60);
    CHECK(world.positions(id)[0].y < 0.2);
  }
}

}  // namespace hooke
