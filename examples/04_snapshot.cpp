/// The world as it was: snapshot, go on, restore, go on again. Both futures are the same to the last bit, and
/// the number of workers changes none of them.

#include "hooke/hooke.h"

#include <cstdio>

namespace {

void advance(hooke::World& world, int frames) {
  for (int frame = 0; frame < frames; ++frame) world.step(1.0f / 60.0f);
}

}  // namespace

int main() {
  hooke::Result<hooke::World> made =
      hooke::World::create({.workers = 1, .wind = {.velocity = {6, 0, 1}, .gust = 0.5f, .side_gust = 0.3f}});
  if (!made) return 1;
  hooke::World& world = made.value();
  const auto rope = world.add_rope({.hook_point = {0, 3, 0}, .masses = 32, .length_at_rest = 2});
  const auto cloth = world.add_cloth({.columns = 13, .rows = 13, .corner = {1, 3, 0}, .pins = {{0}, {12}}});
  if (!rope || !cloth) return 1;

  advance(world, 60);
  const hooke::Snapshot second_one = world.snapshot();
  const std::uint64_t before = world.state_hash();
  advance(world, 60);
  const std::uint64_t future = world.state_hash();

  if (!world.restore(second_one)) return 1;
  const bool restored = world.state_hash() == before;
  if (!world.set_workers(2)) return 1;
  advance(world, 60);
  const bool repeated = world.state_hash() == future;

  // A different push leads to a different future.
  if (!world.restore(second_one)) return 1;
  if (!world.apply_impulse(hooke::point(rope.value(), 31), {0, 0, 1e-3f})) return 1;
  advance(world, 60);
  const bool other = world.state_hash() != future;

  std::printf("restored %d, repeated with two workers %d, changed by a push %d\n", restored, repeated, other);
  return restored && repeated && other ? 0 : 1;
}
