#include "geometry/mesh/volume_tree.h"

#include "geometry/convex/mass_properties.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace hooke::geometry {

namespace {

using Range = std::span<const std::uint32_t>;

std::vector<DVec3> corners_of(const MeshView& mesh, Range triangles) {
  std::vector<DVec3> points;
  for (const std::uint32_t t : triangles) {
    for (const DVec3& p : mesh.corners(t)) points.push_back(p);
  }
  return points;
}

DVec3 middle_of(const MeshView& mesh, std::uint32_t triangle) {
  const auto [a, b, c] = mesh.corners(triangle);
  return 1.0 / 3.0 * (a + b + c);
}

/// Axes of the second moment of the surface about its middle; without a surface, that of the corners.
Matrix3<double> surface_axes(const MeshView& mesh, Range triangles) {
  const DVec3 origin = mesh.corners(triangles[0])[0];
  const auto square = [](DVec3 p, double s) {
    return math::Symmetric3<double>{s * p.x * p.x, s * p.x * p.y, s * p.x * p.z,
                                    s * p.y * p.y, s * p.y * p.z, s * p.z * p.z};
  };
  double area = 0;
  DVec3 first = {};
  math::Symmetric3<double> second = {};
  for (const std::uint32_t t : triangles) {
    const auto [p, q, r] = mesh.corners(t);
    const DVec3 a = p - origin;
    const DVec3 b = q - origin;
    const DVec3 c = r - origin;
    const double twice = length(cross(b - a, c - a));
    area += twice;
    first += twice / 3 * (a + b + c);
    second = second + square(a + b + c, twice / 12) + square(a, twice / 12) + square(b, twice / 12) +
             square(c, twice / 12);
  }
  if (!(area > 0)) return {};
  return matrix_of(principal_axes(second + square(first, -1 / area)).rotation);
}

void fit(const MeshView& mesh, Range triangles, BoundingSphere& volume) {
  volume = minimum_sphere(corners_of(mesh, triangles));
}
void fit(const MeshView& mesh, Range triangles, DBox& volume) {
  volume = bounds_of(corners_of(mesh, triangles));
}
void fit(const MeshView& mesh, Range triangles, OrientedBox& volume) {
  const std::vector<DVec3> points = corners_of(mesh, triangles);
  volume = box_along({}, points);
  const OrientedBox turned = box_along(surface_axes(mesh, triangles), points);
  const auto half_surface_of = [](const OrientedBox& box) {
    return half_surface(DBox{-box.half_extents, box.half_extents});
  };
  if (half_surface_of(turned) < half_surface_of(volume)) volume = turned;
}

void fit_again(const MeshView& mesh, Range triangles, OrientedBox& volume) {
  volume = box_along(volume.axes, corners_of(mesh, triangles));
}
template <class Volume>
void fit_again(const MeshView& mesh, Range triangles, Volume& volume) {
  fit(mesh, triangles, volume);
}

int longest(DVec3 size) {
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// The direction along which a node is halved.
DVec3 splitting_axis(const MeshView& mesh, Range triangles, const Matrix3<double>& axes) {
  DBox spread;
  for (const std::uint32_t t : triangles) {
    const DVec3 p = transpose(axes) * middle_of(mesh, t);
    spread = merge(spread, p);
  }
  const int axis = longest(spread.upper - spread.lower);
  return axis == 0 ? axes.x : axis == 1 ? axes.y : axes.z;
}

Matrix3<double> axes_of(const OrientedBox& box) {
  return box.axes;
}
template <class Volume>
Matrix3<double> axes_of(const Volume&) {
  return {};
}

/// Adds the node of order[first, first + count) and everything below it. Halving bounds the depth at 25.
template <class Volume>
void add_nodes(const MeshView& mesh, std::uint32_t first, std::uint32_t count, VolumeTree<Volume>& tree) {
  const auto node = static_cast<std::uint32_t>(tree.nodes.size());
  const std::span<std::uint32_t> own = std::span(tree.order).subspan(first, count);
  tree.nodes.push_back({.first = first, .count = count});
  fit(mesh, own, tree.nodes[node].volume);
  if (count > VolumeTree<Volume>::kLeafSize) {
    const DVec3 axis = splitting_axis(mesh, own, axes_of(tree.nodes[node].volume));
    const std::uint32_t half = count / 2;
    std::nth_element(own.begin(), own.begin() + half, own.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tuple(dot(axis, middle_of(mesh, a)), a) < std::tuple(dot(axis, middle_of(mesh, b)), b);
    });
    std::sort(own.begin(), own.begin() + half);
    std::sort(own.begin() + half, own.end());
    add_nodes(mesh, first, half, tree);
    add_nodes(mesh, first + half, count - half, tree);
  }
  tree.nodes[node].next = static_cast<std::uint32_t>(tree.nodes.size());
}

/// Appends every triangle of one leaf with every one of the other.
template <class Volume>
void add_leaf_pairs(const VolumeTree<Volume>& a, std::uint32_t in_a, const VolumeTree<Volume>& b,
                    std::uint32_t in_b, std::vector<TrianglePair>& found) {
  const auto& leaf_a = a.nodes[in_a];
  const auto& leaf_b = b.nodes[in_b];
  for (std::uint32_t i = 0; i < leaf_a.count; ++i) {
    for (std::uint32_t k = 0; k < leaf_b.count; ++k) {
      found.emplace_back(a.order[leaf_a.first + i], b.order[leaf_b.first + k]);
    }
  }
}

}  // namespace

