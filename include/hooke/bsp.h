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
/// A solid as a tree of planes (BSP, the paper's 5.2.2), for questions: is a point inside, where does a ray,
/// a point or a sphere run into it, what hides what. Needs no World; World::add_mesh takes one for a mesh if
/// asked to. Why planes are exact: docs/decisions/0009-bsp.md.
///
///     BspTree tree = build_bsp(mesh).value();
///     if (is_solid_at(tree, eye)) ...
///     if (auto hit = move_sphere(tree, eye, step, 0.3)) eye += hit->fraction * step;
///
/// Read in this order: BspTree, build_bsp, the questions, save_bsp.

namespace hooke {

// A child that is no node.
inline constexpr std::uint32_t kBspEmpty = 0xFFFFFFFE;
inline constexpr std::uint32_t kBspSolid = 0xFFFFFFFF;
inline constexpr bool is_bsp_leaf(std::uint32_t child) {
  return child >= kBspEmpty;
}

struct BspNode {
  DVec3 normal = {};                ///< Unit.
  double offset = 0;                ///< dot(normal, p) = offset in the plane [m].
  std::uint32_t above = kBspEmpty;  ///< Node, kBspEmpty or kBspSolid; a node comes before those below it.
  std::uint32_t below = kBspSolid;
  std::uint32_t first_face = 0;  ///< The faces that lie in the plane.
  std::uint32_t face_count = 0;
};

/// A convex piece of a triangle.
struct BspFace {
  std::uint32_t triangle = 0;      ///< Of the mesh.
  std::uint32_t first_corner = 0;  ///< In BspTree::corners; counter-clockwise seen from outside.
  std::uint32_t corner_count = 0;
};

struct BspTree {
  std::vector<BspNode> nodes = {};  ///< The first is the root; without any all is empty.
  std::vector<BspFace> faces = {};
  std::vector<DVec3> corners = {};  ///< [m]
};

/// The tree of the solid that a mesh bounds. The mesh may be inside out, have double or flat triangles and
/// T-junctions; cavities and several shells are fine. Errors name the triangles of a mesh that is open, faces
/// opposite sides, goes through itself or lies on itself, or say what limit is exceeded. The same tree on
/// every machine. Takes 0.4 s for a building of 100,000 triangles.
[[nodiscard]] Result<BspTree> build_bsp(const MeshDesc& mesh);

/// Below, "to rounding" means: the answer is right for the tree with its planes moved by some units in the
/// last place of the coordinates (1e-15 of them). Trees are those of build_bsp and load_bsp. Rays have any
/// length; what is not finite is nowhere and hits nothing.

/// Whether the point is in the solid, to rounding; on the surface either.
[[nodiscard]] bool is_solid_at(const BspTree& tree, DVec3 p);

struct BspHit {
  double fraction = 0;  ///< The hit is at origin + fraction * motion.
  DVec3 normal = {};    ///< Unit, from the solid to the point or the center; zero if the start is inside.
};

/// A place where a ray passes the surface.
struct BspCrossing {
  double fraction = 0;
  std::uint32_t node = 0;
  bool enters = false;  ///< The solid; else it leaves it.
};

/// Where the ray passes the surface, at fractions from 0 to `fraction_max`, in their order; to rounding. A
/// direction of no length passes nothing.
void find_crossings(const BspTree& tree, DVec3 origin, DVec3 direction, double fraction_max,
                    std::vector<BspCrossing>& crossings);

/// The first of them.
[[nodiscard]] std::optional<BspCrossing> cast_ray(
    const BspTree& tree, DVec3 origin, DVec3 direction,
    double fraction_max = std::numeric_limits<double>::infinity());

/// Whose triangle is hit at `p` in the plane of `node`: that of the face around it, or of the nearest. Looks
/// at all faces in the plane. 0xFFFFFFFF for a node without faces.
[[nodiscard]] std::uint32_t triangle_at(const BspTree& tree, std::uint32_t node, DVec3 p);

/// Where a point that moves runs into the solid; nothing if it does not, to rounding. At fraction 0 without a
/// normal if it starts inside.
[[nodiscard]] std::optional<BspHit> move_point(const BspTree& tree, DVec3 origin, DVec3 motion);

/// Where a sphere of `radius` [m], not negative, that moves first touches the solid, to rounding. On the way
/// down planes are moved by the radius to both sides (Melax 2000, Dynamic plane shifting BSP traversal),
/// which finds all faces that it can touch, and some more; on these the time is exact. A sphere that touches
/// or overlaps faces at the start hits one that it moves toward at fraction 0, and those that it moves along
/// or away from not at all; with its center inside it hits at 0 without a normal.
[[nodiscard]] std::optional<BspHit> move_sphere(const BspTree& tree, DVec3 origin, DVec3 motion,
                                                double radius);

/// Replaces `faces` by all faces in painter's order (Fuchs, Kedem and Naylor 1980, On visible surface
/// generation by a priori tree structures): none hides, from the eye, one that comes after it.
void order_back_to_front(const BspTree& tree, DVec3 eye, std::vector<std::uint32_t>& faces);

/// Nodes, leaves and the longest way down.
struct BspSize {
  std::size_t nodes = 0;
  std::size_t faces = 0;
  std::size_t solid_leaves = 0;
  std::size_t empty_leaves = 0;
  std::size_t depth = 0;
};
[[nodiscard]] BspSize size_of(const BspTree& tree);

/// The tree as bytes, little-endian: eight letters "HOOKEBSP", the version, the three counts, then nodes,
/// faces and corners. The same bytes for the same tree on every machine.
[[nodiscard]] std::vector<std::byte> save_bsp(const BspTree& tree);
/// The tree back. Bytes from outside are not trusted: sizes, indices and numbers are checked, every face
/// is of exactly one node, every node but the root is the child of exactly one before it, so that no query
/// runs astray or for ever. One line of error says what is wrong.
[[nodiscard]] Result<BspTree> load_bsp(std::span<const std::byte> bytes);

}  // namespace hooke
