#pragma once

#include "hooke/hooke.h"

#include <cstdint>
#include <doctest/doctest.h>
#include <utility>

namespace hooke::test {

inline World make_world(const WorldDesc& desc = {}) {
  Result<World> world = World::create(desc);
  REQUIRE(world.has_value());
  return std::move(world).value();
}

/// The value of a result that must be one.
template <class T>
T take(Result<T> result) {
  if (!result) FAIL(result.error().where << ": " << result.error().message);
  return std::move(result).value();
}

inline double d(Real x) {
  return static_cast<double>(x);
}

inline void run(World& world, int steps, Real dt = Real(1) / Real(60)) {
  for (int i = 0; i < steps; ++i) REQUIRE(world.step(dt).healthy());
}

inline WorldDesc without_air() {
  WorldDesc desc;
  desc.wind.air_density = Real(0);
  return desc;
}

/// A still world: no gravity, no air.
inline WorldDesc empty_space() {
  WorldDesc desc = without_air();
  desc.gravity = {};
  return desc;
}

/// A still world in which nothing sleeps.
inline WorldDesc sleepless_space(int substeps, int workers = 1) {
  WorldDesc desc = empty_space();
  desc.substeps = substeps;
  desc.workers = workers;
  desc.sleeping = false;
  return desc;
}

/// Worlds that `fill` fills have the same bits with any number of workers, and after a restore.
template <class Fill>
void check_same_bits(const WorldDesc& desc, Fill&& fill) {
  std::uint64_t with_one = 0;
  for (const int workers : {1, 2, 3, 8}) {
    World world = make_world(desc);
    REQUIRE(world.set_workers(workers).has_value());
    fill(world);
    run(world, 20);
    const Snapshot snapshot = world.snapshot();
    run(world, 40);
    const std::uint64_t hash = world.state_hash();
    REQUIRE(world.restore(snapshot).has_value());
    run(world, 40);
    CHECK(world.state_hash() == hash);
    if (workers == 1) with_one = hash;
    CHECK(hash == with_one);
  }
}

}  // namespace hooke::test
