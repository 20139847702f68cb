#pragma once

#include "geometry/mesh/contact_mesh.h"

#include <cstdint>
#include <vector>

/// \file
/// Selects opposing face geometry, an approximation (the paper's 4.5.3, after Soth). Of each of two meshes it
/// takes the k faces that most likely face the other, and tests only those against each other. It reads every
/// face once and tests at most k^2 pairs, where brute force tests n m. `hooke bench ofg` measures what it
/// misses. Nothing in the engine relies on it.

namespace hooke::collision {

struct OpposingFaces {
  /// The k faces of each, in the order of step 6: the nearest to the other selection first.
  std::vector<std::uint32_t> faces_a = {}, faces_b = {};
  std::vector<geometry::TrianglePair> overlapping = {};  ///< Pairs of them that overlap, in order of testing.
  std::uint32_t pairs_tested = 0;
  /// The last step done: 0 or 5 if spheres are apart, 7 after the test of pairs.
  int last_step = 0;
};

/// Replaces `result` by the outcome of the steps of the paper, which counts six between its pre-selection and
/// its test:
///
/// 0. It ends if the bounding spheres of the meshes are apart.
/// 1. It takes the k faces of a whose middles are nearest to the center of b's bounding sphere.
/// 2. It takes the mean of their middles, and the sphere about it around their corners.
/// 3. It takes the k faces of b whose middles are nearest to that mean.
/// 4. It takes their mean and sphere.
/// 5. It ends if the two spheres are apart.
/// 6. It sorts both sets by distance from the mean of the other.
/// 7. It tests the pairs of both sets exactly, in order of the sum of their indices.
///
/// A `k` below one is taken as one. Of equally near faces the first is taken. It is defined for all finite
/// poses with unit rotations; for others nothing overlaps.
void find_opposing_faces(const geometry::ContactMesh& a, const geometry::RigidPose& pose_a,
                         const geometry::ContactMesh& b, const geometry::RigidPose& pose_b, int k,
                         OpposingFaces& result);

}  // namespace hooke::collision
