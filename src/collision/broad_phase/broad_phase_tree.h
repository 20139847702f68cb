#pragma once

#include "base/assert.h"
#include "geometry/box.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace hooke::collision {

/// A tree of boxes, eight children to a node, so that one test compares with eight boxes at once. A leaf is a
/// lane of a node and holds a value below 2^31. All boxes are finite. Which node holds a leaf depends on
/// history and must never show in a result.
///
/// A leaf may belong to a collision group. Then queries of the same group do not find it, and they skip parts
/// of the tree in which all leaves are of that group. Group 0 is none.
///
/// New leaves are loose until `update` puts them into nodes. Queries are always right, but test every loose
/// leaf. `update` costs nothing where nothing changed.
class BroadPhaseTree {
 public:
  struct Leaf {
    geometry::Box box = {};
    std::uint32_t value = 0;
    std::uint16_t group = 0;
  };

  /// Adds a leaf. Its value must not be in the tree.
  void insert(const Leaf& leaf);
  /// Removes a leaf. `value` must be in the tree.
  void erase(std::uint32_t value);
  /// Gives a new box to a `value` that is in the tree.
  void move(std::uint32_t value, const geometry::Box& box);
  /// Resets to the state of a new object, but keeps the memory.
  void clear();

  /// Puts loose leaves into nodes and fits nodes to their leaves where many changed. Builds the tree again if
  /// its quality has become poor.
  void update();

  /// Number of leaves, loose ones included.
  [[nodiscard]] std::size_t count() const { return leaf_count_; }
  /// Sum of the half surfaces of all inner boxes. Up to a factor this is how often random queries enter a
  /// node.
  [[nodiscard]] double cost() const;

  /// Calls `visit(value)` for each leaf whose box overlaps `box`, in no particular order. Leaves out those of
  /// the collision group `group` unless that is 0.
  template <class Visit>
  void visit_overlaps(const geometry::Box& box, std::uint16_t group, Visit&& visit) const;

  /// Calls `visit(value)` for each leaf with a `bound(box)` of at most `limit`, nodes from near to far. The
  /// bound of a box must be no higher than that of any box inside it. `visit` returns the new limit, at most
  /// the old one.
  template <class Bound, class Visit>
  void visit_near(double limit, const Bound& bound, Visit&& visit) const;

 private:
  static constexpr int kLanes = 8;
  static constexpr std::uint32_t kLeafBit = 0x80000000;   // in Node::child: the rest is the leaf's value
  static constexpr std::uint32_t kLooseBit = 0x80000000;  // in slot_: the rest is a row of loose_
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  // An insertion goes no deeper than this; a build ends well before.
  static constexpr int kMaxDepth = 40;
  static constexpr int kStackSize = (kLanes - 1) * kMaxDepth + kLanes;

  /// Lanes [0, count) are children; the others are empty. A parent stands before its children in nodes_.
  struct alignas(64) Node {
    std::array<Real, kLanes> lower_x, lower_y, lower_z;
    std::array<Real, kLanes> upper_x, upper_y, upper_z;
    std::array<std::uint32_t, kLanes> child;  // a node, or kLeafBit and a value
    std::array<std::uint16_t, kLanes> group;  // group of all leaves below; 0: none, or several
    std::uint32_t parent = kNone;             // node * kLanes + lane; kNone for the root
    std::int32_t count = 0;

    Node();
    [[nodiscard]] geometry::Box box(int lane) const;
    void set_box(int lane, const geometry::Box& box);
    /// The smallest box around all children.
    [[nodiscard]] geometry::Box bounds() const;
    /// The collision group of all children, if they share one.
    [[nodiscard]] std::uint16_t common_group() const;
    /// Bit i is set if child i overlaps `box` and is not of the collision group `own`.
    [[nodiscard]] unsigned overlaps(const geometry::Box& box, std::uint16_t own) const;
  };
  /// A node that a search has still to enter.
  struct Waiting {
    std::uint32_t node = 0;
    double bound = 0;  // lower bound for all leaves below
  };
  /// Leaves that are to lie below a node.
  struct Task {
    std::uint32_t node = 0;
    std::span<Leaf> leaves = {};
    int depth = 0;
  };

