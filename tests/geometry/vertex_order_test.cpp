#include "geometry/vertex_order.h"

#include "geometry/meshes.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <numeric>
#include <random>

using hooke::geometry::compute_cuthill_mckee_order;
using hooke::geometry::Edge;
using hooke::geometry::invert_order;

namespace {

std::uint32_t bandwidth(const std::vector<Edge>& edges, const std::vector<std::uint32_t>& order) {
  const auto new_index = invert_order(order);
  std::uint32_t worst = 0;
  for (const Edge& edge : edges) {
    const std::uint32_t a = new_index[edge[0]];
    const std::uint32_t b = new_index[edge[1]];
    worst = std::max(worst, a > b ? a - b : b - a);
  }
  return worst;
}

bool is_permutation_of_all(std::vector<std::uint32_t> order) {
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (order[i] != i) return false;
  }
  return true;
}

/// The edges of a sheet whose vertices have been shuffled by a fixed rule.
std::vector<Edge> shuffled_sheet(std::uint32_t columns, std::uint32_t rows) {
  const hooke::MeshDesc mesh = hooke::test::make_grid(columns, rows, hooke::Real(1));
  auto edges = hooke::geometry::compute_topology(mesh.positions.size(), mesh.triangles).edges;
  std::vector<std::uint32_t> labels(mesh.positions.size());
  std::iota(labels.begin(), labels.end(), 0u);
  std::mt19937 random(1);
  for (std::size_t i = labels.size(); i > 1; --i) std::swap(labels[i - 1], labels[random() % i]);
  for (Edge& edge : edges) edge = {labels[edge[0]], labels[edge[1]]};
  return edges;
}

}  // namespace

TEST_SUITE("geometry/vertex_order") {
  TEST_CASE("a shuffled sheet gets neighbors back to about one row apart") {
    const auto edges = shuffled_sheet(40, 10);
    std::vector<std::uint32_t> as_given(400);
    std::iota(as_given.begin(), as_given.end(), 0u);
    REQUIRE(bandwidth(edges, as_given) > 300);
    const auto order = compute_cuthill_mckee_order(400, edges);
    CHECK(is_permutation_of_all(order));
    CHECK(bandwidth(edges, order) <= 20);  // two rows of ten
  }

  TEST_CASE("a chain given in any order is walked from the end with the smaller index") {
    const std::vector<Edge> edges = {{3, 1}, {0, 2}, {1, 4}, {2, 3}};  // 0 2 3 1 4
    CHECK(compute_cuthill_mckee_order(5, edges) == std::vector<std::uint32_t>{0, 2, 3, 1, 4});
  }

  TEST_CASE("separate parts and lone vertices follow each other by their smallest vertex") {
    const std::vector<Edge> edges = {{1, 4}, {4, 1}, {3, 3}, {2, 5}};
    const auto order = compute_cuthill_mckee_order(6, edges);
    CHECK(is_permutation_of_all(order));
    CHECK(order == std::vector<std::uint32_t>{0, 1, 4, 2, 5, 3});
    CHECK(compute_cuthill_mckee_order(0, {}).empty());
  }

  TEST_CASE("the inverse order takes every vertex back") {
    const auto order = compute_cuthill_mckee_order(60, shuffled_sheet(10, 6));
    const auto inverse = invert_order(order);
    for (std::uint32_t i = 0; i < order.size(); ++i) CHECK(order[inverse[i]] == i);
  }
}
