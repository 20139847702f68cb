#pragma once

#include "geometry/mesh/contact_mesh.h"

#include <cstdint>
#include <vector>

/// \file
/// Opposing face geometry, an approximation (the paper's 4.5.3, after Soth): of each of two meshes the k
/// faces that most likely face the other are taken, and only those are tested against each other. It reads
/// every face once and tests at most k^2 pairs, where brute force tests n m; what it misses is measured by
/// `hooke bench ofg`. Nothing in the engine relies on it.

namespace hooke::collision {

struct OpposingFaces {
  /// The k faces of each in the order of step 6: the nearest to the other selection first.
  std::vector<std::uint32_t> faces_a = {}, faces_b = {};
  std::vector<geometry::TrianglePair> overlapping = {};  ///< Pairs of them that overlap, in order of testing.
  std::uint32_t pairs_tested = 0;
  int last_step = 0;  ///< Where it ended: 0 or 5 by spheres that are apart, 7 after the test of pairs.
};

/// Replaces `result` by the steps of the paper, which counts six between its pre-selection and its test:
///
/// 0. Ends if the bounding spheres of the meshes are apart.
/// 1. The k faces of a whose middles are nearest to the center of b's bounding sphere.
/// 2. The mean of their middles, and the sphere about it around their corners.
/// 3. The k faces of b whose middles are nearest to that mean.
/// 4. Their mean and sphere.
/// 5. Ends if the two spheres are apart.
/// 6. Both sets in order of distance from the mean of the other.
/// 7. The pairs of both sets, in order of the sum of their places: which overlap (exactly).
///
/// `k` below one is taken as one. Of equally near faces the first is taken. Total for finite poses with
/// rotations of length one; for others nothing overlaps.
void find_opposing_faces(const geometry::ContactMesh& a, const geometry::RigidPose& pose_a,
                         const geometry::ContactMesh& b, const geometry::RigidPose& pose_b, int k,
                         OpposingFaces& result);

}  // namespace hooke::collision
