#pragma once

#include "geometry/box.h"
#include "geometry/triangle_mesh.h"

#include <limits>
#include <optional>

namespace hooke::geometry {

/// A node of the tree. Nodes lie in depth-first order: the first child follows its parent, and the second
/// child follows everything below the first.
struct BvhNode {
  Vec3 lower = {};
  std::uint32_t next =
      0;  ///< Inner node: the node that follows everything below it. Leaf: its first triangle in `order`.
  Vec3 upper = {};
  std::uint32_t count = 0;  ///< Triangles of a leaf; 0 for an inner node.
};
static_assert(sizeof(Real) != sizeof(float) || sizeof(BvhNode) == 32, "two nodes in a cache line");

/// A static tree of boxes over triangles: the same tree for the same triangles on every machine.
struct Bvh {
  std::vector<BvhNode> nodes = {};                ///< Empty without triangles.
  std::vector<std::uint32_t> order = {};          ///< The triangles in the order of the leaves.
  std::vector<std::array<Vec3, 3>> corners = {};  ///< Corners of the triangles, in the order of the leaves.
};

/// Binned surface-area splits (Wald, 2007, On fast construction of SAH-based bounding volume hierarchies),
/// median splits once the tree gets deep. At most 2^25 triangles, all coordinates finite.
Bvh build_bvh(std::span<const Vec3> positions, std::span<const Triangle> triangles);

/// Replaces `found` by the triangles whose own boxes overlap `box`, in ascending order.
void find_triangles(const Bvh& bvh, const Box& box, std::vector<std::uint32_t>& found);

struct BvhEntry {
  std::uint32_t triangle = 0;
  double fraction = 0.0;  ///< Fraction of the motion, in [0, 1].
};

/// Replaces `found` by the triangles whose boxes, grown by `radius` on every side, are entered by the segment
/// from `origin` over `motion`, and the fractions where it enters; in order of (fraction, triangle). The
/// motion may be zero.
void find_triangles_on_path(const Bvh& bvh, DVec3 origin, DVec3 motion, double radius,
                            std::vector<BvhEntry>& found);

struct BvhClosest {
  std::uint32_t triangle = 0;
  Vec3 point = {};
  Real distance_squared = Real(0);
  Vec3 weights = {};  ///< Weights of the triangle's corners, see closest_on_triangle.
};

/// The triangle point nearest to `p` that is not farther than `distance_max` [m] (not negative, may be
/// infinite); of equally near triangles the one with the smallest index. Nothing if there is none.
std::optional<BvhClosest> find_closest(const Bvh& bvh, Vec3 p,
                                       Real distance_max = std::numeric_limits<Real>::infinity());

struct BvhHit {
  std::uint32_t triangle = 0;
  double fraction = 0.0;  ///< The hit is at origin + fraction direction.
};

/// The first triangle that the ray hits at a fraction in [0, fraction_max], from either side. Of equally near
/// ones it is the one with the smallest index. A ray through an edge or corner that triangles share hits at
/// least one of them. Finds nothing for a direction of no length. Triangles seen edge-on are not hit.
std::optional<BvhHit> cast_ray(const Bvh& bvh, DVec3 origin, DVec3 direction,
                               double fraction_max = std::numeric_limits<double>::infinity());

}  // namespace hooke::geometry
