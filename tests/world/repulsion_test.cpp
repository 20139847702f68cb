/// Ropes that keep their points apart by s (1 / d^2 - 1 / r^2): statics, momentum, energy, who is left out.

#include "elements/repulsion.h"

#include "hooke/world.h"

#include "world/make.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr double kRange = 0.05;     // [m]
constexpr double kStrength = 1e-4;  // [N m^2]

RopeDesc repelling(std::vector<DVec3> points, double mass) {
  RopeDesc desc;
  desc.points = std::move(points);
  desc.total_mass = static_cast<Real>(mass);
  desc.pins = {};
  desc.repulsion_strength = static_cast<Real>(kStrength);
  desc.repulsion_range = static_cast<Real>(kRange);
  return desc;
}

/// Two points 1 m apart, too far to push each other.
RopeDesc rod(DVec3 start, double mass) {
  return repelling({start, start + DVec3{1, 0, 0}}, mass);
}

/// A tuft of strands, their roots held, leaning against each other.
void add_tuft(World& world, double strength) {
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      std::vector<DVec3> points;
      for (int j = 0; j < 12; ++j) points.push_back({0.012 * i + 0.002 * k, 0.02 * j, 0.012 * k - 0.001 * j});
      RopeDesc desc = repelling(points, 0.001);
      desc.repulsion_range = Real(0.02);
      desc.repulsion_strength = static_cast<Real>(strength);
      desc.bend_stiffness = Real(1e-6);
      desc.pins = {{.point = 0}, {.point = 1}};
      take(world.add_rope(desc));
    }
  }
}

}  // namespace

TEST_CASE_TEMPLATE("repulsion: the distance after a substep solves its equation, and is never out of range",
                   T, float, double) {
  const T range = T(0.05);
  const T close = sizeof(T) == 4 ? T(2e-4) : T(1e-5);
  for (const T free : {T(-1e3), T(-0.2), T(-1e-5), T(0), T(1e-6), T(0.01), T(0.03), T(0.0499)}) {
    for (const T a : {T(1e-16), T(1e-12), T(1e-9), T(1e-6), T(1e-3), T(1)}) {
      CAPTURE(free);
      CAPTURE(a);
      const T y = elements::repelled_distance(free, a, range);
      CHECK(y > T(0));
      CHECK(y <= range);
      // The residual, over the slope of the equation, is the error of y.
      const T residual = y - free - elements::repulsion_force(a, range, y);
      CHECK(std::abs(residual) < close * y * (1 + 2 * a / (y * y * y)));
    }
  }
}

TEST_CASE("repulsion: the force is the slope of the energy, and both are zero out of range") {
  for (const double x : {0.002, 0.01, 0.03, 0.049}) {
    const double step = 1e-6;
    const double slope = (elements::repulsion_energy(kStrength, kRange, x + step) -
                          elements::repulsion_energy(kStrength, kRange, x - step)) /
                         (2 * step);
    CHECK(elements::repulsion_force(kStrength, kRange, x) == doctest::Approx(-slope).epsilon(1e-4));
  }
  CHECK(elements::repulsion_force(kStrength, kRange, kRange) == 0);
  CHECK(elements::repulsion_energy(kStrength, kRange, 1.1 * kRange) == 0);
}

TEST_CASE("repulsion: a rod over a held one floats where the force is its weight") {
  constexpr double kMass = 0.02;
  WorldDesc desc = without_air();
  World world = make_world(desc);
  RopeDesc held = rod({}, 1);
  held.pins = {{.point = 0}, {.point = 1}};
  take(world.add_rope(held));
  const RopeId floating = take(world.add_rope(rod({0, 0.04, 0}, kMass)));
  run(world, 600);
  const double weight = 0.5 * kMass * 9.80665;
  const double gap = 1 / std::sqrt(weight / kStrength + 1 / (kRange * kRange));
  CHECK(world.positions(floating)[0].y == doctest::Approx(gap).epsilon(1e-3));
  CHECK(world.positions(floating)[1].y == doctest::Approx(gap).epsilon(1e-3));
  CHECK(length(world.velocities(floating)[0]) < 1e-3);
}

