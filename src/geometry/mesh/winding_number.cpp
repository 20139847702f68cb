#include "geometry/mesh/winding_number.h"

#include "math/trig.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke::geometry {

namespace {

constexpr double kFarRadii = 2.5;  // Distance, in radii of a cluster, from which a dipole stands for it.

std::array<DVec3, 3> corners_of(const Bvh& bvh, std::uint32_t place) {
  const auto& [a, b, c] = bvh.corners[place];
  return {vector_cast<double>(a), vector_cast<double>(b), vector_cast<double>(c)};
}

/// The sums over the triangles below a node, before they are divided.
struct ClusterSum {
  DVec3 moment = {};  // Sum of centers times areas [m^3].
  DVec3 area_normal = {};
  double area = 0;  // [m^2]
};

ClusterSum sum_of_leaf(const Bvh& bvh, const BvhNode& leaf) {
  ClusterSum sum;
  for (std::uint32_t place = leaf.next; place < leaf.next + leaf.count; ++place) {
    const auto [a, b, c] = corners_of(bvh, place);
    const DVec3 normal = 0.5 * cross(b - a, c - a);
    const double area = length(normal);
    sum.area += area;
    sum.area_normal += normal;
    sum.moment += area / 3 * (a + b + c);
  }
  return sum;
}

double reach_of(const BvhNode& node, DVec3 center) {
  const DVec3 low = center - vector_cast<double>(node.lower);
  const DVec3 high = vector_cast<double>(node.upper) - center;
  return length(max_of(low, high));
}

}  // namespace

double half_solid_angle(const std::array<DVec3, 3>& corners, DVec3 p) {
  const DVec3 a = corners[0] - p;
  const DVec3 b = corners[1] - p;
  const DVec3 c = corners[2] - p;
  const double la = length(a);
  const double lb = length(b);
  const double lc = length(c);
  const double over = dot(a, cross(b, c));
  const double under = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return over == 0 && under == 0 ? 0 : math::atan2(over, under);
}

WindingTree build_winding_tree(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  WindingTree tree = {.bvh = build_bvh(positions, triangles)};
  const std::vector<BvhNode>& nodes = tree.bvh.nodes;
  std::vector<ClusterSum> sums(nodes.size());
  tree.clusters.resize(nodes.size());
  // Children follow their parents, so that they are known when it is their parent's turn.
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (nodes[i].count > 0) {
      sums[i] = sum_of_leaf(tree.bvh, nodes[i]);
    } else {
      const std::size_t second = nodes[i + 1].count > 0 ? i + 2 : nodes[i + 1].next;
      const ClusterSum& a = sums[i + 1];
      const ClusterSum& b = sums[second];
      sums[i] = {a.moment + b.moment, a.area_normal + b.area_normal, a.area + b.area};
    }
    const DVec3 middle = 0.5 * (vector_cast<double>(nodes[i].lower) + vector_cast<double>(nodes[i].upper));
    const DVec3 center = sums[i].area > 0 ? 1 / sums[i].area * sums[i].moment : middle;
    tree.clusters[i] = {center, sums[i].area_normal, reach_of(nodes[i], center)};
  }
  return tree;
}

double winding_number(const WindingTree& tree, DVec3 p) {
  const std::vector<BvhNode>& nodes = tree.bvh.nodes;
  double half_angles = 0;
  for (std::size_t i = 0; i < nodes.size();) {
    const WindingCluster& cluster = tree.clusters[i];
    const DVec3 offset = cluster.center - p;
    const double distance_squared = dot(offset, offset);
    const double far = kFarRadii * cluster.radius;
    const bool is_leaf = nodes[i].count > 0;
    if (distance_squared > far * far) {
      half_angles +=
          0.5 * dot(cluster.area_normal, offset) / (distance_squared * std::sqrt(distance_squared));
    } else if (is_leaf) {
      for (std::uint32_t k = nodes[i].next; k < nodes[i].next + nodes[i].count; ++k)
        half_angles += half_solid_angle(corners_of(tree.bvh, k), p);
    } else {
      ++i;
      continue;
    }
    i = is_leaf ? i + 1 : nodes[i].next;
  }
  return half_angles / (2 * std::numbers::pi);
}

}  // namespace hooke::geometry
