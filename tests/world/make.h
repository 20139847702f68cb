#pragma once

#include "hooke/hooke.h"

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

}  // namespace hooke::test
