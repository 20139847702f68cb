#include "hooke/world.h"

#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// Asleep, nothing shows whether it holds.
WorldDesc awake() {
  WorldDesc desc = without_air();
  desc.sleeping = false;
  return desc;
}

BodyId add_box(World& world, DVec3 position, Vec3 half, double mass, double restitution = 0) {
  BodyDesc desc{.kind = BodyKind::kDynamic,
                .shape = Shape::box(half),
                .position = position,
                .mass = static_cast<Real>(mass)};
  desc.contact.friction = Real(0.6);
  desc.contact.restitution = static_cast<Real>(restitution);
  return take(world.add_body(desc));
}

/// A table top of 1 m by 1 m with four legs of 1 kg and 1 m that are glued under it. Their feet are at
/// `floor`.
BodyId add_table(World& world, double floor, double mass) {
  const BodyId top = add_box(world, {0, floor + 1.05, 0}, {Real(0.5), Real(0.05), Real(0.5)}, mass);
  constexpr std::array kPlaces = {DVec3{-0.41, 0, -0.43}, DVec3{-0.38, 0, 0.42}, DVec3{0.43, 0, -0.37},
                                  DVec3{0.39, 0, 0.41}};
  for (const DVec3& place : kPlaces) {
    const BodyId leg =
        add_box(world, place + DVec3{0, floor + 0.5, 0}, {Real(0.05), Real(0.5), Real(0.05)}, 1);
    take(world.add_hook({.kind = HookKind::kFixed,
                         .a = {.body = top},
                         .b = {.body = leg},
                         .anchor = place + DVec3{0, floor + 1, 0}}));
  }
  return top;
}

/// A square of 2.4 m whose vertices stand 2 cm up in turn.
MeshId add_bumps(World& world) {
  constexpr std::uint32_t kSide = 13;
  MeshDesc mesh;
  for (std::uint32_t j = 0; j < kSide; ++j) {
    for (std::uint32_t i = 0; i < kSide; ++i)
      mesh.positions.push_back(
          {Real(0.2) * (Real(i) - Real(6)), Real(0.02) * Real((i + j) % 2), Real(0.2) * (Real(j) - Real(6))});
  }
  for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
    for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
      const std::uint32_t a = j * kSide + i;
      const std::uint32_t c = a + kSide;
      const bool even = (i + j) % 2 == 0;
      mesh.triangles.push_back(even ? std::array{a, c, c + 1} : std::array{a, c, a + 1});
      mesh.triangles.push_back(even ? std::array{a, c + 1, a + 1} : std::array{a + 1, c, c + 1});
    }
  }
  return take(world.add_mesh(mesh));
}

double height_of(const World& world, BodyId body) {
  return world.pose(body).position.y;
}

}  // namespace

