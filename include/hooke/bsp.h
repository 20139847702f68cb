#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

/// \file
/// A solid as a binary tree of planes (BSP, the paper's 5.2.2), which answers questions: is a point inside,
/// where does a ray, a point or a sphere run into the solid, what hides what. It needs no World;
/// World::add_mesh builds one for MeshTree::kPlanes. docs/decisions/0009-bsp.md says why planes are exact.
///
///     BspTree tree = build_bsp(mesh).value();
///     if (is_solid_at(tree, eye)) ...
///     if (auto hit = move_sphere(tree, eye, step, 0.3)) eye += hit->fraction * step;
///
/// Read in this order: BspTree, build_bsp, the questions, save_bsp.

namespace hooke {

/// A child that is no node but a leaf outside the solid.
inline constexpr std::uint32_t kBspEmpty = 0xFFFFFFFE;
/// A child that is no node but a leaf inside the solid.
inline constexpr std::uint32_t kBspSolid = 0xFFFFFFFF;
/// Whether a child is a leaf, kBspEmpty or kBspSolid, and no index of a node.
inline constexpr bool is_bsp_leaf(std::uint32_t child) {
  return child >= kBspEmpty;
}

/// A plane that divides space, with what lies on either side of it. A node stands before its children.
struct BspNode {
  DVec3 normal = {};                ///< Normal of the plane, of unit length.
  double offset = 0;                ///< dot(normal, p) = offset holds for points p of the plane [m].
  std::uint32_t above = kBspEmpty;  ///< Child on the side of the normal: index of a node, or a leaf.
  std::uint32_t below = kBspSolid;  ///< Child on the other side: index of a node, or a leaf.
  std::uint32_t first_face = 0;     ///< Index in BspTree::faces of the first face that lies in the plane.
  std::uint32_t face_count = 0;     ///< Number of faces in the plane; they follow one another.
};

/// A convex piece of a triangle of the surface.
struct BspFace {
  std::uint32_t triangle = 0;  ///< Index of the triangle in the mesh.
  /// Index of the first corner in BspTree::corners. Corners run counter-clockwise, seen from outside.
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;  ///< Number of corners; they follow one another.
};

/// A solid: which parts of space, cut by planes, are inside it.
struct BspTree {
  std::vector<BspNode> nodes = {};  ///< Nodes; the first is the root. Without any, all space is empty.
  std::vector<BspFace> faces = {};  ///< Faces of the surface, ordered by node.
  std::vector<DVec3> corners = {};  ///< Corners of the faces, in the mesh's frame [m].
};

/// Builds the tree of the solid that a mesh bounds. The mesh may be inside out and have double or flat
/// triangles, T-junctions, cavities and several shells. Errors name the triangles of a mesh that is open,
/// faces opposite sides, goes through itself or lies on itself, or say which limit is exceeded. The tree is
/// the same on every machine. A building of 100,000 triangles takes 0.4 s.
[[nodiscard]] Result<BspTree> build_bsp(const MeshDesc& mesh);

// Below, "to rounding" means: the answer is right for the tree with its planes moved by some units in the
// last place of the coordinates (1e-15 of them). Trees are those of build_bsp and load_bsp. Rays have any
// length; a point, ray or motion that is not finite is nowhere and hits nothing.

/// Whether the point is in the solid. On the surface, within rounding (1e-15 of the coordinates), the answer
/// may be either.
[[nodiscard]] bool is_solid_at(const BspTree& tree, DVec3 p);

/// Where a moving point or sphere first touches the solid.
struct BspHit {
  double fraction = 0;  ///< Share of the motion until the hit, at origin + fraction * motion. [0, 1]
  /// Direction from the solid to the point or the sphere's center, of unit length; zero if that starts
  /// inside.
  DVec3 normal = {};
};

/// A place where a ray passes the surface.
struct BspCrossing {
  double fraction = 0;     ///< The place is at origin + fraction * direction.
  std::uint32_t node = 0;  ///< Index of the node whose plane is passed; see triangle_at.
  bool enters = false;     ///< Whether the ray enters the solid there; otherwise it leaves it.
};

/// Finds where the ray passes the surface, at fractions from 0 to `fraction_max`, in their order, to
/// rounding. They replace what `crossings` held. A direction of no length passes nothing.
void find_crossings(const BspTree& tree, DVec3 origin, DVec3 direction, double fraction_max,
                    std::vector<BspCrossing>& crossings);

/// Finds the first place where the ray passes the surface, as find_crossings does; nothing if there is none.
[[nodiscard]] std::optional<BspCrossing> cast_ray(
    const BspTree& tree, DVec3 origin, DVec3 direction,
    double fraction_max = std::numeric_limits<double>::infinity());

/// Finds the triangle at `p` in the plane of `node`, as an index in the mesh: that of the face around `p`, or
/// of the nearest face. It looks at all faces in the plane. 0xFFFFFFFF for a node without faces.
[[nodiscard]] std::uint32_t triangle_at(const BspTree& tree, std::uint32_t node, DVec3 p);

/// Finds where a moving point runs into the solid, to rounding; nothing if it does not. A point that starts
/// inside hits at fraction 0, without a normal.
[[nodiscard]] std::optional<BspHit> move_point(const BspTree& tree, DVec3 origin, DVec3 motion);

/// Finds where a moving sphere of `radius` [m], not negative, first touches the solid, to rounding. The
/// descent moves planes by the radius to both sides (Melax 2000, Dynamic plane shifting BSP traversal), which
/// finds all faces that the sphere can touch, and some more; the time is exact for each of them.
///
/// A sphere that touches or overlaps faces at the start hits one that it moves toward at fraction 0. It does
/// not hit those that it moves along or away from. A sphere with its center inside hits at fraction 0,
/// without a normal.
[[nodiscard]] std::optional<BspHit> move_sphere(const BspTree& tree, DVec3 origin, DVec3 motion,
                                                double radius);

/// Replaces `faces` by the indices of all faces in painter's order (Fuchs, Kedem and Naylor 1980, On visible
/// surface generation by a priori tree structures): none hides, from the eye, one that comes after it.
void order_back_to_front(const BspTree& tree, DVec3 eye, std::vector<std::uint32_t>& faces);

/// How large a tree is.
struct BspSize {
  std::size_t nodes = 0;         ///< Number of nodes.
  std::size_t faces = 0;         ///< Number of faces.
  std::size_t solid_leaves = 0;  ///< Number of leaves inside the solid.
  std::size_t empty_leaves = 0;  ///< Number of leaves outside it.
  std::size_t depth = 0;         ///< Number of nodes on the longest way from the root to a leaf.
};
/// Counts the nodes, faces and leaves of a tree.
[[nodiscard]] BspSize size_of(const BspTree& tree);

/// Writes the tree as bytes, little-endian: the eight letters "HOOKEBSP", the version, the three counts, then
/// nodes, faces and corners. The same tree gives the same bytes on every machine.
[[nodiscard]] std::vector<std::byte> save_bsp(const BspTree& tree);
/// Reads a tree back. Bytes from outside are not trusted: sizes, indices and numbers are checked. Every face
/// must belong to exactly one node, and every node but the root must be the child of exactly one node before
/// it, so that every query ends. The Error says in one line what is wrong.
[[nodiscard]] Result<BspTree> load_bsp(std::span<const std::byte> bytes);

}  // namespace hooke
