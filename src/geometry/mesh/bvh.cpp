#include "geometry/mesh/bvh.h"

#include "base/assert.h"
#include "geometry/closest.h"
#include "geometry/line_triangle.h"
#include "geometry/ray_slabs.h"

#include <algorithm>
#include <cmath>

namespace hooke::geometry {

namespace {

// The stack has one entry for each level of the tree and one more; build_bvh stays within 36 levels of
// lopsided splits and 25 of halves.
constexpr int kStackSize = 64;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// A node that a search has still to enter; the farthest come first.
struct Waiting {
  std::uint32_t node = 0;
  double bound = 0.0;  // nothing below the node is nearer
};

/// The inner node's two children.
std::array<std::uint32_t, 2> children(const Bvh& bvh, std::uint32_t node) {
  const std::uint32_t first = node + 1;
  return {first, bvh.nodes[first].count > 0 ? first + 1 : bvh.nodes[first].next};
}

Box box_of_node(const BvhNode& node) {
  return {node.lower, node.upper};
}

/// Visits leaves from near to far. `bound(node)` is a lower bound of the distance of the triangles below,
/// infinite to skip them. `visit(leaf)` returns the distance beyond which the caller needs nothing more.
template <class Bound, class Visit>
void visit_near_to_far(const Bvh& bvh, double limit, const Bound& bound, const Visit& visit) {
  if (bvh.nodes.empty()) return;
  Waiting stack[kStackSize];
  int size = 0;
  const auto push = [&](const Waiting& entry) {
    HOOKE_ASSERT(size < kStackSize);
    if (entry.bound <= limit && entry.bound < kNever) stack[size++] = entry;
  };
  push({0, bound(bvh.nodes[0])});
  while (size > 0) {
    const Waiting entry = stack[--size];
    if (entry.bound > limit) continue;
    if (bvh.nodes[entry.node].count > 0) {
      limit = visit(bvh.nodes[entry.node]);
      continue;
    }
    const auto [first, second] = children(bvh, entry.node);
    const Waiting near = {first, bound(bvh.nodes[first])};
    const Waiting far = {second, bound(bvh.nodes[second])};
    push(near.bound <= far.bound ? far : near);
    push(near.bound <= far.bound ? near : far);
  }
}

std::array<DVec3, 3> in_double(const std::array<Vec3, 3>& corners) {
  return {vector_cast<double>(corners[0]), vector_cast<double>(corners[1]), vector_cast<double>(corners[2])};
}

}  // namespace

void find_triangles(const Bvh& bvh, const Box& box, std::vector<std::uint32_t>& found) {
  found.clear();
  for (std::uint32_t i = 0; i < bvh.nodes.size();) {
    const BvhNode& node = bvh.nodes[i];
    const bool is_leaf = node.count > 0;
    const bool is_near = overlap(box_of_node(node), box);
    HOOKE_ASSERT(is_leaf ? node.next + node.count <= bvh.order.size() : node.next > i);
    for (std::uint32_t k = node.next; is_leaf && is_near && k < node.next + node.count; ++k) {
      const auto& [a, b, c] = bvh.corners[k];
      if (overlap(box_of(a, b, c), box)) found.push_back(bvh.order[k]);
    }
    i = is_leaf || is_near ? i + 1 : node.next;
  }
  std::sort(found.begin(), found.end());
}

void find_triangles_on_path(const Bvh& bvh, DVec3 origin, DVec3 motion, double radius,
                            std::vector<BvhEntry>& found) {
  found.clear();
  const RaySlabs ray = RaySlabs::of(origin, motion);
  for (std::uint32_t i = 0; i < bvh.nodes.size();) {
    const BvhNode& node = bvh.nodes[i];
    const bool is_leaf = node.count > 0;
    const bool is_near = ray.enter(box_of_node(node), radius) <= 1.0;
    HOOKE_ASSERT(is_leaf ? node.next + node.count <= bvh.order.size() : node.next > i);
    for (std::uint32_t k = node.next; is_leaf && is_near && k < node.next + node.count; ++k) {
      const auto& [a, b, c] = bvh.corners[k];
      const double fraction = ray.enter(box_of(a, b, c), radius);
      if (fraction <= 1.0) found.push_back({bvh.order[k], fraction});
    }
    i = is_leaf || is_near ? i + 1 : node.next;
  }
  std::sort(found.begin(), found.end(), [](const BvhEntry& p, const BvhEntry& q) {
    return p.fraction != q.fraction ? p.fraction < q.fraction : p.triangle < q.triangle;
  });
}

std::optional<BvhClosest> find_closest(const Bvh& bvh, Vec3 p, Real distance_max) {
  // The bound of a box and the distance of a triangle in it are rounded differently.
  const Real slack = Real(1) - Real(16) * std::numeric_limits<Real>::epsilon();
  std::optional<BvhClosest> best;
  Real limit = distance_max * distance_max;
  const auto visit = [&](const BvhNode& leaf) {
    for (std::uint32_t k = leaf.next; k < leaf.next + leaf.count; ++k) {
      const auto& [a, b, c] = bvh.corners[k];
      const TrianglePoint<Real> near = closest_on_triangle(p, a, b, c);
      const bool is_better = near.distance_squared < limit ||
                             (near.distance_squared == limit && (!best || bvh.order[k] < best->triangle));
      if (!is_better) continue;
      limit = near.distance_squared;
      best = {bvh.order[k], near.point, near.distance_squared, near.weights};
    }
    return static_cast<double>(limit);
  };
  const auto bound = [&](const BvhNode& node) {
    return static_cast<double>(slack * distance_squared(box_of_node(node), p));
  };
  visit_near_to_far(bvh, static_cast<double>(limit), bound, visit);
  return best;
}

std::optional<BvhHit> cast_ray(const Bvh& bvh, DVec3 origin, DVec3 direction, double fraction_max) {
  if (direction == DVec3{}) return {};
  const RaySlabs ray = RaySlabs::of(origin, direction);
  std::optional<BvhHit> best;
  double limit = fraction_max;
  const auto visit = [&](const BvhNode& leaf) {
    for (std::uint32_t k = leaf.next; k < leaf.next + leaf.count; ++k) {
      const double fraction = line_hits_triangle(origin, direction, in_double(bvh.corners[k])).fraction;
      if (!std::isfinite(fraction) || fraction < 0.0) continue;
      const bool is_better =
          fraction < limit || (fraction == limit && (!best || bvh.order[k] < best->triangle));
      if (!is_better) continue;
      limit = fraction;
      best = {bvh.order[k], fraction};
    }
    return limit;
  };
  visit_near_to_far(
      bvh, limit, [&](const BvhNode& node) { return ray.enter(box_of_node(node)); }, visit);
  return best;
}

}  // namespace hooke::geometry
