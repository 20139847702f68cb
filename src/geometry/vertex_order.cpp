#include "geometry/vertex_order.h"

#include "base/assert.h"

#include <algorithm>

namespace hooke::geometry {

namespace {

// Two searches find the rim, each from the farthest vertex of the one before; the third gives the order.
constexpr std::uint32_t kPasses = 3;

/// Neighbors of vertex v: list[begin[v] .. begin[v + 1]).
struct Neighbors {
  std::vector<std::uint32_t> begin = {};
  std::vector<std::uint32_t> list = {};

  [[nodiscard]] std::uint32_t degree(std::uint32_t vertex) const { return begin[vertex + 1] - begin[vertex]; }
  /// Whether `a` has fewer neighbors than `b`, or as many and the smaller index.
  [[nodiscard]] bool has_fewer(std::uint32_t a, std::uint32_t b) const {
    return degree(a) != degree(b) ? degree(a) < degree(b) : a < b;
  }
};

Neighbors collect_neighbors(std::size_t vertex_count, std::span<const std::array<std::uint32_t, 2>> edges) {
  Neighbors neighbors;
  neighbors.begin.assign(vertex_count + 1, 0);
  for (const auto& edge : edges) {
    HOOKE_ASSERT(edge[0] < vertex_count && edge[1] < vertex_count);
    ++neighbors.begin[edge[0] + 1];
    ++neighbors.begin[edge[1] + 1];
  }
  for (std::size_t v = 0; v < vertex_count; ++v) neighbors.begin[v + 1] += neighbors.begin[v];
  neighbors.list.resize(2 * edges.size());
  std::vector<std::uint32_t> next(neighbors.begin.begin(), neighbors.begin.end() - 1);
  for (const auto& edge : edges) {
    neighbors.list[next[edge[0]]++] = edge[1];
    neighbors.list[next[edge[1]]++] = edge[0];
  }
  for (std::size_t v = 0; v < vertex_count; ++v) {
    std::sort(neighbors.list.begin() + neighbors.begin[v], neighbors.list.begin() + neighbors.begin[v + 1],
              [&](std::uint32_t a, std::uint32_t b) { return neighbors.has_fewer(a, b); });
  }
  return neighbors;
}

/// Appends the part of the graph around `start` to `order`, breadth first. `visited` holds `stamp` where a
/// vertex has been seen. Returns the index in `order` where the last, farthest level begins.
std::size_t append_breadth_first(const Neighbors& neighbors, std::uint32_t start, std::uint32_t stamp,
                                 std::vector<std::uint32_t>& visited, std::vector<std::uint32_t>& order) {
  std::size_t level_begin = order.size();
  std::size_t level_end = level_begin + 1;
  order.push_back(start);
  visited[start] = stamp;
  for (std::size_t i = level_begin; i < order.size(); ++i) {
    if (i == level_end) {
      level_begin = level_end;
      level_end = order.size();
    }
    const std::uint32_t vertex = order[i];
    for (std::uint32_t k = neighbors.begin[vertex]; k < neighbors.begin[vertex + 1]; ++k) {
      const std::uint32_t other = neighbors.list[k];
      if (visited[other] == stamp) continue;
      visited[other] = stamp;
      order.push_back(other);
    }
  }
  return level_begin;
}

/// Appends the part of the graph that `start` belongs to.
void append_part(const Neighbors& neighbors, std::uint32_t start, std::vector<std::uint32_t>& visited,
                 std::vector<std::uint32_t>& order) {
  const std::size_t part_begin = order.size();
  for (std::uint32_t pass = 1; pass <= kPasses; ++pass) {
    order.resize(part_begin);
    const std::size_t last_level = append_breadth_first(neighbors, start, pass, visited, order);
    start = *std::min_element(order.begin() + static_cast<std::ptrdiff_t>(last_level), order.end(),
                              [&](std::uint32_t a, std::uint32_t b) { return neighbors.has_fewer(a, b); });
  }
}

}  // namespace

std::vector<std::uint32_t> compute_cuthill_mckee_order(std::size_t vertex_count,
                                                       std::span<const std::array<std::uint32_t, 2>> edges) {
  const Neighbors neighbors = collect_neighbors(vertex_count, edges);
  std::vector<std::uint32_t> visited(vertex_count, 0);
  std::vector<std::uint32_t> order;
  order.reserve(vertex_count);
  for (std::uint32_t first = 0; first < vertex_count; ++first) {
    if (visited[first] == kPasses) continue;
    append_part(neighbors, first, visited, order);
  }
  HOOKE_ASSERT(order.size() == vertex_count);
  return order;
}

std::vector<std::uint32_t> invert_order(std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> inverse(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    HOOKE_ASSERT(order[i] < inverse.size());
    inverse[order[i]] = i;
  }
  return inverse;
}

}  // namespace hooke::geometry
