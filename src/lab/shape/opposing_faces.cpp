#include "lab/shape/opposing_faces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hooke::collision {

namespace {

using geometry::BoundingSphere;
using geometry::ContactMesh;
using geometry::DTriangle;
using geometry::MeshView;
using geometry::RigidPose;

using Faces = std::vector<std::uint32_t>;

DVec3 middle_of(const DTriangle& t) {
  return 1.0 / 3.0 * (t[0] + t[1] + t[2]);
}

/// Returns the `k` faces nearest to `p`, nearest first.
Faces nearest(const MeshView& mesh, Faces faces, DVec3 p, int k) {
  std::vector<std::pair<double, std::uint32_t>> ranked;
  ranked.reserve(faces.size());
  for (const std::uint32_t t : faces) ranked.emplace_back(length_squared(middle_of(mesh.corners(t)) - p), t);
  const auto count = std::min<std::size_t>(static_cast<std::size_t>(std::max(k, 1)), ranked.size());
  const auto end = ranked.begin() + static_cast<std::ptrdiff_t>(count);
  if (end != ranked.end()) std::nth_element(ranked.begin(), end - 1, ranked.end());
  std::sort(ranked.begin(), end);
  faces.clear();
  for (auto entry = ranked.begin(); entry != end; ++entry) faces.push_back(entry->second);
  return faces;
}

Faces all_faces(const MeshView& mesh) {
  Faces faces(mesh.triangles.size());
  std::iota(faces.begin(), faces.end(), 0u);
  return faces;
}

/// Returns a sphere about the mean of the middles, around the corners.
BoundingSphere sphere_around(const MeshView& mesh, const Faces& faces) {
  DVec3 sum = {};
  for (const std::uint32_t t : faces) sum += middle_of(mesh.corners(t));
  BoundingSphere sphere = {1 / static_cast<double>(faces.size()) * sum, 0};
  for (const std::uint32_t t : faces) {
    for (const DVec3& p : mesh.corners(t)) sphere.radius = std::max(sphere.radius, length(p - sphere.center));
  }
  return sphere;
}

}  // namespace

void find_opposing_faces(const ContactMesh& a, const RigidPose& pose_a, const ContactMesh& b,
                         const RigidPose& pose_b, int k, OpposingFaces& result) {
  result = {};
  if (a.triangles.empty() || b.triangles.empty()) return;
  const RigidPose a_in_b = relative_pose(pose_a, pose_b);
  const BoundingSphere sphere_a = {to_world(a_in_b, a.sphere.center), a.sphere.radius};
  // Step 0, which is also the end for a pose that is not a number.
  if (!may_overlap(b.sphere, sphere_a, {}, 0)) return;
  std::vector<DVec3> moved;
  moved.reserve(a.positions.size());
  for (const DVec3& p : a.positions) moved.push_back(to_world(a_in_b, p));
  const MeshView view_a = {moved, a.triangles};
  const MeshView view_b = b.view();

  const Faces near_a = nearest(view_a, all_faces(view_a), b.sphere.center, k);  // Step 1.
  const BoundingSphere around_a = sphere_around(view_a, near_a);                // Step 2.
  const Faces near_b = nearest(view_b, all_faces(view_b), around_a.center, k);  // Step 3.
  const BoundingSphere around_b = sphere_around(view_b, near_b);                // Step 4.
  // Step 6; the order of 5 and 6 does not matter.
  result.faces_a = nearest(view_a, near_a, around_b.center, k);
  result.faces_b = nearest(view_b, near_b, around_a.center, k);
  result.last_step = 5;
  if (!may_overlap(around_a, around_b, {}, 0)) return;  // Step 5.
  result.last_step = 7;
  const std::size_t count_a = result.faces_a.size();
  const std::size_t count_b = result.faces_b.size();
  for (std::size_t sum = 0; sum + 1 < count_a + count_b; ++sum) {
    for (std::size_t i = sum < count_b ? 0 : sum - count_b + 1; i < count_a && i <= sum; ++i) {
      const std::uint32_t face_a = result.faces_a[i];
      const std::uint32_t face_b = result.faces_b[sum - i];
      ++result.pairs_tested;
      if (geometry::triangles_overlap(view_a.corners(face_a), view_b.corners(face_b))) {
        result.overlapping.emplace_back(face_a, face_b);
      }
    }
  }
}

}  // namespace hooke::collision
