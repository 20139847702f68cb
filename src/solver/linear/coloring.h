#pragma once

#include "state/objects.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Greedy coloring: rows of one color share nothing that they write, so that they may be solved side by
/// side.

namespace hooke::solver {

/// Returns the smallest color in 0..63 that no particle of a row uses yet, and marks it. 64 and above mean a
/// row alone in its color (a hub of more than 64 rows). `used[particle]` is a bit mask.
int take_color(std::vector<std::uint64_t>& used, const std::uint32_t* particles, int count);

/// One more than the largest color.
inline std::size_t count_colors(const std::vector<int>& colors) {
  return colors.empty() ? 0 : static_cast<std::size_t>(*std::max_element(colors.begin(), colors.end())) + 1;
}

/// The color of each row of four of the particles, greedily in the order of the rows.
template <class Row>
std::vector<int> color_fours(std::span<const Row> rows, state::Rows particles_of) {
  std::vector<std::uint64_t> used(particles_of.count, 0);
  std::vector<int> color;
  color.reserve(rows.size());
  int lone_color = 64;
  for (const Row& row : rows) {
    auto particles = std::bit_cast<std::array<std::uint32_t, 4>>(row);
    for (std::uint32_t& particle : particles) particle -= particles_of.first;
    const int taken = take_color(used, particles.data(), 4);
    color.push_back(taken < 64 ? taken : lone_color++);
  }
  return color;
}

}  // namespace hooke::solver
