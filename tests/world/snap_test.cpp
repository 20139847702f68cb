/// Ropes that snap: what a segment takes until then, which one breaks first, and what goes on after it.

#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr double kStep = 1.0 / 60;

/// A rope that hangs from the origin, with `masses` points, 1 m long.
RopeDesc hanging(int masses, Real mass, Real strength) {
  return {.direction = {0, -1, 0}, .total_mass = mass, .masses = masses, .strength = strength};
}

DVec3 momentum_of(const World& world, RopeId rope, const RopeDesc& desc, Real load) {
  DVec3 sum;
  const PointView v = world.velocities(rope);
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double share = (i == 0 || i + 1 == v.size()) ? 0.5 : 1;
    const double mass = share * d(desc.total_mass) / (desc.masses - 1) + (i + 1 == v.size() ? d(load) : 0);
    sum += mass * v[i];
  }
  return sum;
}

}  // namespace

TEST_SUITE("world/snap") {
  TEST_CASE("a rope that is jerked carries its strength for one substep, and the load keeps the rest") {
    for (const int substeps : {4, 8, 32}) {
      for (const int masses : {2, 3, 11}) {
        World world = make_world(sleepless_space(substeps));
        const RopeId rope = take(world.add_rope(hanging(masses, Real(0.01), 200)));
        const BodyId box = take(world.add_body({.kind = BodyKind::kDynamic,
                                                .shape = Shape::sphere(Real(0.1)),
                                                .position = {0, -1, 0},
                                                .velocity = {0, -3, 0},
                                                .mass = 10}));
        const auto last = static_cast<std::uint32_t>(masses - 1);
        take(world.add_hook({.a = {.point = point(rope, last)}, .b = {.body = box}, .anchor = {0, -1, 0}}));
        REQUIRE(world.set_velocity(point(rope, last), {0, -3, 0}).has_value());
        run(world, 1);
        const double h = kStep / substeps;
        REQUIRE(world.events().rope_breaks.size() == 1);
        const RopeBreakEvent& event = world.events().rope_breaks.front();
        CHECK(event.rope == rope);
        CHECK(event.time == doctest::Approx(h));
        CHECK(d(event.force) == doctest::Approx(10 * 3 / h).epsilon(0.05));
        CHECK(d(world.tensions(rope)[event.segment]) * kStep == doctest::Approx(200 * h).epsilon(0.01));
        CHECK(10 * (3 + d(world.velocity(box).y)) == doctest::Approx(200 * h).epsilon(0.01));
        CHECK(world.broken_segments(rope) == std::vector<std::uint32_t>{event.segment});
        run(world, 1);
        CHECK(world.events().rope_breaks.empty());
      }
    }
  }

  TEST_CASE("a soft rope breaks at its strength, and never carries more, at any length of the substep") {
    for (const int substeps : {4, 8, 32}) {
      World world = make_world(sleepless_space(substeps));
      RopeDesc desc = hanging(11, Real(0.1), 200);
      desc.stiffness = 2e4;
      desc.loads = {{10, 10}};
      const RopeId rope = take(world.add_rope(desc));
      REQUIRE(world.set_velocity(point(rope, 10), {0, -3, 0}).has_value());
      run(world, 1);
      // Where substeps follow the waves along the rope, it may break at both ends.
      REQUIRE(!world.events().rope_breaks.empty());
      CHECK(world.events().rope_breaks.size() <= 2);
      for (const RopeBreakEvent& event : world.events().rope_breaks) {
        CHECK(d(world.tensions(rope)[event.segment]) * kStep <= 200 * event.time * 1.001);
        CHECK(event.time < 0.006);  // k x = F at x = 10 mm, which 3 m/s takes 3.3 ms for
      }
    }
  }

  TEST_CASE("a rope too heavy for itself breaks where it hangs, and the rest falls freely") {
    WorldDesc desc = sleepless_space(8);
    desc.gravity = {0, -10, 0};
    World world = make_world(desc);
    const RopeId rope = take(world.add_rope(hanging(21, 2, 18)));  // its weight is 20 N
    run(world, 30);
    const std::vector<std::uint32_t> broken = world.broken_segments(rope);
    REQUIRE(!broken.empty());
    CHECK(broken.front() == 0);
    // After half a second the lower part has moved like a body of its own: v = -g t.
    CHECK(d(world.velocities(rope)[20].y) == doctest::Approx(-5).epsilon(0.01));
    for (const Real tension : world.tensions(rope)) CHECK(d(tension) < 0.05);
  }

  TEST_CASE("a rope that can take its load holds for good") {
    WorldDesc desc = sleepless_space(8);
    desc.gravity = {0, -10, 0};
    World world = make_world(desc);
    RopeDesc heavy = hanging(11, 1, 112);
    heavy.loads = {{10, 10}};  // 110 N at the top
    const RopeId rope = take(world.add_rope(heavy));
    run(world, 120);
    CHECK(world.broken_segments(rope).empty());
  }

  TEST_CASE("a snap keeps momentum and makes no energy") {
    for (const Real bend : {Real(0), Real(0.01)}) {
      World world = make_world(sleepless_space(8));
      RopeDesc desc = hanging(13, Real(0.6), 50);
      desc.pins = {};
      desc.bend_stiffness = bend;
      desc.loads = {{12, 3}};
      const RopeId rope = take(world.add_rope(desc));
      REQUIRE(world.set_velocity(point(rope, 12), {0, -4, 1}).has_value());
      const DVec3 before = momentum_of(world, rope, desc, 3);
      double energy = world.measure().energy.total();
      for (int i = 0; i < 120; ++i) {
        run(world, 1);
        const double now = world.measure().energy.total();
        CHECK(now <= energy * (1 + 1e-3));
        energy = std::max(energy, now);
      }
      CHECK(!world.broken_segments(rope).empty());
      CHECK(length(momentum_of(world, rope, desc, 3) - before) < 1e-4 * length(before));
    }
  }

  TEST_CASE("parts of a snapped rope fall and lie apart, and no gap holds a body") {
    WorldDesc desc = sleepless_space(8);
    desc.gravity = {0, -10, 0};
    World world = make_world(desc);
    RopeDesc line = {.points = {}, .strength = 60};
    for (int i = 0; i < 21; ++i) line.points.push_back({0.1 * i, 1, 0});
    line.total_mass = Real(0.2);
    line.pins = {{0}, {20}};
    line.loads = {{10, 20}};
    const RopeId rope = take(world.add_rope(line));
    take(world.add_body({.shape = Shape::half_space()}));
    run(world, 120);
    const std::vector<std::uint32_t> broken = world.broken_segments(rope);
    REQUIRE(!broken.empty());
    const PointView x = world.positions(rope);
    CHECK(length(x[broken.front() + 1] - x[broken.front()]) > 0.3);
    const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                             .shape = Shape::sphere(Real(0.02)),
                                             .position = 0.5 * (x[broken.front()] + x[broken.front() + 1]),
                                             .velocity = {},
                                             .mass = 1}));
    const double y = world.pose(ball).position.y;
    run(world, 6);
    CHECK(y - world.pose(ball).position.y > 0.04);  // 10 t^2 / 2 in 0.1 s is 0.05 m
  }

  TEST_CASE(
      "a bead stays on the part of the rope it is on, and a hook within the gap goes to the nearer end") {
    World world = make_world(sleepless_space(8));
    const RopeId rope = take(world.add_rope(hanging(6, Real(0.1), 100)));
    const BodyId bead = take(world.add_body({.kind = BodyKind::kDynamic,
                                             .shape = Shape::sphere(Real(0.02)),
                                             .position = {0, -0.3, 0},
                                             .mass = Real(0.01)}));
    const HookId slide = take(world.add_hook({.kind = HookKind::kRopeSlide,
                                              .a = {.point = point(rope, PointRef::kNearest)},
                                              .b = {.body = bead},
                                              .anchor = {0, -0.3, 0}}));
    const BodyId box = take(world.add_body({.kind = BodyKind::kDynamic,
                                            .shape = Shape::sphere(Real(0.02)),
                                            .position = {0, -0.96, 0},
                                            .velocity = {0, -9, 0},
                                            .mass = 5}));
    const HookId ball = take(world.add_hook(
        {.a = {.point = point(rope, PointRef::kNearest)}, .b = {.body = box}, .anchor = {0, -0.96, 0}}));
    run(world, 30);
    REQUIRE(!world.broken_segments(rope).empty());
    CHECK(world.hook_gap(slide) < Real(1e-3));
    CHECK(world.hook_gap(ball) < Real(1e-3));
    CHECK(world.pose(box).position.y < -4);  // free would be -0.96 - 9 / 2
  }

  TEST_CASE("ropes that touch ropes snap, and their parts go on touching") {
    WorldDesc desc = sleepless_space(8);
    desc.gravity = {0, -10, 0};
    World world = make_world(desc);
    RopeDesc line = {.points = {}, .radius = Real(0.02), .strength = 40, .touches_ropes = true};
    for (int i = 0; i < 21; ++i) line.points.push_back({0.1 * i, 1, 0});
    line.total_mass = Real(0.4);
    line.pins = {{0}, {20}};
    line.loads = {{12, 20}};
    const RopeId rope = take(world.add_rope(line));
    RopeDesc across = {.hook_point = {0.5, 1.05, -0.5}, .direction = {0, 0, 1}, .masses = 11};
    across.pins = {};
    across.touches_ropes = true;
    across.radius = Real(0.02);
    const RopeId other = take(world.add_rope(across));
    take(world.add_body({.shape = Shape::half_space()}));
    run(world, 120);
    CHECK(!world.broken_segments(rope).empty());
    CHECK(d(world.positions(other)[5].y) < 0.2);
    CHECK(world.measure().energy.kinetic < 10);
  }

  TEST_CASE("the same bits for any workers, and after a restoration before a snap") {
    std::array<std::uint64_t, 3> hashes = {};
    for (int k = 0; k < 3; ++k) {
      WorldDesc desc = sleepless_space(8, k == 1 ? 4 : 1);
      desc.gravity = {0, -10, 0};
      World world = make_world(desc);
      std::vector<RopeId> ropes;
      for (int i = 0; i < 8; ++i) {
        RopeDesc rope = hanging(9 + i, Real(0.2), 30);
        rope.hook_point = {0.5 * i, 2, 0};
        rope.direction = {1, Real(0.1) * Real(i), 0};
        rope.loads = {{static_cast<std::uint32_t>(8 + i), Real(1.2)}};
        ropes.push_back(take(world.add_rope(rope)));
      }
      run(world, 10);
      if (k == 2) {
        const Snapshot start = world.snapshot();
        run(world, 60);
        REQUIRE(world.restore(start).has_value());
      }
      run(world, 60);
      int broken = 0;
      for (const RopeId rope : ropes) broken += world.broken_segments(rope).empty() ? 0 : 1;
      CHECK(broken > 4);
      hashes[static_cast<std::size_t>(k)] = world.state_hash();
    }
    CHECK(hashes[0] == hashes[1]);
    CHECK(hashes[0] == hashes[2]);
  }

  TEST_CASE("a strength must be positive and finite") {
    World world = make_world(sleepless_space(8));
    for (const Real bad : {Real(0), Real(-1), kRigid, std::numeric_limits<Real>::quiet_NaN()}) {
      const Result<RopeId> rope = world.add_rope({.strength = bad});
      REQUIRE(!rope.has_value());
      CHECK(rope.error().where == "rope.strength");
    }
  }
}

}  // namespace hooke
