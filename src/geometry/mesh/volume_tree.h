#pragma once

#include "geometry/mesh/bounding.h"
#include "geometry/mesh/triangle_overlap.h"
#include "geometry/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Trees of volumes over triangles, with one template for spheres, boxes along the axes and oriented boxes:
/// the recursive bounding objects of the paper (4.5.2). They are for two moving meshes; rays and points of
/// the world use the tree of geometry/mesh/bvh.h.

namespace hooke::geometry {

/// Nodes lie in depth-first order: the first child follows its parent, the second child what is below the
/// first.
template <class Volume>
struct VolumeTree {
  struct Node {
    Volume volume = {};
    std::uint32_t first = 0;  ///< The node's triangles are order[first, first + count).
    std::uint32_t count = 0;
    std::uint32_t next = 0;  ///< The node that follows everything below it; for a leaf the next node.
  };
  static constexpr std::uint32_t kLeafSize = 2;

  std::vector<Node> nodes = {};           ///< Empty without triangles.
  std::vector<std::uint32_t> order = {};  ///< The triangles in the order of the leaves.

  [[nodiscard]] bool is_leaf(std::uint32_t node) const { return nodes[node].next == node + 1; }
};

using SphereTree = VolumeTree<BoundingSphere>;
using BoxTree = VolumeTree<DBox>;
using OrientedBoxTree = VolumeTree<OrientedBox>;

/// Triangles and the positions of their corners.
struct MeshView {
  std::span<const DVec3> positions = {};
  std::span<const Triangle> triangles = {};

  [[nodiscard]] DTriangle corners(std::uint32_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {positions[t[0]], positions[t[1]], positions[t[2]]};
  }
};

/// Builds the tree of the triangles. Nodes are halved along the longest extent of the middles of their
/// triangles (oriented boxes: along the longest of their own axes). The tree is the same on every machine.
/// Oriented boxes lie along the principal axes of the surface (Gottschalk, Lin and Manocha 1996), or along
/// the coordinate axes where that box is smaller. Spheres are the smallest around a node's corners.
template <class Volume>
[[nodiscard]] VolumeTree<Volume> build_volume_tree(const MeshView& mesh);

/// Fits the volumes to moved vertices. The structure of the tree stays, and so do the axes of oriented boxes.
/// Precondition: the triangles that the tree was built from.
template <class Volume>
void refit(VolumeTree<Volume>& tree, const MeshView& mesh);

using TrianglePair = std::pair<std::uint32_t, std::uint32_t>;

/// Adds the pairs of triangles (of a, of b) in leaves that may be within `margin` [m], in no order. Returns
/// how many pairs of volumes were compared.
template <class Volume>
std::uint64_t find_candidates(const VolumeTree<Volume>& a, const VolumeTree<Volume>& b,
                              const RigidPose& b_in_a, double margin, std::vector<TrianglePair>& found);

}  // namespace hooke::geometry