  /// What a lane of a node holds.
  struct Child {
    std::uint32_t child = 0;
    geometry::Box box = {};
    std::uint16_t group = 0;
  };
  static Child child_of(const Leaf& leaf) { return {kLeafBit | leaf.value, leaf.box, leaf.group}; }
  void set_child(std::uint32_t node, int lane, const Child& child);
  void add_lane(std::uint32_t node, const Child& child);
  [[nodiscard]] Child lane_of(std::uint32_t node, int lane) const;
  void remove_lane(std::uint32_t node, int lane);
  /// Extends the boxes and groups above a leaf that was put into `node`, or moved there.
  void grow_ancestors(std::uint32_t node, const geometry::Box& box, std::uint16_t group);
  bool insert_into_nodes(const Leaf& leaf);
  void fit();
  void rebuild();
  void build(std::span<Leaf> leaves);
  void build_node(const Task& task);

  std::vector<Node> nodes_ = std::vector<Node>(1);  // the root is always there
  std::vector<Leaf> loose_;
  std::vector<Task> tasks_;          // work list of build
  std::vector<std::uint32_t> slot_;  // by value: node * kLanes + lane, or kLooseBit and a row, or kNone
  std::size_t leaf_count_ = 0;
  std::size_t change_count_ = 0;  // changes since the nodes were fitted
  double built_cost_ = 0;
};

inline unsigned BroadPhaseTree::Node::overlaps(const geometry::Box& box, std::uint16_t own) const {
  // This form lets compilers use four or eight lanes, which they do not do for comparisons.
  const auto greater = [](Real a, Real b) { return a > b ? a : b; };
  const Vec3 lower = box.lower;
  const Vec3 upper = box.upper;
  std::array<Real, kLanes> gap;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Real gap_x = greater(lower_x[i] - upper.x, lower.x - upper_x[i]);
    const Real gap_y = greater(lower_y[i] - upper.y, lower.y - upper_y[i]);
    const Real gap_z = greater(lower_z[i] - upper.z, lower.z - upper_z[i]);
    gap[i] = greater(gap_x, greater(gap_y, gap_z));
  }
  unsigned mask = 0;
  for (std::size_t i = 0; i < kLanes; ++i) mask |= gap[i] <= Real(0) ? 1u << i : 0u;
  mask &= (1u << count) - 1;  // an infinite box overlaps empty lanes too
  if (own == 0) return mask;
  for (std::size_t i = 0; i < kLanes; ++i) mask &= ~(group[i] == own ? 1u << i : 0u);
  return mask;
}

template <class Visit>
void BroadPhaseTree::visit_overlaps(const geometry::Box& box, std::uint16_t group, Visit&& visit) const {
  for (const Leaf& leaf : loose_) {
    const bool is_same_group = group != 0 && leaf.group == group;
    if (!is_same_group && geometry::overlap(leaf.box, box)) visit(leaf.value);
  }
  std::uint32_t stack[kStackSize];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    for (unsigned mask = node.overlaps(box, group); mask != 0; mask &= mask - 1) {
      const std::uint32_t child = node.child[static_cast<std::size_t>(std::countr_zero(mask))];
      if ((child & kLeafBit) != 0) {
        visit(child & ~kLeafBit);
        continue;
      }
      HOOKE_ASSERT(size < kStackSize);
      stack[size++] = child;
    }
  }
}

template <class Bound, class Visit>
void BroadPhaseTree::visit_near(double limit, const Bound& bound, Visit&& visit) const {
  for (const Leaf& leaf : loose_) {
    if (bound(leaf.box) <= limit) limit = visit(leaf.value);
  }
  Waiting stack[kStackSize];
  int size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Waiting top = stack[--size];
    if (top.bound > limit) continue;
    const Node& node = nodes_[top.node];
    const int first = size;
    for (int lane = 0; lane < node.count; ++lane) {
      const double near = bound(node.box(lane));
      const std::uint32_t child = node.child[static_cast<std::size_t>(lane)];
      if (near > limit) continue;
      if ((child & kLeafBit) != 0) {
        limit = visit(child & ~kLeafBit);
        continue;
      }
      HOOKE_ASSERT(size < kStackSize);
      int at = size++;
      for (; at > first && stack[at - 1].bound < near; --at) stack[at] = stack[at - 1];
      stack[at] = {child, near};
    }
  }
}

}  // namespace hooke::collision
