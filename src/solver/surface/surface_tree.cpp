#include "solver/surface/surface_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace hooke::solver {

namespace {

Real coordinate(Vec3 x, int axis) {
  return axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

int longest_axis(std::span<const Vec3> centers, std::span<const std::uint32_t> set) {
  Vec3 lower = centers[set.front()];
  Vec3 upper = lower;
  for (const std::uint32_t cell : set) {
    const Vec3 x = centers[cell];
    lower = {std::min(lower.x, x.x), std::min(lower.y, x.y), std::min(lower.z, x.z)};
    upper = {std::max(upper.x, x.x), std::max(upper.y, x.y), std::max(upper.z, x.z)};
  }
  const Vec3 size = upper - lower;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

}  // namespace

std::vector<SurfaceNode> build_surface_tree(std::span<const Vec3> centers) {
  if (centers.empty()) return {};
  std::vector<std::uint32_t> cells(centers.size());
  std::iota(cells.begin(), cells.end(), std::uint32_t{0});
  // Each task makes one node of the cells [first, end).
  struct Task {
    std::uint32_t node, first, end;
  };
  std::vector<SurfaceNode> nodes(1);
  std::vector<Task> tasks = {{0, 0, static_cast<std::uint32_t>(cells.size())}};
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const Task task = tasks[i];
    if (task.end - task.first == 1) {
      nodes[task.node].right = cells[task.first];
      continue;
    }
    const auto set = std::span(cells).subspan(task.first, task.end - task.first);
    const int axis = longest_axis(centers, set);
    std::sort(set.begin(), set.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(coordinate(centers[a], axis), a) < std::pair(coordinate(centers[b], axis), b);
    });
    const auto left = static_cast<std::uint32_t>(nodes.size());
    nodes[task.node] = {left, left + 1};
    nodes.resize(nodes.size() + 2);
    const std::uint32_t middle = task.first + (task.end - task.first + 1) / 2;
    tasks.push_back({left, task.first, middle});
    tasks.push_back({left + 1, middle, task.end});
  }
  return nodes;
}

}  // namespace hooke::solver
