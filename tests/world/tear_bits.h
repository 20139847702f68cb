#pragma once

#include "world/make.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <doctest/doctest.h>

namespace hooke::test {

/// Checks that what tears has the same bits with 1 and 4 workers, and after a restoration in the middle of
/// it. `make(workers)` makes the empty world, `add(world)` adds what tears and returns its id; it then goes
/// on for `steps`, half of which are taken back once.
template <class Make, class Add>
void check_bits_of_tear(int steps, Make make, Add add) {
  std::array<std::uint64_t, 3> hashes = {};
  for (std::size_t k = 0; k < 3; ++k) {
    World world = make(k == 1 ? 4 : 1);
    const auto id = add(world);
    take(world.add_cloth({.columns = 5, .rows = 5, .corner = {5, 0, 0}}));
    for (int i = 0; i < 100 && world.splits(id).empty(); ++i) run(world, 1);
    run(world, 1);
    REQUIRE(!world.splits(id).empty());
    if (k == 2) {
      const Snapshot middle = world.snapshot();
      run(world, steps / 2);
      REQUIRE(world.restore(middle).has_value());
    }
    run(world, steps);
    hashes[k] = world.state_hash();
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

}  // namespace hooke::test
