#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

/// \file
/// Cloths that loads stretch and whose springs are solved at once (solver/cloth/cloth_solution.h), at default
/// settings.

namespace hooke {

using namespace test;

namespace {

struct Stretch {
  double mean = 0, largest = 0;  ///< The worst of all steps but the first quarter [ratio].
  double energy = 0;             ///< Largest energy of all steps [J].
  std::uint32_t unconverged = 0;
};

Stretch watch(World& world, int steps) {
  Stretch worst;
  worst.energy = world.measure().energy.total();
  for (int i = 0; i < steps; ++i) {
    worst.unconverged += world.step(Real(1) / Real(60)).cloths_unconverged;
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
  cloth.solve_at_once = true;
  cloth.columns = cloth.rows = side;
  cloth.corner = {0, 2, 0};
  cloth.pins = {{0}, {static_cast<std::uint32_t>(side - 1)}};
  return cloth;
}

/// A flag of 0.2 kg whose first column is held.
ClothDesc flag() {
  ClothDesc cloth;
  cloth.solve_at_once = true;
  cloth.columns = 31;
  cloth.rows = 21;
  cloth.width = Real(1.5);
  cloth.corner = {0, 2, 0};
  cloth.total_mass = Real(0.2);
  for (std::uint32_t row = 0; row < 21; ++row) cloth.pins.push_back({31 * row});
  return cloth;
}

}  // namespace

TEST_SUITE("world/cloth_solution") {
  TEST_CASE("a square of 101 x 101 points on two corners stretches by 1 % at most, a row by 5 %") {
    World world = make_world();
    take(world.add_cloth(square(101)));
    const double start = world.measure().energy.total();
    const Stretch worst = watch(world, 120);
    CHECK(worst.mean < 0.01);
    CHECK(worst.largest < 0.05);
    CHECK(worst.energy < 1.02 * start);
    CHECK(worst.unconverged == 0);
  }

  TEST_CASE("stretch hardly depends on the number of points, and isometric bends change nothing of it") {
    for (const int side : {21, 41, 61}) {
      CAPTURE(side);
      World world = make_world();
      ClothDesc cloth = square(side);
      cloth.bend = ClothDesc::Bend::kIsometric;
      take(world.add_cloth(cloth));
      const Stretch worst = watch(world, 120);
      CHECK(worst.mean < 0.002);
      CHECK(worst.largest < 0.05);
    }
  }

  TEST_CASE("the cape of a runner at 4 m/s stretches by less than 5 %") {
    World world = make_world();
    ClothDesc cape;
    cape.solve_at_once = true;
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
    CHECK(watch(world, 180).largest < 0.05);
  }

  TEST_CASE("a square of stiff cloth hangs from its upper edge as far as its springs say") {
    World world = make_world(without_air());
    ClothDesc cloth = square(21);
    cloth.pins.clear();
    for (std::uint32_t i = 0; i < 21; ++i) cloth.pins.push_back({i});
    cloth.areal_density = Real(20);
    cloth.stretch_stiffness = Real(2e4);
    cloth.shear_stiffness = Real(0);
    cloth.damping = Real(20);
    const ClothId id = take(world.add_cloth(cloth));
    run(world, 600);
    // A column of 20 springs bears the weight of a strip of 1 / 20 m. Spring i bears that of the 20 - i whole
    // points and of the half one below it.
    const double point = 20 * kGravity / 400;
    double sag = 0;
    for (int i = 0; i < 20; ++i) sag += point * (19.5 - i) / 2e4;
    CHECK(2 - 1 - world.positions(id)[20 * 21 + 10].y == doctest::Approx(sag).epsilon(0.02));
  }

  TEST_CASE(
      "a load of 5 kg on a point of a flag of 0.2 kg with a limit of 5 % hardly goes beyond it while it "
      "swings") {
    World world = make_world();
    ClothDesc cloth = flag();
    cloth.extension_max = Real(0.05);
    cloth.damping = Real(5);
    cloth.loads = {{30 + 31 * 10, 5}};
    take(world.add_cloth(cloth));
    const double start = world.measure().energy.total();
    Stretch worst = watch(world, 300);
    CHECK(worst.energy < 1.2 * start);
    worst = watch(world, 300);
    CHECK(worst.largest < 0.12);
    CHECK(worst.mean < 0.02);
  }

  TEST_CASE("the bits are the same for any number of workers, and after a snapshot is restored") {
    std::uint64_t first = 0;
    for (const int workers : {1, 2, 3}) {
      WorldDesc desc;
      desc.workers = workers;
      World world = make_world(desc);
      take(world.add_cloth(square(61)));
      ClothDesc beside = square(11);
      beside.corner = {3, 2, 0};
      take(world.add_cloth(beside));
      run(world, 30);
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
