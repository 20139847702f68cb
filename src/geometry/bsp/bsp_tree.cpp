#include "geometry/bsp/bsp_tree.h"

#include "base/float_environment.h"

#include <algorithm>
#include <array>
#include <utility>

namespace hooke::geometry {

namespace {

/// The exact tree, rounded to double.
BspTree rounded(const BspSpace& space, const Lattice& lattice, const BspPieces& exact) {
  BspTree tree;
  for (const BspSplitNode& node : exact.nodes) {
    const BspPlane& plane = space.plane(node.plane);
    const double offset = dot(plane.normal, lattice.origin) - lattice.step * plane.offset;
    tree.nodes.push_back({plane.normal, offset, node.above, node.below, node.first_face, node.face_count});
  }
  for (const BspPiece& piece : exact.faces) {
    tree.faces.push_back({piece.triangle, static_cast<std::uint32_t>(tree.corners.size()),
                          static_cast<std::uint32_t>(piece.corners.size())});
    for (const BspCorner& corner : piece.corners) {
      tree.corners.push_back(lattice.place_of(space.point(corner.point).place));
    }
  }
  return tree;
}

}  // namespace

Result<BspTree> build_bsp(const SolidMesh& mesh) {
  const std::array<const SolidMesh*, 1> meshes = {&mesh};
  const Result<Lattice> lattice = make_lattice(meshes);
  if (!lattice) return lattice.error();
  BspSpace space;
  const auto pieces = make_solid_pieces(space, lattice.value(), mesh);
  if (!pieces) return pieces.error();
  const auto exact = build_solid_tree(space, pieces.value());
  if (!exact) return exact.error();
  return rounded(space, lattice.value(), exact.value());
}

Result<BspTree> build_painters_bsp(const SolidMesh& mesh) {
  const std::array<const SolidMesh*, 1> meshes = {&mesh};
  const Result<Lattice> lattice = make_lattice(meshes);
  if (!lattice) return lattice.error();
  BspSpace space;
  std::vector<BspPiece> pieces;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const auto at = [&](std::uint32_t vertex) { return lattice.value().point_of(mesh.positions[vertex]); };
    BspPiece piece = space.add_triangle({at(a), at(b), at(c)}, t);
    if (!piece.corners.empty()) pieces.push_back(std::move(piece));
  }
  if (pieces.empty()) return BspTree{};
  const auto exact = build_pieces(space, pieces);
  if (!exact) return exact.error();
  return rounded(space, lattice.value(), exact.value());
}

}  // namespace hooke::geometry

namespace hooke {

Result<BspTree> build_bsp(const MeshDesc& mesh) {
  const base::FloatEnvironment environment;
  return geometry::build_bsp(geometry::solid_mesh_of(mesh));
}

void order_back_to_front(const BspTree& tree, DVec3 eye, std::vector<std::uint32_t>& faces) {
  struct Waiting {
    std::uint32_t child = 0;
    bool is_own = false;  // only the node's own faces remain
  };
  faces.clear();
  std::vector<Waiting> stack;
  if (!tree.nodes.empty()) stack.push_back({0, false});
  while (!stack.empty()) {
    const Waiting next = stack.back();
    stack.pop_back();
    if (is_bsp_leaf(next.child)) continue;
    const BspNode& node = tree.nodes[next.child];
    if (next.is_own) {
      for (std::uint32_t k = 0; k < node.face_count; ++k) faces.push_back(node.first_face + k);
      continue;
    }
    // Parts beyond the plane come first, parts on the eye's side last.
    const bool is_above = dot(node.normal, eye) >= node.offset;
    stack.push_back({is_above ? node.above : node.below, false});
    stack.push_back({next.child, true});
    stack.push_back({is_above ? node.below : node.above, false});
  }
}

BspSize size_of(const BspTree& tree) {
  BspSize size = {.nodes = tree.nodes.size(), .faces = tree.faces.size()};
  std::vector<std::size_t> depth(tree.nodes.size(), 1);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    size.depth = std::max(size.depth, depth[i]);
    for (const std::uint32_t child : {tree.nodes[i].above, tree.nodes[i].below}) {
      if (!is_bsp_leaf(child)) depth[child] = depth[i] + 1;
      size.solid_leaves += child == kBspSolid ? 1 : 0;
      size.empty_leaves += child == kBspEmpty ? 1 : 0;
    }
  }
  return size;
}

}  // namespace hooke
