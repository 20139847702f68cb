#pragma once

#include "geometry/mesh/bvh.h"

#include <vector>

namespace hooke::geometry {

/// The triangles below a node of the tree, as a point far away sees them.
struct WindingCluster {
  DVec3 center = {};       ///< Mean of the triangles' centers, weighed by area [m].
  DVec3 area_normal = {};  ///< Sum of the triangles' normals times their areas [m^2].
  double radius = 0;       ///< Distance from the center to the farthest corner of the node's box [m].
};

/// Half the solid angle under which the point sees the triangle from its inner side (Van Oosterom and
/// Strackee 1983, The solid angle of a plane triangle).
[[nodiscard]] double half_solid_angle(const std::array<DVec3, 3>& corners, DVec3 p);

/// A tree that tells how often a surface winds about a point, also if the surface is open, crosses itself or
/// has triangles twice: the generalized winding number (Jacobson, Kavan and Sorkine-Hornung 2013, Robust
/// inside-outside segmentation), with far triangles taken together (Barill et al. 2018, Fast winding numbers
/// for soups and clouds).
struct WindingTree {
  Bvh bvh = {};
  std::vector<WindingCluster> clusters = {};  ///< One for each node of `bvh`.
};

/// Makes the tree; see build_bvh for what it takes.
[[nodiscard]] WindingTree build_winding_tree(std::span<const Vec3> positions,
                                             std::span<const Triangle> triangles);

/// Returns the sum of the solid angles under which the point sees the triangles, over that of a whole sphere:
/// 1 inside a closed surface that faces outward, 0 outside, between them near a hole. On the surface it is
/// the value of either side. Clusters that are farther than 2.5 of their radii count as one dipole, which
/// leaves an error of a few hundredths.
[[nodiscard]] double winding_number(const WindingTree& tree, DVec3 p);

}  // namespace hooke::geometry
