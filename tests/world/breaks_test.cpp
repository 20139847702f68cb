/// Hooks that break: what they take until then, who breaks first, and what they leave to others.

#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr int kSubsteps[] = {4, 8, 32};
constexpr double kStep = 1.0 / 60;

BodyId add_box(World& world, DVec3 position, double mass, Vec3 velocity, double half = 0.1) {
  const Real side = static_cast<Real>(half);
  return take(world.add_body({.kind = BodyKind::kDynamic,
                              .shape = Shape::box({side, side, side}),
                              .position = position,
                              .velocity = velocity,
                              .mass = static_cast<Real>(mass)}));
}

/// A hook of `kind` at the middle of a body at `place`, which can take `force`.
HookDesc hook_at(HookKind kind, BodyId body, DVec3 place, double force) {
  HookDesc desc = {
      .kind = kind, .b = {.body = body}, .anchor = place, .break_force = static_cast<Real>(force)};
  if (kind == HookKind::kHinge) desc.axis = {0, 0, 1};
  if (kind != HookKind::kDistance) return desc;
  desc.anchor = place - DVec3{2, 0, 0};
  desc.anchor_b = place;
  desc.limits = {.upper = Real(2)};
  return desc;
}

double kinetic(const World& world) {
  return world.measure().energy.kinetic;
}

}  // namespace

