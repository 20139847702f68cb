#include "build/tethers.h"
#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

/// \file
/// Heavy bodies on light cloth: what lies on particles is solved with them and with their tethers.

namespace hooke {

using namespace test;

namespace {

BodyDesc box_at(DVec3 position, Real mass, Vec3 half) {
  return {.kind = BodyKind::kDynamic,
          .shape = {.kind = ShapeKind::kBox, .half_extents = half},
          .position = position,
          .mass = mass};
}

/// A square sheet of 1.2 m across y = 0.
ClothDesc sheet(int side) {
  ClothDesc cloth;
  cloth.columns = cloth.rows = side;
  cloth.corner = {-0.6, 0, -0.6};
  cloth.width = cloth.height = Real(1.2);
  cloth.row_direction = {0, 0, 1};
  cloth.damping = Real(1);
  return cloth;
}

}  // namespace

TEST_SUITE("world/cloth_under_load") {
  TEST_CASE("tethered cloth of 0.3 kg carries what is ten thousand times as heavy, and it lies still") {
    for (const Real mass : {Real(0.3), Real(30), Real(300), Real(3000)}) {
      CAPTURE(mass);
      WorldDesc desc = without_air();
      desc.particle_substeps = 2;
      World world = make_world(desc);
      ClothDesc cloth = sheet(25);
      cloth.areal_density = Real(0.2);
      cloth.tethers = true;
      for (std::uint32_t i = 0; i < 25; ++i) {
        cloth.pins.push_back({i});
        cloth.pins.push_back({600 + i});
      }
      take(world.add_cloth(cloth));
      const BodyId box =
          take(world.add_body(box_at({0.01, 0.2, -0.02}, mass, {Real(0.2), Real(0.15), Real(0.2)})));
      double highest = 0;
      for (int i = 0; i < 240; ++i) {
        run(world, 1);
        if (i > 60) highest = std::max(highest, world.center_of_mass(box).y);
      }
      CHECK(world.center_of_mass(box).y > 0.15 - (mass < 1000 ? 0.015 : 0.05));
      CHECK(highest < 0.16);
      CHECK(d(length(world.velocity(box))) < (mass < 1000 ? 5e-3 : 0.05));
    }
  }

  TEST_CASE("a slab slides down a slope on cloth that sticks to it, by the slab's own friction") {
    const double slope = std::atan(0.4);
    WorldDesc desc = without_air();
    desc.gravity = {Real(kGravity * std::sin(slope)), Real(-kGravity * std::cos(slope)), 0};
    desc.particle_substeps = 4;
    World world = make_world(desc);
    take(world.add_body({.shape = {.kind = ShapeKind::kHalfSpace}, .contact = {.friction = 2}}));
    ClothDesc cloth = sheet(31);
    cloth.corner.y = 0.0021;
    cloth.contact.friction = Real(0.5);
    take(world.add_cloth(cloth));
    BodyDesc slab = box_at({-0.35, 0.0251, 0}, 5, {Real(0.15), Real(0.02), Real(0.15)});
    slab.contact.friction = Real(0.08);  // 0.2 against the cloth, which has 1 against the slope
    const BodyId id = take(world.add_body(slab));
    run(world, 45);
    const double t = 0.75;
    const double way = 0.5 * kGravity * (std::sin(slope) - 0.2 * std::cos(slope)) * t * t;
    CHECK(world.center_of_mass(id).x + 0.35 == doctest::Approx(way).epsilon(0.05));
    CHECK(world.center_of_mass(id).y == doctest::Approx(0.024).epsilon(0.03));
  }

  TEST_CASE("two slabs that clap a cloth between them in empty space stop, and momentum stays") {
    WorldDesc desc = empty_space();
    desc.particle_substeps = 2;
    World world = make_world(desc);
    take(world.add_cloth(sheet(17)));
    const Vec3 half = {Real(0.3), Real(0.05), Real(0.2)};
    BodyDesc above = box_at({0.05, 0.3, 0.02}, 2, half);
    BodyDesc below = box_at({0, -0.3, 0}, 2, half);
    above.velocity = {0, -1, 0};
    below.velocity = {Real(0.25), 1, 0};
    const BodyId a = take(world.add_body(above));
    const BodyId b = take(world.add_body(below));
    const Measurement before = world.measure();
    run(world, 60);
    const Measurement after = world.measure();
    CHECK(length(after.momentum - before.momentum) < 1e-5 * 2);
    CHECK(length(after.angular_momentum - before.angular_momentum) < 1e-4);
    CHECK(std::abs(d(world.velocity(a).y - world.velocity(b).y)) < 0.02);
    CHECK(world.center_of_mass(a).y - world.center_of_mass(b).y == doctest::Approx(0.104).epsilon(0.02));
  }

  TEST_CASE("a ball of 0.5 to 400 kg that falls on a pinned cloth of 0.2 kg stays on it, by default") {
    for (const bool corners : {false, true}) {
      for (const Real mass : {Real(0.5), Real(4), Real(400)}) {
        CAPTURE(corners);
        CAPTURE(mass);
        World world = make_world();
        ClothDesc cloth = {.columns = 21, .rows = 21, .corner = {-0.5, 1, -0.5}, .row_direction = {0, 0, 1}};
        for (std::uint32_t i = 0; i < 21; i += corners ? 20 : 1) {
          cloth.pins.push_back({i});
          cloth.pins.push_back({420 + i});
        }
        take(world.add_cloth(cloth));
        const BodyId ball = take(world.add_body({.kind = BodyKind::kDynamic,
                                                 .shape = Shape::sphere(Real(0.1)),
                                                 .position = {0.02, 1.3, 0.01},
                                                 .mass = mass}));
        const double energy = world.measure().energy.total();
        for (int i = 0; i < 180; ++i) {
          run(world, 1);
          CHECK(world.measure().energy.total() < energy + 0.4);
        }
        // A sheet that does not stretch bears the ball 0.1 m above its pins.
        CHECK(world.center_of_mass(ball).y > 1.02);
        CHECK(world.center_of_mass(ball).y < 1.1);
        CHECK(d(length(world.velocity(ball))) < 0.02);
      }
    }
  }

  TEST_CASE("cloth between two sides has tethers to both, cloth at one side to that one") {
    std::vector<DVec3> points;
    std::vector<geometry::Triangle> triangles;
    for (std::uint32_t row = 0; row < 12; ++row) {
      for (std::uint32_t column = 0; column < 12; ++column) {
        points.push_back({0.1 * column, 0, 0.1 * row});
        const std::uint32_t at = 12 * row + column;
        if (row < 11 && column < 11) {
          triangles.push_back({at, at + 12, at + 1});
          triangles.push_back({at + 1, at + 12, at + 13});
        }
      }
    }
    const geometry::MeshTopology topology = geometry::compute_topology(points.size(), triangles);
    std::vector<std::uint32_t> pins;
    for (std::uint32_t i = 0; i < 12; ++i) pins.push_back(i);
    const build::TetherSurface surface = {points, triangles, topology, true};
    const std::vector<build::Tether> one = build::find_tethers(surface, pins);
    for (const build::Tether& tether : one) CHECK(tether.pin < 12);
    for (std::uint32_t i = 0; i < 12; ++i) pins.push_back(132 + i);
    const std::vector<build::Tether> both = build::find_tethers(surface, pins);
    std::vector<int> count(144, 0);
    std::vector<double> to_first(144, 9), to_second(144, 9);
    for (const build::Tether& tether : both) {
      ++count[tether.point];
      double& nearest = tether.pin < 12 ? to_first[tether.point] : to_second[tether.point];
      nearest = std::min(nearest, d(tether.length));
      CHECK(d(tether.length) == doctest::Approx(length(points[tether.point] - points[tether.pin])));
    }
    for (std::uint32_t i = 12; i < 132; ++i) {
      CHECK(count[i] == 4);
      const double row = i / 12;  // NOLINT(bugprone-integer-division): rows are whole.
      CHECK(std::min(to_first[i], to_second[i]) == doctest::Approx(0.1 * std::min(row, 11 - row)));
      CHECK(std::max(to_first[i], to_second[i]) < 1.2);
    }
  }
}

}  // namespace hooke