template <class Volume>
VolumeTree<Volume> build_volume_tree(const MeshView& mesh) {
  VolumeTree<Volume> tree;
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  tree.order.resize(count);
  std::iota(tree.order.begin(), tree.order.end(), 0u);
  if (count > 0) add_nodes(mesh, 0, count, tree);
  return tree;
}

template <class Volume>
void refit(VolumeTree<Volume>& tree, const MeshView& mesh) {
  for (auto& node : tree.nodes) {
    fit_again(mesh, Range(tree.order).subspan(node.first, node.count), node.volume);
  }
}

template <class Volume>
std::uint64_t find_candidates(const VolumeTree<Volume>& a, const VolumeTree<Volume>& b,
                              const RigidPose& b_in_a, double margin, std::vector<TrianglePair>& found) {
  if (a.nodes.empty() || b.nodes.empty()) return 0;
  std::uint64_t compared = 0;
  std::vector<TrianglePair> open = {{0, 0}};
  while (!open.empty()) {
    const auto [in_a, in_b] = open.back();
    open.pop_back();
    const auto& node_a = a.nodes[in_a];
    const auto& node_b = b.nodes[in_b];
    ++compared;
    if (!may_overlap(node_a.volume, node_b.volume, b_in_a, margin)) continue;
    const bool is_leaf_a = a.is_leaf(in_a);
    const bool is_leaf_b = b.is_leaf(in_b);
    if (is_leaf_a && is_leaf_b) {
      add_leaf_pairs(a, in_a, b, in_b, found);
    } else if (is_leaf_b || (!is_leaf_a && node_a.count >= node_b.count)) {
      open.emplace_back(a.nodes[in_a + 1].next, in_b);
      open.emplace_back(in_a + 1, in_b);
    } else {
      open.emplace_back(in_a, b.nodes[in_b + 1].next);
      open.emplace_back(in_a, in_b + 1);
    }
  }
  return compared;
}

template SphereTree build_volume_tree(const MeshView&);
template BoxTree build_volume_tree(const MeshView&);
template OrientedBoxTree build_volume_tree(const MeshView&);
template void refit(SphereTree&, const MeshView&);
template void refit(BoxTree&, const MeshView&);
template void refit(OrientedBoxTree&, const MeshView&);
template std::uint64_t find_candidates(const SphereTree&, const SphereTree&, const RigidPose&, double,
                                       std::vector<TrianglePair>&);
template std::uint64_t find_candidates(const BoxTree&, const BoxTree&, const RigidPose&, double,
                                       std::vector<TrianglePair>&);
template std::uint64_t find_candidates(const OrientedBoxTree&, const OrientedBoxTree&, const RigidPose&,
                                       double, std::vector<TrianglePair>&);

}  // namespace hooke::geometry
