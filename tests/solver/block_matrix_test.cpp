#include "solver/linear/block_matrix.h"

#include "solver/simd/dispatch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <optional>
#include <string>
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

/// Nothing if it costs too much.
std::optional<BlockPattern> pattern_of(const Neighbors& neighbors, const std::vector<int>& sizes,
                                       double budget = 1e9) {
  BlockGraph graph;
  graph.reset(neighbors.size());
  for (std::uint32_t i = 0; i < neighbors.size(); ++i) {
    for (const std::uint32_t k : neighbors[i]) graph.join(i, k);
  }
  BlockPattern pattern;
  if (!make_block_pattern(graph, sizes, budget, pattern)) return std::nullopt;
  return pattern;
}

/// The largest error of A x - b over a system of these blocks.
double residual(const Neighbors& neighbors, const std::vector<int>& sizes) {
  const BlockPattern p = *pattern_of(neighbors, sizes);
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
  std::vector<double> scratch;
  factor(p, numbers, scratch);
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

/// Nodes on a square grid, each beside the ones that are next to it.
Neighbors grid(std::uint32_t side) {
  Neighbors neighbors(side * side);
  for (std::uint32_t i = 0; i < side * side; ++i) {
    if (i >= side) neighbors[i].push_back(i - side);
    if (i % side > 0) neighbors[i].push_back(i - 1);
    if (i % side + 1 < side) neighbors[i].push_back(i + 1);
    if (i + side < side * side) neighbors[i].push_back(i + side);
  }
  return neighbors;
}

/// The solution of a system whose blocks all have numbers.
std::vector<double> solution_of(const BlockPattern& p) {
  std::vector<double> numbers(p.number_count);
  for (const BlockPattern::Block& block : p.block) {
    for (int r = 0; r < p.size[block.row]; ++r) {
      for (int c = 0; c < p.size[block.column]; ++c) {
        const double number = element(p.first[block.row] + r, p.first[block.column] + c);
        numbers[block.offset + r * p.size[block.column] + c] = number;
      }
    }
  }
  std::vector<double> scratch;
  factor(p, numbers, scratch);
  std::vector<double> x(p.first.back(), 1.0);
  solve(p, numbers, x);
  return x;
}

TEST_SUITE("solver/block_matrix") {
  TEST_CASE("a grid, whose last columns are a dense panel, is solved") {
    std::vector<int> sizes(144, 3);
    CHECK(residual(grid(12), sizes) < 1e-12);
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = static_cast<int>(i % 4);
    CHECK(residual(grid(12), sizes) < 1e-12);
  }

  TEST_CASE("solutions have the same bits with every instruction set") {
    std::vector<int> sizes(100);
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = static_cast<int>(i % 7);
    const BlockPattern pattern = *pattern_of(grid(10), sizes);
    REQUIRE(wide::use_target("scalar"));
    const std::vector<double> scalar = solution_of(pattern);
    for (const std::string& target : wide::targets()) {
      REQUIRE(wide::use_target(target));
      CHECK_MESSAGE(solution_of(pattern) == scalar, target);
    }
    wide::use_target("");
  }

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
    const BlockPattern line = *pattern_of(chain(100), std::vector<int>(100, 3));
    CHECK(line.block.size() == 100 + 99);
    const Neighbors tree = {{1, 2, 3}, {0, 4, 5}, {0}, {0}, {1}, {1}};
    CHECK(pattern_of(tree, std::vector<int>(6, 3))->block.size() == 6 + 5);
  }

  TEST_CASE("a graph that is used again gives what a new one gives") {
    BlockGraph graph;
    BlockPattern again;
    for (const std::uint32_t count : {9U, 5U, 7U}) {
      graph.reset(count);
      for (std::uint32_t i = 0; i + 1 < count; ++i) graph.join(i + 1, i);
      graph.join(0, count - 1);
      const std::vector<int> sizes(count, 3);
      REQUIRE(make_block_pattern(graph, sizes, 1e9, again));
      Neighbors ring = chain(count);
      ring[0].push_back(count - 1);
      const BlockPattern fresh = *pattern_of(ring, sizes);
      CHECK(again.order == fresh.order);
      CHECK(again.column_begin == fresh.column_begin);
      CHECK(again.update_begin == fresh.update_begin);
      CHECK(again.first == fresh.first);
      CHECK(again.number_count == fresh.number_count);
      CHECK(again.operations == fresh.operations);
    }
  }

  TEST_CASE("what costs more than the budget is refused") {
    const double cost = pattern_of(chain(100), std::vector<int>(100, 3))->operations;
    CHECK(pattern_of(chain(100), std::vector<int>(100, 3), cost).has_value());
    CHECK_FALSE(pattern_of(chain(100), std::vector<int>(100, 3), cost - 1).has_value());
  }
}

}  // namespace
}  // namespace hooke::solver