TEST_CASE("repulsion: rods that collide bounce, keep momentum, gain no energy and do not pass") {
  for (const double speed : {0.2, 1.0, 5.0}) {
    CAPTURE(speed);
    World world = make_world(empty_space());
    RopeDesc low = rod({}, 0.02);
    // Fast ones slip past each other sideways where they may.
    RopeDesc high = rod(speed < 2 ? DVec3{0.004, 0.08, 0.003} : DVec3{0, 0.08, 0}, 0.05);
    high.velocity = {Real(0), static_cast<Real>(-speed), Real(0)};
    const RopeId a = take(world.add_rope(low));
    const RopeId b = take(world.add_rope(high));
    const Measurement start = world.measure();
    double least = start.energy.kinetic + start.energy.potential + start.energy.elastic;
    const double whole = least;
    for (int i = 0; i < 60; ++i) {
      run(world, 1);
      const Measurement now = world.measure();
      const double energy = now.energy.kinetic + now.energy.potential + now.energy.elastic;
      CHECK(energy < least + 1e-3 * whole);
      least = std::min(least, energy);
      CHECK(length(now.momentum - start.momentum) < 1e-6 * 0.05 * speed);
      CHECK(world.positions(b)[0].y > world.positions(a)[0].y);
    }
    CHECK(world.velocities(a)[0].y < -0.3 * speed);
    CHECK(least > 0.1 * whole);
  }
}

TEST_CASE("repulsion: points at one place part, momentum stays") {
  World world = make_world(empty_space());
  const RopeId a = take(world.add_rope(rod({}, 0.02)));
  const RopeId b = take(world.add_rope(rod({}, 0.02)));
  run(world, 60);
  CHECK(length(world.positions(a)[0] - world.positions(b)[0]) > 0.9 * kRange);
  CHECK(length(world.measure().momentum) < 1e-7);
}

TEST_CASE("repulsion: neighbors along a strand do not push each other") {
  const auto bend = [](bool with) {
    World world = make_world(without_air());
    std::vector<DVec3> points;
    for (int i = 0; i < 40; ++i) points.push_back({0.01 * i, 0, 0});
    RopeDesc desc = repelling(points, 0.01);
    if (!with) desc.repulsion_strength = Real(0);
    desc.bend_stiffness = Real(1e-4);
    desc.pins = {{.point = 0}, {.point = 1}};
    const RopeId rope = take(world.add_rope(desc));
    run(world, 60);
    std::vector<DVec3> places;
    for (std::size_t i = 0; i < points.size(); ++i) places.push_back(world.positions(rope)[i]);
    return places;
  };
  CHECK(bend(true) == bend(false));
}

TEST_CASE("repulsion: one rope pushes itself where it comes back") {
  World world = make_world(empty_space());
  // A hairpin: two legs 2 cm apart, with 4 cm of rope between the ends of both.
  std::vector<DVec3> points;
  for (int i = 0; i <= 20; ++i) points.push_back({0.5 - 0.025 * i, 0.01, 0});
  for (int i = 0; i <= 20; ++i) points.push_back({0.025 * i, -0.01, 0});
  const RopeId rope = take(world.add_rope(repelling(points, 0.05)));
  run(world, 10);
  CHECK(world.positions(rope)[0].y - world.positions(rope)[41].y > 0.2);
}

TEST_CASE("repulsion: strands that hang together stay apart with it") {
  const auto least_between_tips = [](double strength) {
    constexpr int kStrands = 8;
    World world = make_world(without_air());
    std::vector<DVec3> tips;
    std::vector<RopeId> strands;
    for (int i = 0; i < kStrands; ++i) {  // from a ring, all to one place below its middle
      const double angle = 2 * std::numbers::pi * i / kStrands;
      std::vector<DVec3> points;
      for (int k = 0; k < 12; ++k) {
        const double r = 0.03 - 0.0026 * k;
        points.push_back({r * std::cos(angle), -0.02 * k, r * std::sin(angle)});
      }
      RopeDesc desc = repelling(points, 0.001);
      desc.repulsion_range = Real(0.025);
      desc.repulsion_strength = static_cast<Real>(strength);
      desc.bend_stiffness = Real(1e-4);
      desc.bend_damping = Real(0.1);
      desc.pins = {{.point = 0}, {.point = 1}};
      strands.push_back(take(world.add_rope(desc)));
    }
    run(world, 240);
    for (const RopeId strand : strands) tips.push_back(world.positions(strand)[11]);
    double least = 1;
    for (int a = 0; a < kStrands; ++a) {
      for (int b = 0; b < a; ++b) least = std::min(least, length(tips[a] - tips[b]));
    }
    return least;
  };
  CHECK(least_between_tips(0) < 0.008);
  CHECK(least_between_tips(1e-6) > 0.02);
}

TEST_CASE("repulsion: ropes have the same bits for any number of workers, and after a restore") {
  check_same_bits(without_air(), [](World& world) { add_tuft(world, 2e-8); });
}

TEST_CASE("repulsion: a rope refuses an impossible strength or range") {
  World world = make_world();
  RopeDesc desc = rod({}, 1);
  desc.repulsion_strength = Real(-1);
  CHECK(world.add_rope(desc).error().where == "rope.repulsion_strength");
  desc = rod({}, 1);
  desc.repulsion_range = Real(0);
  CHECK(world.add_rope(desc).error().where == "rope.repulsion_range");
}

}  // namespace hooke
