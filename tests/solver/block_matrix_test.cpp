#include "solver/block_matrix.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <vector>

namespace hooke::solver {
namespace {

using Neighbors = std::vector<std::vector<std::uint32_t>>;

/// A symmetric matrix with a strong diagonal and the given blocks, always the same: element (i, j) of the
/// whole.
double element(int i, int j) {
  const int low = i < j ? i : j;
  const int high = i < j ? j : i;
  return i == j ? 10.0 + i : std::sin(1.0 + 3.0 * low + 7.0 * high);
}

/// The largest error of A x - b over a system of these blocks.
double residual(const Neighbors& neighbors, const std::vector<int>& sizes) {
  const BlockPattern p = *make_block_pattern(neighbors, sizes, 1e9);
  std::vector<double> numbers(p.number_count);
  std::vector<std::vector<double>> dense(p.first.back(), std::vector<double>(p.first.back()));
  for (const BlockPattern::Block& block : p.block) {
    const auto& of = neighbors[p.order[block.row]];
    const bool given =
        block.row == block.column || std::count(of.begin(), of.end(), p.order[block.column]) > 0;
    for (int r = 0; given && r < p.size[block.row]; ++r) {
      for (int c = 0; c < p.size[block.column]; ++c) {
        const int i = p.first[block.row] + r;
        const int j = p.first[block.column] + c;
        dense[i][j] = dense[j][i] = numbers[block.offset + r * p.size[block.column] + c] = element(i, j);
      }
    }
  }
  std::vector<double> x(p.first.back());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::cos(static_cast<double>(i));
  factor(p, numbers);
  solve(p, numbers, x);
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double sum = -std::cos(static_cast<double>(i));
    for (std::size_t j = 0; j < x.size(); ++j) sum += dense[i][j] * x[j];
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

Neighbors chain(std::uint32_t count) {
  Neighbors neighbors(count);
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    neighbors[i].push_back(i + 1);
    neighbors[i + 1].insert(neighbors[i + 1].begin(), i);
  }
  return neighbors;
}

TEST_SUITE("solver/block_matrix") {
  TEST_CASE("a chain, a ring, a star and a dense block are solved") {
    Neighbors ring = chain(7);
    ring[0].push_back(6);
    ring[6].insert(ring[6].begin(), 0);
    CHECK(residual(chain(6), {3, 5, 1, 6, 2, 3}) < 1e-13);
    CHECK(residual(ring, {3, 3, 2, 3, 5, 1, 3}) < 1e-13);
    CHECK(residual({{1, 2, 3, 4}, {0}, {0}, {0}, {0}}, {4, 3, 3, 1, 2}) < 1e-13);
    CHECK(residual({{}}, {9}) < 1e-13);
  }

  TEST_CASE("chains and trees have no fill") {
    const BlockPattern line = *make_block_pattern(chain(100), std::vector<int>(100, 3), 1e9);
    CHECK(line.block.size() == 100 + 99);
    const Neighbors tree = {{1, 2, 3}, {0, 4, 5}, {0}, {0}, {1}, {1}};
    CHECK(make_block_pattern(tree, std::vector<int>(6, 3), 1e9)->block.size() == 6 + 5);
  }

  TEST_CASE("what costs more than the budget is refused") {
    const double cost = make_block_pattern(chain(100), std::vector<int>(100, 3), 1e9)->operations;
    CHECK(make_block_pattern(chain(100), std::vector<int>(100, 3), cost).has_value());
    CHECK_FALSE(make_block_pattern(chain(100), std::vector<int>(100, 3), cost - 1).has_value());
  }
}

}  // namespace
}  // namespace hooke::solver
