#include "collision/broad_phase/broad_phase_tree.h"

#include "base/assert.h"
#include "collision/broad_phase/broad_phase_tuning.h"

#include <algorithm>

namespace hooke::collision {

using geometry::Box;
using geometry::half_surface;
using geometry::merge;

namespace {

double surface_of(const Box& box) {
  return static_cast<double>(half_surface(box));
}

}  // namespace

BroadPhaseTree::Node::Node() : child{}, group{} {
  for (int lane = 0; lane < kLanes; ++lane) set_box(lane, {});
}

Box BroadPhaseTree::Node::box(int lane) const {
  const auto i = static_cast<std::size_t>(lane);
  return {{lower_x[i], lower_y[i], lower_z[i]}, {upper_x[i], upper_y[i], upper_z[i]}};
}

void BroadPhaseTree::Node::set_box(int lane, const Box& box) {
  const auto i = static_cast<std::size_t>(lane);
  lower_x[i] = box.lower.x;
  lower_y[i] = box.lower.y;
  lower_z[i] = box.lower.z;
  upper_x[i] = box.upper.x;
  upper_y[i] = box.upper.y;
  upper_z[i] = box.upper.z;
}

Box BroadPhaseTree::Node::bounds() const {
  Box whole;
  for (int lane = 0; lane < count; ++lane) whole = merge(whole, box(lane));
  return whole;
}

std::uint16_t BroadPhaseTree::Node::common_group() const {
  const auto end = group.begin() + count;
  return std::all_of(group.begin(), end, [&](std::uint16_t c) { return c == group[0]; }) ? group[0] : 0;
}

void BroadPhaseTree::insert(const Leaf& leaf) {
  HOOKE_ASSERT(leaf.value < kLeafBit);
  if (leaf.value >= slot_.size()) slot_.resize(leaf.value + std::size_t{1}, kNone);
  HOOKE_ASSERT(slot_[leaf.value] == kNone);
  slot_[leaf.value] = kLooseBit | static_cast<std::uint32_t>(loose_.size());
  loose_.push_back(leaf);
  ++leaf_count_;
}

void BroadPhaseTree::erase(std::uint32_t value) {
  const std::uint32_t slot = slot_[value];
  HOOKE_ASSERT(slot != kNone);
  slot_[value] = kNone;
  --leaf_count_;
  if ((slot & kLooseBit) == 0) {
    remove_lane(slot / kLanes, static_cast<int>(slot % kLanes));
    ++change_count_;
    return;
  }
  const std::uint32_t row = slot & ~kLooseBit;
  if (row + std::size_t{1} < loose_.size()) {
    loose_[row] = loose_.back();
    slot_[loose_[row].value] = slot;
  }
  loose_.pop_back();
}

void BroadPhaseTree::move(std::uint32_t value, const Box& box) {
  const std::uint32_t slot = slot_[value];
  HOOKE_ASSERT(slot != kNone);
  if ((slot & kLooseBit) != 0) {
    loose_[slot & ~kLooseBit].box = box;
    return;
  }
  Node& node = nodes_[slot / kLanes];
  node.set_box(static_cast<int>(slot % kLanes), box);
  grow_ancestors(slot / kLanes, box, node.group[slot % kLanes]);
  ++change_count_;
}

void BroadPhaseTree::clear() {
  nodes_.assign(1, {});
  loose_.clear();
  slot_.clear();
  leaf_count_ = 0;
  change_count_ = 0;
  built_cost_ = 0;
}

void BroadPhaseTree::update() {
  const bool has_many_empty_nodes = nodes_.size() > 2 * leaf_count_ + 64;
  if (loose_.size() * kLeavesPerInsertion > leaf_count_ || has_many_empty_nodes) return rebuild();
  for (std::size_t row = loose_.size(); row-- > 0;) {
    const Leaf leaf = loose_[row];
    if (!insert_into_nodes(leaf)) return rebuild();
    loose_.pop_back();
    ++change_count_;
  }
  if (change_count_ * kLeavesPerChange <= leaf_count_) return;
  fit();
  if (cost() > kTreePoorness * built_cost_) rebuild();
}

double BroadPhaseTree::cost() const {
  double sum = 0;
  for (const Node& node : nodes_) {
    for (int lane = 0; lane < node.count; ++lane) {
      const bool is_leaf = (node.child[static_cast<std::size_t>(lane)] & kLeafBit) != 0;
      sum += is_leaf ? 0 : surface_of(node.box(lane));
    }
  }
  return sum;
}

void BroadPhaseTree::set_child(std::uint32_t node, int lane, const Child& child) {
  const auto i = static_cast<std::size_t>(lane);
  const std::uint32_t slot = node * kLanes + static_cast<std::uint32_t>(lane);
  nodes_[node].set_box(lane, child.box);
  nodes_[node].child[i] = child.child;
  nodes_[node].group[i] = child.group;
  if ((child.child & kLeafBit) != 0) {
    slot_[child.child & ~kLeafBit] = slot;
  } else {
    nodes_[child.child].parent = slot;
  }
}

void BroadPhaseTree::add_lane(std::uint32_t node, const Child& child) {
  HOOKE_ASSERT(nodes_[node].count < kLanes);
  set_child(node, nodes_[node].count++, child);
}

BroadPhaseTree::Child BroadPhaseTree::lane_of(std::uint32_t node, int lane) const {
  const auto i = static_cast<std::size_t>(lane);
  return {nodes_[node].child[i], nodes_[node].box(lane), nodes_[node].group[i]};
}

void BroadPhaseTree::remove_lane(std::uint32_t node, int lane) {
  HOOKE_ASSERT(lane < nodes_[node].count);
  const int last = --nodes_[node].count;
  if (lane != last) set_child(node, lane, lane_of(node, last));
  nodes_[node].set_box(last, {});
  const std::uint32_t parent = nodes_[node].parent;
  // An empty node stays behind, unused, until the next build.
  if (last == 0 && parent != kNone) remove_lane(parent / kLanes, static_cast<int>(parent % kLanes));
}

void BroadPhaseTree::grow_ancestors(std::uint32_t node, const Box& box, std::uint16_t group) {
  for (std::uint32_t slot = nodes_[node].parent; slot != kNone; slot = nodes_[node].parent) {
    node = slot / kLanes;
    const int lane = static_cast<int>(slot % kLanes);
    const Box old = nodes_[node].box(lane);
    std::uint16_t& common = nodes_[node].group[static_cast<std::size_t>(lane)];
    const bool is_common = common == 0 || common == group;
    if (contains(old, box) && is_common) return;
    if (!is_common) common = 0;
    nodes_[node].set_box(lane, merge(old, box));
  }
}

/// Descends where boxes grow least, to the first free lane. A leaf costs nothing there, because all lanes of
/// a node are tested together. Returns false if the descent is too long; then the tree must be rebuilt.
bool BroadPhaseTree::insert_into_nodes(const Leaf& leaf) {
  std::uint32_t node = 0;
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    if (nodes_[node].count < kLanes) {
      add_lane(node, child_of(leaf));
      grow_ancestors(node, leaf.box, leaf.group);
      return true;
    }
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int lane = 0; lane < kLanes; ++lane) {
      const Box old = nodes_[node].box(lane);
      const double growth = surface_of(merge(old, leaf.box)) - surface_of(old);
      best = growth < least ? lane : best;
      least = growth < least ? growth : least;
    }
    const std::uint32_t next = nodes_[node].child[static_cast<std::size_t>(best)];
    if ((next & kLeafBit) != 0) {
      const Child old = lane_of(node, best);
      const auto fresh = static_cast<std::uint32_t>(nodes_.size());
      nodes_.emplace_back();
      set_child(node, best, {fresh, old.box, old.group});
      add_lane(fresh, old);
      node = fresh;
    } else {
      node = next;
    }
  }
  return false;
}

void BroadPhaseTree::fit() {
  for (std::size_t node = nodes_.size(); node-- > 1;) {
    const std::uint32_t slot = nodes_[node].parent;
    if (nodes_[node].count == 0) continue;
    Node& parent = nodes_[slot / kLanes];
    parent.set_box(static_cast<int>(slot % kLanes), nodes_[node].bounds());
    parent.group[slot % kLanes] = nodes_[node].common_group();
  }
  change_count_ = 0;
}

void BroadPhaseTree::rebuild() {
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
    for (int lane = 0; lane < nodes_[node].count; ++lane) {
      const Child child = lane_of(node, lane);
      if ((child.child & kLeafBit) != 0) loose_.push_back({child.box, child.child & ~kLeafBit, child.group});
    }
  }
  HOOKE_ASSERT(loose_.size() == leaf_count_);
  build(loose_);
  loose_.clear();
  change_count_ = 0;
  built_cost_ = cost();
}

}  // namespace hooke::collision