/// Scenes at the border between two ways of the solver. What is asked is a sink of less than 0.1 % of the
/// size.
TEST_SUITE("world/coupled_contacts") {
  TEST_CASE("a table of any weight stands on thin legs on a loose board") {
    for (const double mass : {100.0, 1e3, 1e4}) {
      CAPTURE(mass);
      World world = make_world(awake());
      take(world.add_body({.shape = Shape::half_space()}));
      const BodyId board = add_box(world, {0, 0.05, 0}, {Real(0.8), Real(0.05), Real(0.8)}, 50);
      const BodyId top = add_table(world, 0.1, mass);
      run(world, 120);
      CHECK(height_of(world, board) == doctest::Approx(0.05).epsilon(0.001));
      CHECK(height_of(world, top) == doctest::Approx(1.15).epsilon(1e-4));
      CHECK(world.measure().largest_penetration < 1e-4);
    }
  }

  TEST_CASE("a heavy table stands on thin legs on a board that lies on a tower, and makes no energy") {
    World world = make_world(awake());
    take(world.add_body({.shape = Shape::half_space()}));
    for (int i = 0; i < 4; ++i) add_box(world, {0, 0.5 + i, 0}, {Real(0.5), Real(0.5), Real(0.5)}, 20);
    const BodyId board = add_box(world, {0, 4.05, 0}, {Real(0.8), Real(0.05), Real(0.8)}, 50);
    const BodyId top = add_table(world, 4.1, 2000);
    run(world, 180);
    CHECK(height_of(world, board) == doctest::Approx(4.05).epsilon(1e-4));
    CHECK(height_of(world, top) == doctest::Approx(5.15).epsilon(1e-4));
    CHECK(world.measure().largest_penetration < 1e-4);
    CHECK(world.measure().energy.kinetic < 1e-3);
  }

  TEST_CASE("a table of any weight stands on thin legs on a ground of triangles") {
    for (const double mass : {100.0, 1e3, 1e4}) {
      CAPTURE(mass);
      World world = make_world(awake());
      take(world.add_body({.shape = Shape::of_mesh(add_bumps(world))}));
      const BodyId top = add_table(world, 0.02, mass);
      run(world, 180);
      // A foot may slip from a bump into the hollow beside it, by 2 cm at most, but not into the ground.
      CHECK(height_of(world, top) > 1.049);
      CHECK(world.measure().largest_penetration < 1e-3);
    }
  }

  TEST_CASE("crates stand on rollers, however many there are") {
    for (const double restitution : {0.0, 0.01}) {
      CAPTURE(restitution);
      World world = make_world(awake());
      take(world.add_body({.shape = Shape::half_space()}));
      std::vector<BodyId> crates;
      for (int i = 0; i < 12; ++i) {
        const double z = 1.5 * i;
        for (const double x : {-0.3, 0.3}) {
          const BodyId roller = take(world.add_body({.kind = BodyKind::kDynamic,
                                                     .shape = Shape::sphere(Real(0.1)),
                                                     .position = {x, 1, z},
                                                     .mass = Real(1)}));
          take(world.add_hook(
              {.kind = HookKind::kHinge, .b = {.body = roller}, .anchor = {x, 1, z}, .axis = {0, 0, 1}}));
        }
        crates.push_back(add_box(world, {0, 1.25, z}, {Real(0.5), Real(0.15), Real(0.5)}, 500, restitution));
      }
      run(world, 120);
      for (const BodyId crate : crates) CHECK(height_of(world, crate) == doctest::Approx(1.25).epsilon(1e-4));
      CHECK(world.measure().largest_gap < 1e-4);
    }
  }

  TEST_CASE("what is hooked inside a wall strains against it and gains no energy") {
    World world = make_world(awake());
    take(world.add_body({.shape = Shape::half_space()}));
    // The hook holds the middle of a ball 0.1 m in the ground, and what lies on it is ten times as heavy.
    const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                             .shape = Shape::sphere(Real(0.2)),
                                             .position = {0, -0.1, 0},
                                             .mass = Real(1)}));
    take(world.add_hook({.b = {.body = ball}, .anchor = {0.1, -0.1, 0}}));
    const BodyId load = add_box(world, {0.05, 0.3, 0}, {Real(0.2), Real(0.2), Real(0.2)}, 10);
    double fastest = 0;
    for (int i = 0; i < 240; ++i) {
      REQUIRE(world.step(Real(1) / Real(60)).healthy());
      for (const BodyId body : {ball, load}) fastest = std::max(fastest, d(length(world.velocity(body))));
    }
    CHECK(fastest < 2);
  }

  TEST_CASE("a rope that ends where two beams meet is carried, and does not strain against the second beam") {
    for (const HookKind joint : {HookKind::kFixed, HookKind::kHinge}) {
      CAPTURE(static_cast<int>(joint));
      World world = make_world(awake());
      const BodyId post = add_box(world, {0, 1, 0}, {Real(0.03), Real(1), Real(0.03)}, 4);
      const BodyId beam = add_box(world, {0.4, 2.02, 0}, {Real(0.5), Real(0.02), Real(0.03)}, 2);
      // What is fixed to the second beam lies about the end of the rope, too.
      const BodyId collar = add_box(world, {0, 2, 0}, {Real(0.05), Real(0.05), Real(0.05)}, 1);
      take(world.add_hook({.kind = HookKind::kFixed, .b = {.body = post}, .anchor = {0, 0, 0}}));
      take(world.add_hook(
          {.kind = joint, .a = {.body = post}, .b = {.body = beam}, .anchor = {0, 2, 0}, .axis = {0, 1, 0}}));
      take(world.add_hook(
          {.kind = HookKind::kFixed, .a = {.body = beam}, .b = {.body = collar}, .anchor = {0, 2, 0}}));
      RopeDesc desc{.total_mass = Real(0.5), .pins = {}, .radius = Real(0.006)};
      for (int i = 0; i < 6; ++i) desc.points.push_back({0.031, 2 - 0.1 * i, 0});
      const RopeId rope = take(world.add_rope(desc));
      const HookId hook = take(
          world.add_hook({.a = {.body = post}, .b = {.point = point(rope, 0)}, .anchor = {0.031, 2, 0}}));
      run(world, 240);
      CHECK(world.hook_force(hook).force.y == doctest::Approx(0.5 * kGravity).epsilon(0.01));
      CHECK(length(world.hook_force(hook).force) < 0.6 * kGravity);
      CHECK(world.hook_gap(hook) < 1e-5);
    }
  }
}

}  // namespace hooke
