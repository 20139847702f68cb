#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

/// \file
/// Greedy coloring: rows of one color share nothing that they write, so that they may be solved side by
/// side.

namespace hooke::solver {

/// Returns the smallest color in 0..63 that no particle of a row uses yet, and marks it. 64 and above mean a
/// row alone in its color (a hub of more than 64 rows). `used[particle]` is a bit mask.
int take_color(std::vector<std::uint64_t>& used, const std::uint32_t* particles, int count);

/// The color of each row of four particles, greedily in the order of the table.
template <class Row>
std::vector<int> color_fours(const std::vector<Row>& rows, int particle_count) {
  std::vector<std::uint64_t> used(static_cast<std::size_t>(particle_count), 0);
  std::vector<int> color;
  int lone_color = 64;
  for (const Row& row : rows) {
    const auto particles = std::bit_cast<std::array<std::uint32_t, 4>>(row);
    const int taken = take_color(used, particles.data(), 4);
    color.push_back(taken < 64 ? taken : lone_color++);
  }
  return color;
}

}  // namespace hooke::solver
