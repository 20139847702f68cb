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
  // Cells [first, end).
  struct Part {
    std::uint32_t first, end;
    [[nodiscard]] std::uint32_t count() const { return end - first; }
  };
  const auto split = [&](Part part) {
    const auto set = std::span(cells).subspan(part.first, part.count());
    const int axis = longest_axis(centers, set);
    const std::uint32_t middle = part.first + (part.count() + 1) / 2;
    std::nth_element(
        set.begin(), set.begin() + (middle - part.first), set.end(), [&](std::uint32_t a, std::uint32_t b) {
          return std::pair(coordinate(centers[a], axis), a) < std::pair(coordinate(centers[b], axis), b);
        });
    return std::pair(Part{part.first, middle}, Part{middle, part.end});
  };
  std::vector<SurfaceNode> nodes(1);
  std::vector<Part> parts = {{0, static_cast<std::uint32_t>(cells.size())}};  // By node.
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto add_child = [&](std::size_t lane, Part part) {
      if (part.count() == 1) {
        nodes[i].child[lane] = SurfaceNode::kCell | cells[part.first];
        return;
      }
      nodes[i].child[lane] = static_cast<std::uint32_t>(nodes.size());
      nodes.emplace_back();
      parts.push_back(part);
    };
    const auto add_half = [&](std::size_t lane, Part part) {
      if (part.count() == 1) return add_child(lane, part);
      const auto [first, second] = split(part);
      add_child(lane, first);
      add_child(lane + 1, second);
    };
    if (parts[i].count() == 1) {
      add_child(0, parts[i]);
      continue;
    }
    const auto [left, right] = split(parts[i]);
    add_half(0, left);
    add_half(2, right);
  }
  return nodes;
}

}  // namespace hooke::solver
