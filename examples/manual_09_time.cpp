/// Chapter 9 of the manual: a clock for even steps, a picture between two states, snapshots and equal bits.

#include "hooke/clock.h"
#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>

namespace {

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

constexpr float kStep = 1.0f / 60;

/// A ball with a speed of 6 m/s, without gravity: drawn half a step on, it has gone half a step's way.
bool clock_and_blend() {
  hooke::World world = hooke::World::create({.gravity = {}}).value();
  const auto ball = world.add_body(
      {.kind = hooke::BodyKind::kDynamic, .shape = hooke::Shape::sphere(0.1f), .velocity = {6, 0, 0}});
  if (!ball) return false;
  hooke::Clock clock = hooke::Clock::create({.step_seconds = static_cast<double>(kStep)}).value();
  hooke::Pose before = world.pose(ball.value());
  const hooke::Clock::Due due = clock.advance(2.5 / 60);  // the time since the last picture [s]
  for (int i = 0; i < due.steps; ++i) {
    before = world.pose(ball.value());
    world.step(kStep);
  }
  const hooke::Pose drawn = hooke::blend(before, world.pose(ball.value()), due.blend);
  const hooke::Clock::Due late = clock.advance(0.5);  // a hitch: 4 steps are made, the others are not
  std::printf("%d steps; after the hitch %d steps, %d dropped\n", due.steps, late.steps,
              static_cast<int>(late.dropped));
  return due.steps == 2 && late.steps == 4 && late.dropped == 26 &&
         agrees("drawn at [m]", drawn.position.x, 6 * 1.5 / 60, 0.001);
}

/// A heap of ten crates that tumble, and a rope in gusty wind: enough for the smallest difference to grow.
hooke::World make_scene(int workers) {
  hooke::World world =
      hooke::World::create({.workers = workers, .wind = {.velocity = {4, 0, 1}, .gust = 0.5f}}).value();
  (void)world.add_body({}).value();
  (void)world.add_rope({.hook_point = {0, 3, 0}, .masses = 24, .length_at_rest = 2}).value();
  for (int i = 0; i < 10; ++i) {
    (void)world
        .add_body({.kind = hooke::BodyKind::kDynamic,
                   .shape = hooke::Shape::box({0.2f, 0.2f, 0.2f}),
                   .position = {0.1 * i, 0.5 + 0.5 * i, 0},
                   .angular_velocity = {1, 2, 3}})
        .value();
  }
  return world;
}

void advance(hooke::World& world, int frames) {
  for (int frame = 0; frame < frames; ++frame) world.step(kStep);
}

/// The same calls give the same bits with one worker and with two, and after going back in time.
bool same_bits() {
  hooke::World world = make_scene(1);
  hooke::World other = make_scene(2);
  advance(world, 60);
  advance(other, 60);
  const bool alike = world.state_hash() == other.state_hash();

  const hooke::Snapshot save = world.snapshot();
  const std::uint64_t at_save = world.state_hash();
  advance(world, 60);
  const std::uint64_t future = world.state_hash();
  if (!world.restore(save)) return false;
  const bool restored = world.state_hash() == at_save;
  advance(world, 60);
  const bool repeated = world.state_hash() == future;
  std::printf("two workers alike %d, restored %d, future repeated %d\n", alike, restored, repeated);
  return alike && restored && repeated && agrees("time of the world [s]", world.time(), 2, 1e-6);
}

}  // namespace

int main() {
  return clock_and_blend() && same_bits() ? 0 : 1;
}
