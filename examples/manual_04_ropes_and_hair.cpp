/// Chapter 4 of the manual: a rope that stretches, one that holds a body, a hair that bends, and one that
/// snaps.

#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>

namespace {

constexpr double kGravity = 9.81;

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

void advance(hooke::World& world, int frames) {
  for (int frame = 0; frame < frames; ++frame) world.step(1.0f / 60);
}

/// A rope of 2 m and 5000 N/m with 20 kg at its end.
bool stretched(hooke::World& world) {
  const auto rope = world.add_rope({
      .hook_point = {0, 3, 0},
      .direction = {0, -1, 0},
      .total_mass = 0.2f,
      .masses = 21,
      .length_at_rest = 2,
      .stiffness = 5000,
      .inner_friction = 100,
      .loads = {{.point = 20, .mass = 20}},
  });
  if (!rope) return false;
  advance(world, 300);
  const double length = 3 - world.positions(rope.value())[20].y;
  const double top = world.tensions(rope.value()).front();
  return agrees("stretched by [m]", length - 2, (20 + 0.1) * kGravity / 5000, 0.01) &&
         agrees("tension at its top [N]", top, (20 + 0.2 - 0.005) * kGravity, 0.01);
}

/// A crate on a rope: a hook holds the end of the rope and the middle of the crate's top.
bool crane(hooke::World& world) {
  const auto rope = world.add_rope(
      {.hook_point = {10, 3, 0}, .direction = {0, -1, 0}, .total_mass = 0.5f, .length_at_rest = 2});
  const auto crate = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                     .shape = hooke::Shape::box({0.5f, 0.5f, 0.5f}),
                                     .position = {10, 0.5, 0},
                                     .mass = 300});
  if (!rope || !crate) return false;
  const auto hook =
      world.add_hook({.a = {.body = crate.value(), .connection_point = "top"},
                      .b = {.point = hooke::point(rope.value(), 0), .connection_point = "end"}});
  if (!hook) return false;
  advance(world, 120);
  return agrees("height of the crate [m]", world.pose(crate.value()).position.y, 0.5, 0.01) &&
         agrees("tension over the crate [N]", world.tensions(rope.value()).back(), 300 * kGravity, 0.01);
}

/// A rod of 1 m, clamped by its first two points: its tip sags by w L^4 / 8 EI, w its weight per meter.
bool hair(hooke::World& world) {
  constexpr int kMasses = 41;
  const auto rod = world.add_rope({
      .hook_point = {20, 3, 0},
      .direction = {1, 0, 0},
      .total_mass = 0.1f,
      .masses = kMasses,
      .length_at_rest = 1,
      .bend_stiffness = 4,
      .bend_damping = 0.2f,
      .pins = {{.point = 0}, {.point = 1}},
  });
  if (!rod) return false;
  advance(world, 300);
  const double sag = 3 - world.positions(rod.value())[kMasses - 1].y;
  const double free = 1 - 1.0 / (kMasses - 1);  // the clamped segment does not bend
  return agrees("sag of the rod's tip [m]", sag, 0.1 * kGravity * std::pow(free, 4) / (8 * 4), 0.03);
}

/// A cord that takes 150 N, with 20 kg on it.
bool snaps(hooke::World& world) {
  const auto cord = world.add_rope({
      .hook_point = {30, 3, 0},
      .direction = {0, -1, 0},
      .masses = 11,
      .stiffness = 2e4f,
      .loads = {{.point = 10, .mass = 20}},
      .strength = 150,
  });
  if (!cord) return false;
  double needed = 0;
  for (int frame = 0; frame < 60; ++frame) {
    world.step(1.0f / 60);
    for (const hooke::RopeBreakEvent& event : world.events().rope_breaks) needed = event.force;
  }
  if (world.broken_segments(cord.value()).size() != 1) return false;
  return agrees("force that broke the cord [N]", needed, 150, 0.15);
}

}  // namespace

int main() {
  hooke::World world = hooke::World::create().value();
  return stretched(world) && crane(world) && hair(world) && snaps(world) ? 0 : 1;
}
