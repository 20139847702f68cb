#pragma once

#include "solver/soft/spring_blocks.h"

#include <cstddef>
#include <doctest/doctest.h>
#include <vector>

namespace hooke::solver {

/// Checks that no two rows of one pass share a particle. Returns the number of rows in `blocks` over four
/// particles each.
template <class Blocks>
std::size_t count_rows_apart(const Blocks& blocks, std::size_t particles) {
  std::size_t rows = 0;
  for (const auto& pass : blocks.passes) {
    std::vector<int> uses(particles, 0);
    for (int i = pass.first; i < pass.end; ++i) {
      const int count = i + 1 == pass.end ? pass.last_count : kLanes;
      rows += static_cast<std::size_t>(count);
      for (int lane = 0; lane < count; ++lane) {
        for (const auto& record : blocks.blocks[i].record) CHECK(++uses[record[lane] / 4] == 1);
      }
    }
  }
  return rows;
}

}  // namespace hooke::solver
