#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

/// \file
/// Stiff cloth is held by tethers, at default settings (build/tethers.h).

namespace hooke {

using namespace test;

namespace {

struct Stretch {
  double mean = 0, largest = 0;  ///< The worst of all steps but the first quarter [ratio].
  double energy = 0;             ///< Largest energy of all steps [J].
};

Stretch watch(World& world, int steps) {
  Stretch worst;
  worst.energy = world.measure().energy.total();
  for (int i = 0; i < steps; ++i) {
    run(world, 1);
    const Measurement now = world.measure();
    worst.energy = std::max(worst.energy, now.energy.total());
    if (4 * i < steps) continue;
    worst.mean = std::max(worst.mean, now.mean_stretch);
    worst.largest = std::max(worst.largest, now.largest_stretch);
  }
  return worst;
}

ClothDesc square(int side) {
  ClothDesc cloth;
  cloth.columns = cloth.rows = side;
  cloth.corner = {0, 2, 0};
  return cloth;
}

ClothDesc square_on_corners(int side) {
  ClothDesc cloth = square(side);
  cloth.pins = {{0}, {static_cast<std::uint32_t>(side - 1)}};
  return cloth;
}

}  // namespace

TEST_SUITE("world/cloth_length") {
  TEST_CASE("a square of 101 x 101 points on two corners stretches by 1 % at most, an edge by 5 %") {
    World world = make_world();
    take(world.add_cloth(square_on_corners(101)));
    const double start = world.measure().energy.total();
    const Stretch worst = watch(world, 120);
    CHECK(worst.mean < 0.005);
    CHECK(worst.largest < 0.05);
    CHECK(worst.energy < 2 * start);
  }

  TEST_CASE("stretch hardly depends on the number of points, and rigid cloth hardly stretches") {
    for (const int side : {21, 41, 61}) {
      CAPTURE(side);
      World world = make_world();
      ClothDesc cloth = square_on_corners(side);
      cloth.bend = ClothDesc::Bend::kIsometric;
      cloth.stretch_stiffness = kRigid;
      take(world.add_cloth(cloth));
      const Stretch worst = watch(world, 120);
      CHECK(worst.mean < 0.004);
      CHECK(worst.largest < 0.04);
    }
  }

  TEST_CASE("the cape of a runner at 4 m/s stretches by less than 2 % on average") {
    World world = make_world();
    ClothDesc cape;
    cape.columns = 25;
    cape.rows = 41;
    cape.width = Real(0.6);
    cape.corner = {0, 1.5, 0};
    cape.column_direction = {0, 0, 1};
    for (std::uint32_t i = 0; i < 25; ++i) {
      PinDesc pin{i};
      pin.motion.kind = MotionDesc::Kind::kConstantVelocity;
      pin.motion.velocity = {4, 0, 0};
      cape.pins.push_back(pin);
    }
    take(world.add_cloth(cape));
    const Stretch worst = watch(world, 180);
    CHECK(worst.mean < 0.02);
    CHECK(worst.largest < 0.2);
  }

  TEST_CASE("soft cloth and cloth without tethers are left to their springs") {
    // Hung by one side, rubber of 100 N/m stretches by its weight below each row: m g / k in mean / 2.
    WorldDesc desc = without_air();
    desc.particle_substeps = 4;
    World world = make_world(desc);
    ClothDesc cloth = square(11);
    for (std::uint32_t i = 0; i < 11; ++i) cloth.pins.push_back({i});
    cloth.stretch_stiffness = Real(100);
    cloth.shear_stiffness = Real(0);
    cloth.areal_density = Real(1);
    cloth.damping = Real(0.5);
    const ClothId id = take(world.add_cloth(cloth));
    run(world, 600);
    const double point = kGravity / 100;
    double sag = 0;
    for (int i = 0; i < 10; ++i) sag += point * (9.5 - i) / 100;
    CHECK(2 - 1 - world.positions(id)[11 * 10 + 5].y == doctest::Approx(sag).epsilon(0.02));
  }

  TEST_CASE("a cloth that flies at 40 m/s is not held back by slack tethers") {
    WorldDesc desc = without_air();
    desc.gravity = {};
    World world = make_world(desc);
    ClothDesc cloth = square(11);
    cloth.pins = {{0}};
    cloth.bend = ClothDesc::Bend::kNone;
    const ClothId id = take(world.add_cloth(cloth));
    // The far corner is thrown over its pin: it is slack until it is 1.41 m away on the other side.
    REQUIRE(world.unpin(point(id, 0)));
    for (std::uint32_t i = 0; i < 121; ++i) REQUIRE(world.set_velocity(point(id, i), {0, 40, 0}));
    run(world, 1);
    REQUIRE(world.pin(point(id, 0)));
    run(world, 1);
    CHECK(d(world.velocities(id)[5].y) < 41);
    CHECK(d(world.velocities(id)[120].y) > 39.9);
  }

  TEST_CASE("the bits are the same for any number of workers, and after a snapshot is restored") {
    std::uint64_t first = 0;
    for (const int workers : {1, 2, 3}) {
      WorldDesc desc;
      desc.workers = workers;
      World world = make_world(desc);
      take(world.add_cloth(square_on_corners(61)));
      ClothDesc beside = square_on_corners(11);
      beside.corner = {3, 2, 0};
      const ClothId id = take(world.add_cloth(beside));
      run(world, 30);
      REQUIRE(world.pin(point(id, 115)));
      take(world.add_hook({.b = {.point = point(id, 120)}, .anchor = world.positions(id)[120]}));
      run(world, 5);
      const Snapshot snapshot = world.snapshot();
      run(world, 20);
      const std::uint64_t hash = world.state_hash();
      REQUIRE(world.restore(snapshot));
      run(world, 20);
      CHECK(world.state_hash() == hash);
      if (workers == 1) first = hash;
      CHECK(hash == first);
    }
  }
}

}  // namespace hooke
