#pragma once

#include "lab/shape/mesh_contacts.h"

namespace hooke::collision {

/// How far apart two solids of triangles are.
struct MeshGap {
  double distance = 0;             ///< [m]; negative: minus the largest depth of their contacts.
  DVec3 normal = {0.0, 1.0, 0.0};  ///< Of length one, from a to b.
};

/// Of solids that are apart the distance of the two places nearest to each other, of a vertex and a face or
/// of two edges; of those that touch or overlap what find_mesh_contacts says of the deepest place. What is
/// farther apart than `reach` [m] (positive) is `reach` apart, and so is all that is not finite. Both ways of
/// search give the same bits; by the tree places are looked for within a margin that grows until it holds
/// one.
[[nodiscard]] MeshGap find_mesh_gap(const geometry::ContactMesh& a, const geometry::RigidPose& pose_a,
                                    const geometry::ContactMesh& b, const geometry::RigidPose& pose_b,
                                    double reach, geometry::Search search);

}  // namespace hooke::collision
