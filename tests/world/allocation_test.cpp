/// A step whose numbers (of contacts, islands, bundles) were all reached before allocates nothing. Each world
/// is restored and run twice from one snapshot, so that in the second run nothing is new; that one is
/// counted.

#include "hooke/scene_io.h"
#include "hooke/world.h"

#include "world/allocation_counter.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <doctest/doctest.h>
#include <string>
#include <vector>

namespace {

using namespace hooke;
using namespace test;

constexpr int kSteps = 60;
/// Steps of the second run that make anew what a restored world has not: trees of boxes, tables of rows.
constexpr int kStepsAfterRestore = 2;

/// What steps of the second run allocate, and how many hooks broke in them.
std::uint64_t count_allocations(World& world, Real dt, int* broken = nullptr) {
  const Snapshot start = world.snapshot();
  REQUIRE(world.restore(start).has_value());
  for (int i = 0; i < kSteps; ++i) world.step(dt);
  const std::uint64_t hash = world.state_hash();
  REQUIRE(world.restore(start).has_value());
  for (int i = 0; i < kStepsAfterRestore; ++i) world.step(dt);
  std::uint64_t count = 0;
  for (int i = kStepsAfterRestore; i < kSteps; ++i) {
    const AllocationCounter counter;
    world.step(dt);
    count += counter.count();
    if (broken != nullptr) *broken += static_cast<int>(world.broken_hooks().size());
  }
  CHECK(world.state_hash() == hash);  // the same states again
  REQUIRE(world.restore(start).has_value());
  return count;
}

/// The allocations of a scene from the step on that it has reached after `seconds`, by number of workers.
void check_scene(const std::string& name, double seconds = 0) {
  auto scene = load_scene(std::string(HOOKE_SCENES) + "/" + name + ".json");
  REQUIRE(scene);
  const Real dt = scene.value->dt;
  auto simulation = Simulation::create(std::move(*scene.value));
  REQUIRE(simulation);
  const int first = static_cast<int>(seconds / static_cast<double>(dt));
  for (int i = 0; i < first; ++i) simulation.value->step();
  World& world = simulation.value->world();
  for (const int workers : {1, 2}) {
    CAPTURE(name);
    CAPTURE(workers);
    REQUIRE(world.set_workers(workers).has_value());
    CHECK(count_allocations(world, dt) == 0);
  }
}

World make_world() {
  return std::move(World::create()).value();
}

BodyId add_ball(World& world, DVec3 position, bool is_static) {
  return world
      .add_body({.kind = is_static ? BodyKind::kStatic : BodyKind::kDynamic,
                 .shape = Shape::sphere(Real(0.05)),
                 .position = position})
      .value();
}

void hook_up(World& world, BodyId a, BodyId b, HookKind kind, int strength) {
  const HookDesc desc = {.kind = kind,
                         .a = {a},
                         .b = {b},
                         .anchor = 0.5 * (world.pose(a).position + world.pose(b).position),
                         .break_force = static_cast<Real>(strength)};
  REQUIRE(world.add_hook(desc).has_value());
}

/// Balls that are stuck to each other in a ring, at the last of which it hangs, by hooks too weak for them.
void hang_ring(World& world, DVec3 middle) {
  constexpr int kBalls = 12;
  std::vector<BodyId> balls;
  for (int i = 0; i < kBalls; ++i) {
    const double angle = (i + 0.5) * (2 * 3.14159265358979 / kBalls);
    balls.push_back(add_ball(world, middle + DVec3{std::cos(angle), std::sin(angle), 0}, i + 1 == kBalls));
  }
  for (int i = 0; i < kBalls; ++i)
    hook_up(world, balls[i], balls[(i + 1) % kBalls], HookKind::kFixed, 5 * (i + 1));
}

/// Balls in a square that hangs by its upper row, by hooks too weak for them.
void hang_net(World& world) {
  constexpr int kSide = 24;
  std::vector<BodyId> balls;
  for (int i = 0; i < kSide * kSide; ++i)
    balls.push_back(add_ball(world, {0.2 * (i % kSide), -0.2 * (i / kSide), 0}, i < kSide));
  for (int i = 0; i < kSide * kSide; ++i) {
    const int strength = 60 + i % 7;
    if (i >= kSide && i % kSide + 1 < kSide)
      hook_up(world, balls[i], balls[i + 1], HookKind::kBall, strength);
    if (i + kSide < kSide * kSide) hook_up(world, balls[i], balls[i + kSide], HookKind::kBall, strength);
  }
}

TEST_SUITE("world/allocation") {
  TEST_CASE("the counter sees all calls of operator new") {
    const AllocationCounter counter;
    const std::vector<int> usual(100);
    struct alignas(64) Line {
      std::byte bytes[64];
    };
    const std::vector<Line> aligned(3);
    // Compilers may leave out an allocation that nobody sees, and Clang does.
    const void* volatile seen = usual.data();
    CHECK(seen != nullptr);
    seen = aligned.data();
    CHECK(seen != nullptr);
    CHECK(counter.count() == 2);
  }

  TEST_CASE("stacks, heaps, hulls and meshes allocate nothing") {
    check_scene("stack_10");
    check_scene("card_house", 0.3);  // hard islands
    check_scene("dominoes_100", 2);  // fall asleep, are woken
    check_scene("arch_25");
    check_scene("hulls_on_mesh", 1);
  }

  TEST_CASE("fast bodies allocate nothing") {
    check_scene("tumbler", 1);
    check_scene("tippy_handle", 1);
    check_scene("pool_break");
    check_scene("wall_hit");
  }

  TEST_CASE("hooked bodies allocate nothing") {
    check_scene("door", 1);
    check_scene("plank_bridge", 1);
    check_scene("ragdoll_stairs", 1);
  }

  TEST_CASE("hooks that break allocate nothing") {
    check_scene("wrecking_ball", 1);  // trees
    // Rings are loops; the net is too large to be solved as one.
    World world = make_world();
    for (int k = 0; k < 3; ++k) hang_ring(world, {4.0 * k, 0, 5});
    hang_net(world);
    for (const int workers : {1, 2}) {
      REQUIRE(world.set_workers(workers).has_value());
      int broken = 0;
      CHECK(count_allocations(world, Real(1) / Real(60), &broken) == 0);
      CHECK(broken > 6);
    }
  }

  TEST_CASE("a net of hinges allocates nothing") {
    constexpr int kSide = 16;
    World world = make_world();
    std::vector<BodyId> bodies;
    for (int i = 0; i < kSide * kSide; ++i) {
      bodies.push_back(world
                           .add_body({.kind = i < kSide ? BodyKind::kStatic : BodyKind::kDynamic,
                                      .shape = Shape::box({Real(0.2), Real(0.05), Real(0.2)}),
                                      .position = {0.5 * (i % kSide), 5, 0.5 * (i / kSide)}})
                           .value());
    }
    const auto hinge = [&](int a, int b, Vec3 axis) {
      const DVec3 middle = 0.5 * (world.pose(bodies[a]).position + world.pose(bodies[b]).position);
      const HookDesc desc = {
          .kind = HookKind::kHinge, .a = {bodies[a]}, .b = {bodies[b]}, .anchor = middle, .axis = axis};
      REQUIRE(world.add_hook(desc).has_value());
    };
    for (int i = 0; i < kSide * kSide; ++i) {
      if (i >= kSide && i % kSide + 1 < kSide) hinge(i, i + 1, {Real(0), Real(0), Real(1)});
      if (i + kSide < kSide * kSide) hinge(i, i + kSide, {Real(1), Real(0), Real(0)});
    }
    for (const int workers : {1, 2}) {
      REQUIRE(world.set_workers(workers).has_value());
      CHECK(count_allocations(world, Real(1) / Real(60)) == 0);
    }
  }

  TEST_CASE("events and sensors allocate nothing") {
    World world = make_world();
    REQUIRE(world.add_body({.kind = BodyKind::kStatic, .shape = Shape::half_space()}).has_value());
    const Shape gate = Shape::box({Real(4), Real(0.2), Real(4)});
    REQUIRE(world.add_body({.kind = BodyKind::kStatic, .shape = gate, .position = {0, 1, 0}, .sensor = true})
                .has_value());
    for (int i = 0; i < 30; ++i) {
      BodyDesc ball = {.shape = Shape::sphere(Real(0.2)),
                       .position = {0.45 * (i % 5), 0.5 + 0.41 * (i / 5), 0.01 * i},
                       .reports_contacts = true,
                       .hit_speed = Real(0.1)};
      ball.contact.restitution = Real(0.8);
      REQUIRE(world.add_body(ball).has_value());
    }
    for (const int workers : {1, 2}) {
      REQUIRE(world.set_workers(workers).has_value());
      CHECK(count_allocations(world, Real(1) / Real(60)) == 0);
    }
  }

  TEST_CASE("ropes and what they are hooked to allocate nothing") {
    check_scene("hair_wind", 0.5);  // side by side
    check_scene("hanging_table");
    check_scene("crane", 1);
    check_scene("pulley");  // on bodies that turn
    check_scene("necklace", 1);
    check_scene("twisted_cable");
    check_scene("knot", 3);  // once it is tight
  }

  TEST_CASE("cloth allocates nothing") {
    check_scene("flag");
    check_scene("cloth_over_sphere", 0.5);
    check_scene("tablecloth", 0.3);  // bodies on it
    check_scene("curtain_rings");
    check_scene("squash_ball");  // with gas
  }

  TEST_CASE("contacts between points allocate nothing") {
    World world = make_world();
    const Shape ridge = Shape::box({Real(0.05), Real(0.3), Real(3)});
    REQUIRE(
        world.add_body({.kind = BodyKind::kStatic, .shape = ridge, .position = {0, -0.3, 0}}).has_value());
    for (int k = 0; k < 4; ++k) {
      const double z = 0.2 * k;
      REQUIRE(world
                  .add_rope({.points = {{-0.6, 0.03, z}, {-0.2, 0.03, z}, {0.2, 0.03, z}, {0.6, 0.03, z}},
                             .pins = {}})
                  .has_value());
    }
    ClothDesc cloth = {.columns = 5, .rows = 5, .corner = {-0.5, 0.5, -0.5}, .row_direction = {0, 0, 1}};
    cloth.pins = {{.point = 0}, {.point = 4}, {.point = 20}, {.point = 24}};
    REQUIRE(world.add_cloth(cloth).has_value());
    for (int k = 0; k < 3; ++k) {
      REQUIRE(world
                  .add_body({.kind = BodyKind::kDynamic,
                             .shape = Shape::box({Real(0.02), Real(0.02), Real(0.02)}),
                             .position = {0.15 * k - 0.1, 0.6, 0.13},
                             .mass = Real(0.01)})
                  .has_value());
    }
    for (int i = 0; i < 60; ++i) world.step(Real(1) / Real(60));
    for (const int workers : {1, 2}) {
      REQUIRE(world.set_workers(workers).has_value());
      CHECK(count_allocations(world, Real(1) / Real(60)) == 0);
    }
  }

  TEST_CASE("solids, plasticity and fields allocate nothing") {
    check_scene("jelly_cube", 0.3);
    check_scene("dents", 0.3);
    check_scene("matched_shapes", 0.3);
    check_scene("magnet");
    check_scene("buoyancy");
    check_scene("suction");
  }
}

}  // namespace
