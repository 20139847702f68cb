/// Chapter 7 of the manual: pushes, an orbit, a floating block, a magnetic circle and two force laws.

#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>

namespace {

constexpr double kPi = 3.14159265358979;

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

void advance(hooke::World& world, int frames) {
  for (int frame = 0; frame < frames; ++frame) world.step(1.0f / 60);
}

/// An impulse J changes the speed by J / m at once; a force F, given for each step, by F t / m.
bool pushes() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto puck = world.add_body(
      {.kind = hooke::BodyKind::kDynamic, .shape = hooke::Shape::cylinder(0.1f, 0.02f), .mass = 0.5f});
  if (!puck || !world.apply_impulse(puck.value(), {1, 0, 0})) return false;
  bool good = agrees("speed after 1 N s [m/s]", world.velocity(puck.value()).x, 1 / 0.5, 0.001);
  for (int frame = 0; frame < 60; ++frame) {
    if (!world.apply_force(puck.value(), {0, 0, 3})) return false;
    world.step(1.0f / 60);
  }
  return agrees("speed after 3 N for 1 s [m/s]", world.velocity(puck.value()).z, 3 / 0.5, 0.001) && good;
}

/// A planet of 1 m around a star: once around takes 2 pi sqrt(r^3 / strength).
bool orbit() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto star = world.add_field({.kind = hooke::FieldDesc::Kind::kInverseSquare, .strength = 4});
  const auto planet = world.add_particles({.particles = {{.position = {1, 0, 0}, .velocity = {0, 0, 2}}}});
  if (!star || !planet) return false;
  double before = 0;
  for (int frame = 0; frame < 300; ++frame) {
    world.step(1.0f / 60);
    const double z = world.positions(planet.value())[0].z;
    if (before < 0 && z >= 0) {
      const double period = world.time() - z / (z - before) / 60;
      return agrees("once around the star [s]", period, 2 * kPi * std::sqrt(1.0 / 4), 0.01);
    }
    before = z;
  }
  return false;
}

/// A block of 600 kg/m^3 floats in water of 1000 kg/m^3 with six tenths of its height below the surface.
bool floating_block() {
  hooke::World world = hooke::World::create().value();
  const auto water =
      world.add_field({.kind = hooke::FieldDesc::Kind::kLiquid, .height = 2, .density = 1000, .drag = 2});
  const auto block = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                     .shape = hooke::Shape::box({1, 0.5f, 1}),
                                     .position = {0, 2.3, 0},
                                     .density = 600,
                                     .can_sleep = false});
  if (!water || !block) return false;
  advance(world, 600);
  const double immersed = 2 - (world.pose(block.value()).position.y - 0.5);
  return agrees("the block is in the water by [m]", immersed, 0.6, 0.01);
}

/// A charge q of mass m and speed v runs on a circle of radius m v / q B.
bool magnetic_circle() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto field = world.add_field({.kind = hooke::FieldDesc::Kind::kMagnetic, .vector = {0, 2, 0}});
  const auto ion =
      world.add_particles({.particles = {{.velocity = {3, 0, 0}, .mass = 0.1f, .charge = 0.2f}}});
  if (!field || !ion) return false;
  double widest = 0;
  for (int frame = 0; frame < 120; ++frame) {
    world.step(1.0f / 60);
    widest = std::fmax(widest, hooke::length(world.positions(ion.value())[0]));
  }
  return agrees("diameter of the circle [m]", widest, 2 * 0.1 * 3 / (0.2 * 2), 0.01);
}

/// A law over particles: a spring of 8 N/m to the origin. 0.5 kg swing once in 2 pi sqrt(m / k).
bool own_spring() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto mass = world.add_particles({.particles = {{.position = {1, 0, 0}, .mass = 0.5f}}});
  const auto law = world.add_force_law([](hooke::ForceView& object) {
    for (std::size_t i = 0; i < object.size(); ++i) {
      object.add_force(i, -8 * hooke::vector_cast<hooke::Real>(object.position(i)));
    }
  });
  if (!mass || !law) return false;
  double before = 1;
  while (world.time() < 2) {
    world.step(1.0f / 240);
    const double x = world.positions(mass.value())[0].x;
    if (before > 0 && x <= 0) {
      const double quarter = world.time() + x / (before - x) / 240;
      return agrees("period of the spring [s]", 4 * quarter, 2 * kPi * std::sqrt(0.5 / 8), 0.01);
    }
    before = x;
  }
  return false;
}

/// A law over bodies: a brake of 4 N s/m. A rocket of 60 N of thrust gets to 15 m/s.
bool own_brake() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto rocket =
      world.add_body({.kind = hooke::BodyKind::kDynamic, .shape = hooke::Shape::sphere(0.2f), .mass = 2});
  const auto law = world.add_force_law([](hooke::BodyForceView& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const hooke::Vec3 thrust = hooke::rotate(bodies.rotation(i), hooke::Vec3{0, 60, 0});
      bodies.add_force(i, thrust - 4 * bodies.velocity(i));
    }
  });
  if (!rocket || !law) return false;
  advance(world, 300);
  return agrees("speed of the rocket [m/s]", world.velocity(rocket.value()).y, 60.0 / 4, 0.01);
}

}  // namespace

int main() {
  const bool good = pushes() && orbit() && floating_block() && magnetic_circle();
  return good && own_spring() && own_brake() ? 0 : 1;
}
