#include "collision/broad_phase/broad_phase_tree.h"

#include <algorithm>

namespace hooke::collision {

using geometry::Box;
using geometry::merge;

namespace {

constexpr int kBinCount = 16;

// From this depth on leaves are split in halves. These end after 16 more levels, within
// BroadPhaseTree::kMaxDepth.
constexpr int kMedianDepth = 16;

/// Twice the center; only the order of the values counts.
Vec3 center_of(const BroadPhaseTree::Leaf& leaf) {
  return leaf.box.lower + leaf.box.upper;
}

/// The axis along which the centers are spread farthest, and their interval on it.
struct Extent {
  int axis = 0;
  Real lower = Real(0);
  Real size = Real(0);

  [[nodiscard]] int bin(const BroadPhaseTree::Leaf& leaf) const {
    const Real share = (component(center_of(leaf), axis) - lower) / size;
    return std::min(kBinCount - 1, static_cast<int>(share * Real(kBinCount)));
  }
};

Extent find_extent(std::span<const BroadPhaseTree::Leaf> leaves) {
  Box centers;
  for (const BroadPhaseTree::Leaf& leaf : leaves) {
    centers = merge(centers, {center_of(leaf), center_of(leaf)});
  }
  const Vec3 size = centers.upper - centers.lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return {axis, component(centers.lower, axis), component(size, axis)};
}

/// The number of bins on the first side of the split with the least surface times leaves (Wald, 2007, On fast
/// construction of SAH-based bounding volume hierarchies).
int find_cheapest_split(std::span<const BroadPhaseTree::Leaf> leaves, const Extent& extent) {
  Box boxes[kBinCount];
  double counts[kBinCount] = {};
  for (const BroadPhaseTree::Leaf& leaf : leaves) {
    const int bin = extent.bin(leaf);
    boxes[bin] = merge(boxes[bin], leaf.box);
    counts[bin] += 1;
  }
  double costs[kBinCount] = {};  // cost of the split before each bin
  Box box;
  double count = 0;
  for (int bin = 0; bin + 1 < kBinCount; ++bin) {
    box = merge(box, boxes[bin]);
    count += counts[bin];
    costs[bin + 1] = count * static_cast<double>(half_surface(box));
  }
  box = {};
  count = 0;
  int best = kBinCount - 1;
  for (int bin = kBinCount - 1; bin > 0; --bin) {
    box = merge(box, boxes[bin]);
    count += counts[bin];
    costs[bin] += count * static_cast<double>(half_surface(box));
    if (costs[bin] <= costs[best]) best = bin;
  }
  return best;
}

/// Reorders the leaves and returns how many come first. Both sides get some.
std::size_t split(std::span<BroadPhaseTree::Leaf> leaves, int depth) {
  const Extent extent = find_extent(leaves);
  if (extent.size > Real(0) && depth < kMedianDepth) {
    const int bins = find_cheapest_split(leaves, extent);
    const auto middle = std::partition(leaves.begin(), leaves.end(), [&](const BroadPhaseTree::Leaf& leaf) {
      return extent.bin(leaf) < bins;
    });
    return static_cast<std::size_t>(middle - leaves.begin());
  }
  const auto middle = leaves.begin() + static_cast<std::ptrdiff_t>(leaves.size() / 2);
  std::nth_element(leaves.begin(), middle, leaves.end(),
                   [&](const BroadPhaseTree::Leaf& a, const BroadPhaseTree::Leaf& b) {
                     return component(center_of(a), extent.axis) < component(center_of(b), extent.axis);
                   });
  return leaves.size() / 2;
}

}  // namespace

void BroadPhaseTree::build(std::span<Leaf> leaves) {
  nodes_.assign(1, {});
  tasks_.assign(1, {0, leaves, 0});
  while (!tasks_.empty()) {
    const Task task = tasks_.back();
    tasks_.pop_back();
    build_node(task);
  }
}

/// Cuts the largest part in two until there are eight parts or all fit into one node each.
void BroadPhaseTree::build_node(const Task& task) {
  if (task.leaves.size() <= kLanes) {
    for (const Leaf& leaf : task.leaves) add_lane(task.node, child_of(leaf));
    return;
  }
  std::array<std::span<Leaf>, kLanes> parts = {task.leaves};
  for (std::size_t count = 1; count < kLanes; ++count) {
    auto& largest = *std::max_element(parts.begin(), parts.begin() + count,
                                      [](const auto& a, const auto& b) { return a.size() < b.size(); });
    if (largest.size() <= kLanes) break;
    const std::size_t first_count = split(largest, task.depth);
    HOOKE_ASSERT(first_count > 0 && first_count < largest.size());
    parts[count] = largest.subspan(first_count);
    largest = largest.first(first_count);
  }
  for (const std::span<Leaf> part : parts) {
    if (part.empty()) break;
    if (part.size() == 1) {
      add_lane(task.node, child_of(part[0]));
      continue;
    }
    Child child = {static_cast<std::uint32_t>(nodes_.size()), {}, part[0].group};
    for (const Leaf& leaf : part) {
      child.box = merge(child.box, leaf.box);
      if (leaf.group != child.group) child.group = 0;
    }
    nodes_.emplace_back();
    add_lane(task.node, child);
    tasks_.push_back({child.child, part, task.depth + 1});
  }
}

}  // namespace hooke::collision
