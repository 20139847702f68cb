#pragma once

#include "lab/shape/mesh_contacts.h"

namespace hooke::collision {

/// A MeshGap tells how far two solids of triangles are apart.
struct MeshGap {
  /// Distance [m]; negative: minus the largest depth of their contacts.
  double distance = 0;
  DVec3 normal = {0.0, 1.0, 0.0};  ///< Unit vector from a to b.
};

/// Returns the gap of two solids. Apart, it is the least distance of a vertex and a face or of two edges.
/// Where they touch or overlap, it is that of the deepest contact of find_mesh_contacts. What is farther
/// apart than `reach` [m] (positive), or not finite, is reported as `reach` apart. Both ways of search give
/// the same bits; the search by tree uses a margin that grows until it holds the nearest pair.
[[nodiscard]] MeshGap find_mesh_gap(const geometry::ContactMesh& a, const geometry::RigidPose& pose_a,
                                    const geometry::ContactMesh& b, const geometry::RigidPose& pose_b,
                                    double reach, geometry::Search search);

}  // namespace hooke::collision