TEST_SUITE("world/breaks") {
  TEST_CASE("a hook that breaks pulls with its strength for one substep, whatever its kind") {
    for (const int substeps : kSubsteps) {
      for (const HookKind kind : {HookKind::kBall, HookKind::kHinge, HookKind::kFixed, HookKind::kDistance}) {
        World world = make_world(sleepless_space(substeps));
        const BodyId box = add_box(world, {1, 2, 3}, 3, {15, 0, 0});
        const HookId hook = take(world.add_hook(hook_at(kind, box, {1, 2, 3}, 40)));
        run(world, 1);
        const double h = kStep / substeps;
        CHECK(3 * (15 - d(world.velocity(box).x)) == doctest::Approx(40 * h).epsilon(0.01));
        REQUIRE(world.events().breaks.size() == 1);
        const BreakEvent& event = world.events().breaks.front();
        CHECK(event.hook == hook);
        CHECK(event.time == doctest::Approx(h));
        CHECK(d(event.force) == doctest::Approx(3 * 15 / h).epsilon(0.01));
        run(world, 1);
        CHECK(world.events().breaks.empty());
      }
    }
  }

  TEST_CASE("a weld that breaks by torque slows a rotation by its strength times one substep") {
    for (const int substeps : kSubsteps) {
      World world = make_world(sleepless_space(substeps));
      const BodyId box = add_box(world, {}, 6, {}, 0.5);  // I = 6 / 6 kg m^2
      REQUIRE(world.set_angular_velocity(box, {0, 9, 0}).has_value());
      take(world.add_hook({.kind = HookKind::kFixed, .b = {.body = box}, .break_torque = 50}));
      run(world, 1);
      CHECK(9 - d(world.angular_velocity(box).y) == doctest::Approx(50 * kStep / substeps).epsilon(0.01));
      REQUIRE(world.events().breaks.size() == 1);
      CHECK(d(world.events().breaks.front().torque) == doctest::Approx(9 * substeps / kStep).epsilon(0.01));
    }
  }

  TEST_CASE("a motor that is stronger than its hinge breaks it, and then turns nothing") {
    World world = make_world(sleepless_space(8));
    const BodyId wheel = add_box(world, {}, 6, {}, 0.5);
    take(world.add_hook({.kind = HookKind::kHinge,
                         .b = {.body = wheel},
                         .axis = {0, 0, 1},
                         .motor = {.speed = 100, .max_force = 30},
                         .break_torque = 20}));
    run(world, 60);
    CHECK(d(world.angular_velocity(wheel).z) <= 20 * kStep / 8 * 1.01);
    CHECK(d(world.angular_velocity(wheel).z) > 0);
  }

  TEST_CASE(
      "a ball that breaks a pane off four weak hooks loses what the pane gains and what the hooks take") {
    for (const int substeps : kSubsteps) {
      WorldDesc desc = sleepless_space(substeps);
      World world = make_world(desc);
      const BodyId pane = take(world.add_body({.kind = BodyKind::kDynamic,
                                               .shape = Shape::box({Real(0.01), Real(0.4), Real(0.6)}),
                                               .position = {1, 0, 0},
                                               .mass = Real(0.3)}));
      for (const double y : {-0.4, 0.4}) {
        for (const double z : {-0.6, 0.6})
          take(world.add_hook(hook_at(HookKind::kFixed, pane, {1, y, z}, 12)));
      }
      const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                               .shape = Shape::sphere(Real(0.1)),
                                               .velocity = {16, 0, 0},
                                               .mass = 2,
                                               .bullet = true}));
      std::size_t broken = 0;
      for (int i = 0; i < 30; ++i) {
        run(world, 1);
        broken += world.events().breaks.size();
      }
      CHECK(broken == 4);
      const double free = 2 * 16 / 2.3;
      CHECK(d(world.velocity(ball).x) < 1.001 * free);
      CHECK(d(world.velocity(ball).x) > free - 4 * 12 * kStep / substeps / 2.3 - 0.02);
    }
  }

  TEST_CASE("a cord pulls with its strength for one substep and breaks, and its load falls on") {
    for (const int substeps : kSubsteps) {
      WorldDesc desc = without_air();
      desc.substeps = substeps;
      World world = make_world(desc);
      const BodyId load = add_box(world, {}, 7, {});
      take(world.add_hook({.kind = HookKind::kDistance,
                           .b = {.body = load},
                           .anchor = {0, 1, 0},
                           .anchor_b = DVec3{0, 0, 0},
                           .limits = {.upper = Real(1.4)},
                           .break_force = 300}));
      for (int i = 0; i < 60; ++i) {
        run(world, 1);
        if (!world.events().breaks.empty()) break;
      }
      REQUIRE(world.events().breaks.size() == 1);
      const double taken = 7 * (d(world.velocity(load).y) + kGravity * world.time());
      CHECK(taken == doctest::Approx(300 * kStep / substeps).epsilon(0.01));
    }
  }

  TEST_CASE("a tow rope pulls its load with no more than the strength of its hook") {
    for (const int substeps : kSubsteps) {
      World world = make_world(sleepless_space(substeps));
      const BodyId truck = take(world.add_body(
          {.kind = BodyKind::kKinematic, .shape = Shape::box({Real(0.2), Real(0.2), Real(0.2)})}));
      const BodyId load = add_box(world, {3, 0, 0}, 30, {});
      RopeDesc desc = {.total_mass = Real(0.4), .pins = {}};
      for (int i = 0; i <= 8; ++i) desc.points.push_back({0.3 + 0.3 * i, 0, 0});
      const RopeId rope = take(world.add_rope(desc));
      take(world.add_hook(
          {.a = {.body = truck}, .b = {.point = point(rope, 0)}, .anchor = {0.3, 0, 0}, .break_force = 120}));
      take(world.add_hook({.a = {.body = load}, .b = {.point = point(rope, 8)}, .anchor = {2.7, 0, 0}}));
      REQUIRE(world.set_velocity(truck, {-3, 0, 0}).has_value());
      run(world, 1);
      REQUIRE(world.events().breaks.size() == 1);
      CHECK(world.events().breaks.front().time == doctest::Approx(kStep / substeps));
      const DVec3 given = world.measure().momentum;  // of the load and the rope; the truck is driven
      CHECK(given.x == doctest::Approx(-120 * kStep / substeps).epsilon(0.01));
      CHECK(d(world.velocity(load).x) <= 1e-6);
    }
  }

  TEST_CASE("of a chain that is pulled the weakest hook breaks, and the others hold") {
    for (const bool loop : {false, true}) {
      for (const bool roped : {false, true}) {
        World world = make_world(sleepless_space(8));
        std::vector<BodyId> links;
        for (int i = 0; i < 5; ++i) links.push_back(add_box(world, {0.3 * i, 0, 0}, 1, {}));
        HookId weakest;
        for (int i = 0; i < 4; ++i) {
          const double strength = i == 1 ? 50 : 60 + 5 * i;
          const DVec3 place = {0.3 * i + 0.15, 0, 0};
          for (const double z : {-0.1, 0.1}) {
            if (!loop && z > 0) continue;
            const HookId hook = take(world.add_hook({.kind = HookKind::kFixed,
                                                     .a = {.body = links[static_cast<std::size_t>(i)]},
                                                     .b = {.body = links[static_cast<std::size_t>(i) + 1]},
                                                     .anchor = place + DVec3{0, 0, loop ? z : 0},
                                                     .break_force = static_cast<Real>(strength)}));
            if (i == 1) weakest = hook;
          }
        }
        if (roped) {
          const RopeId rope = take(world.add_rope(
              {.total_mass = Real(0.1), .points = {{0, 0.1, 0}, {0, 0.3, 0}, {0, 0.5, 0}}, .pins = {}}));
          take(world.add_hook(
              {.a = {.body = links[0]}, .b = {.point = point(rope, 0)}, .anchor = {0, 0.1, 0}}));
        }
        REQUIRE(world.set_velocity(links[4], {20, 0, 0}).has_value());
        REQUIRE(world.set_velocity(links[0], {-20, 0, 0}).has_value());
        const double energy = kinetic(world);
        run(world, 1);
        const std::vector<BreakEvent>& breaks = world.events().breaks;
        REQUIRE(!breaks.empty());
        CHECK(std::any_of(breaks.begin(), breaks.end(), [&](const BreakEvent& e) {
          return e.hook == weakest && e.time == breaks.front().time;
        }));
        CHECK(kinetic(world) <= 1.0001 * energy);
        // The blow that each end can pass on to its neighbor before its own hook breaks.
        CHECK(d(world.velocity(links[4]).x) > 20 - 2 * (loop ? 2 : 1) * 75 * kStep);
      }
    }
  }

  TEST_CASE("hooks that take a load in turn break in order of time, the same for any number of workers") {
    std::vector<double> times[2];
    std::uint64_t hashes[2] = {};
    for (const int k : {0, 1}) {
      WorldDesc desc = without_air();
      desc.workers = k == 0 ? 1 : 3;
      World world = make_world(desc);
      std::vector<HookId> hooks;
      for (int i = 0; i < 6; ++i) {
        const BodyId load = add_box(world, {2.0 * i, -0.3 * i, 0}, 4, {});
        hooks.push_back(take(world.add_hook({.kind = HookKind::kDistance,
                                             .b = {.body = load},
                                             .anchor = {2.0 * i, 1 - 0.3 * i, 0},
                                             .anchor_b = DVec3{2.0 * i, -0.3 * i, 0},
                                             .limits = {.upper = Real(2.2 - 0.2 * i)},
                                             .break_force = 200})));
      }
      for (int i = 0; i < 60; ++i) {
        run(world, 1);
        for (const BreakEvent& event : world.events().breaks) {
          times[k].push_back(event.time);
          CHECK(event.hook == hooks[6 - times[k].size()]);
        }
      }
      hashes[k] = world.state_hash();
    }
    REQUIRE(times[0].size() == 6);
    CHECK(std::is_sorted(times[0].begin(), times[0].end()));
    CHECK(times[0] == times[1]);
    CHECK(hashes[0] == hashes[1]);
    // The shortest fall is 0.2 m.
    CHECK(times[0].front() == doctest::Approx(std::sqrt(2 * 0.2 / kGravity)).epsilon(0.02));
  }

  TEST_CASE("a wall of bricks that are glued loses energy only, as it is shot through") {
    for (const bool coupled : {false, true}) {
      World world = make_world(sleepless_space(8));
      std::vector<BodyId> bricks;
      for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) bricks.push_back(add_box(world, {0.2 * x, 0.2 * y, 0}, 1, {}));
      }
      const auto glue = [&](std::size_t a, std::size_t b) {
        take(world.add_hook(
            {.kind = HookKind::kFixed,
             .a = {.body = bricks[a]},
             .b = {.body = bricks[b]},
             .anchor = 0.5 * (world.center_of_mass(bricks[a]) + world.center_of_mass(bricks[b])),
             .break_force = 400,
             .break_torque = 30}));
      };
      for (std::size_t i = 0; i < 16; ++i) {
        if (i % 4 < 3) glue(i, i + 1);
        if (i < 12) glue(i, i + 4);
      }
      if (coupled) {
        const RopeId rope =
            take(world.add_rope({.total_mass = Real(0.05),
                                 .points = {{0, 0.7, 0}, {0, 0.9, 0}, {0, 1.1, 0}, {0, 1.3, 0}},
                                 .pins = {}}));
        take(world.add_hook(
            {.a = {.body = bricks[12]}, .b = {.point = point(rope, 0)}, .anchor = {0, 0.7, 0}}));
      }
      add_box(world, {0.33, 0.27, -0.5}, 3, {0, 0, 25}, 0.05);
      double most = kinetic(world);
      std::size_t broken = 0;
      for (int i = 0; i < 60; ++i) {
        run(world, 1);
        broken += world.events().breaks.size();
        const double energy = kinetic(world);
        CHECK(energy <= 1.002 * most);
        most = std::min(most, energy);
      }
      CHECK(broken >= 4);
    }
  }
}

}  // namespace hooke
