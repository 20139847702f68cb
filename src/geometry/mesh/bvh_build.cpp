#include "base/assert.h"
#include "geometry/mesh/bvh.h"

#include <algorithm>
#include <tuple>

namespace hooke::geometry {

namespace {

constexpr std::size_t kLeafSize = 4;
constexpr int kBinCount = 16;

// From this depth on nodes are split in halves. These end after 25 more levels, within the stacks of the
// queries.
constexpr int kMedianDepth = 36;

struct Item {
  Box box = {};
  std::uint32_t triangle = 0;

  /// Twice the center; only the order of the values counts. It is in double, where the sum of two floats does
  /// not overflow.
  [[nodiscard]] double center(int axis) const {
    return static_cast<double>(component(box.lower, axis)) + static_cast<double>(component(box.upper, axis));
  }
};

/// A part of the items, and the depth of its node.
struct Task {
  std::span<Item> items = {};
  int depth = 0;
};

/// The axis along which the centers are spread farthest, and their interval on it.
struct Extent {
  int axis = 0;
  double lower = 0.0;
  double size = 0.0;

  [[nodiscard]] int bin(const Item& item) const {
    return std::min(kBinCount - 1, static_cast<int>((item.center(axis) - lower) / size * kBinCount));
  }
};

Extent find_extent(std::span<const Item> items) {
  Extent widest;
  for (int axis = 0; axis < 3; ++axis) {
    double lower = items[0].center(axis);
    double upper = lower;
    for (const Item& item : items) {
      lower = std::min(lower, item.center(axis));
      upper = std::max(upper, item.center(axis));
    }
    if (upper - lower > widest.size) widest = {axis, lower, upper - lower};
  }
  return widest;
}

/// The number of bins on the first side of the split with the least surface times items.
int find_cheapest_split(std::span<const Item> items, const Extent& extent) {
  Box3<double> boxes[kBinCount];
  double counts[kBinCount] = {};
  for (const Item& item : items) {
    const int bin = extent.bin(item);
    boxes[bin] =
        merge(boxes[bin], {vector_cast<double>(item.box.lower), vector_cast<double>(item.box.upper)});
    counts[bin] += 1.0;
  }
  double costs[kBinCount] = {};  // cost of the split before each bin
  Box3<double> box;
  double count = 0.0;
  for (int bin = 0; bin + 1 < kBinCount; ++bin) {
    box = merge(box, boxes[bin]);
    count += counts[bin];
    costs[bin + 1] = count * half_surface(box);
  }
  box = {};
  count = 0.0;
  int best = kBinCount - 1;
  for (int bin = kBinCount - 1; bin > 0; --bin) {
    box = merge(box, boxes[bin]);
    count += counts[bin];
    costs[bin] += count * half_surface(box);
    if (costs[bin] <= costs[best]) best = bin;
  }
  return best;
}

/// Reorders the items and returns how many come first. Both sides get some.
std::size_t split(const Task& task) {
  const Extent extent = find_extent(task.items);
  if (extent.size > 0.0 && task.depth < kMedianDepth) {
    const int bins = find_cheapest_split(task.items, extent);
    // The order of a stable partition is the same in every standard library.
    const auto middle = std::stable_partition(task.items.begin(), task.items.end(),
                                              [&](const Item& item) { return extent.bin(item) < bins; });
    return static_cast<std::size_t>(middle - task.items.begin());
  }
  std::sort(task.items.begin(), task.items.end(), [&](const Item& a, const Item& b) {
    return std::tuple(a.center(extent.axis), a.triangle) < std::tuple(b.center(extent.axis), b.triangle);
  });
  return task.items.size() / 2;
}

std::vector<Item> make_items(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::vector<Item> items(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    items[t] = {box_of(positions[a], positions[b], positions[c]), t};
  }
  return items;
}

/// Appends the node of `task`, and its halves to `tasks`, the first last, because it must follow its parent.
void append_node(const Task& task, Bvh& bvh, std::vector<Task>& tasks) {
  Box box;
  for (const Item& item : task.items) box = merge(box, item.box);
  BvhNode& node = bvh.nodes.emplace_back(BvhNode{.lower = box.lower, .upper = box.upper});
  if (task.items.size() > kLeafSize) {
    const std::size_t first_count = split(task);
    HOOKE_ASSERT(first_count > 0 && first_count < task.items.size());
    tasks.push_back({task.items.subspan(first_count), task.depth + 1});
    tasks.push_back({task.items.first(first_count), task.depth + 1});
    return;
  }
  node.next = static_cast<std::uint32_t>(bvh.order.size());
  node.count = static_cast<std::uint32_t>(task.items.size());
  for (const Item& item : task.items) bvh.order.push_back(item.triangle);
}

/// Sets `next` of the inner nodes. Goes from back to front, so that a node's children are ready before it.
void link_nodes(std::vector<BvhNode>& nodes) {
  const auto end_of = [&](std::size_t node) {
    return nodes[node].count > 0 ? static_cast<std::uint32_t>(node + 1) : nodes[node].next;
  };
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (nodes[i].count == 0) nodes[i].next = end_of(end_of(i + 1));
  }
}

}  // namespace

Bvh build_bvh(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  HOOKE_ASSERT(triangles.size() <= kTriangleLimit);
  Bvh bvh;
  std::vector<Item> items = make_items(positions, triangles);
  std::vector<Task> tasks;
  if (!items.empty()) tasks.push_back({items, 0});
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    append_node(task, bvh, tasks);
  }
  link_nodes(bvh.nodes);
  HOOKE_ASSERT(bvh.order.size() == triangles.size());
  bvh.corners.reserve(triangles.size());
  for (const std::uint32_t t : bvh.order) {
    const auto& [a, b, c] = triangles[t];
    bvh.corners.push_back({positions[a], positions[b], positions[c]});
  }
  return bvh;
}

}  // namespace hooke::geometry
