#pragma once

#include "hooke/math.h"

#include "collision/distance/distance.h"
#include "collision/manifold/manifold_ghosts.h"
#include "collision/manifold/manifold_points.h"
#include "state/mesh.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace hooke::collision {

/// A mesh in its place, seen from `origin`, the point from which offsets of a contact result are measured.
struct PlacedMesh {
  const state::Mesh& mesh;
  Mat3 axes = {};
  Vec3 origin = {};  ///< The point in the mesh's frame.

  /// The triangle as a convex shape.
  [[nodiscard]] Convex triangle(std::uint32_t index) const;
};

/// Distance from a mesh up to which a shape is searched.
class MeshReach {
 public:
  /// The distance is `margin` [m] in every direction.
  explicit MeshReach(Real margin) : margin_(margin), least_(margin) {}
  /// A part of the margin is for the displacement of the shape's center relative to the mesh in the step [m].
  /// Motion along a triangle or away from it needs none of that part.
  MeshReach(Real margin, Vec3 displacement)
      : margin_(margin), least_(margin - length(displacement)), displacement_(displacement) {}

  [[nodiscard]] Real margin() const { return margin_; }
  /// Distance along the unit vector `n`, from the mesh to the shape, at which they may still meet.
  [[nodiscard]] Real along(Vec3 n) const { return least_ - std::min(dot(n, displacement_), Real(0)); }

 private:
  Real margin_;
  Real least_;  ///< Reach in any direction.
  Vec3 displacement_ = {};
};

/// Replaces `found` by the triangles whose boxes come within reach of the shape's, in ascending order.
void find_triangles_near(const PlacedMesh& a, const Convex& b, const MeshReach& reach,
                         std::vector<std::uint32_t>& found);

/// A direction in which a shape may leave a triangle that it overlaps. `n` is such a direction for the
/// triangle alone. It may tilt over the rim, where the surface goes on: in a hollow it would lead through the
/// next triangle. Then the result is the front of that triangle at the rim along which the two overlap least.
/// Overwrites `near`.
[[nodiscard]] Vec3 exit_direction(const PlacedMesh& a, std::uint32_t triangle, const Convex& b, Vec3 n,
                                  std::vector<std::uint32_t>& near);

/// Points of a mesh with one normal, and the lowest of their triangles.
struct PatchResult {
  std::uint32_t patch = 0;
  ContactResult result = {};
};

/// Memory for collide_mesh.
struct MeshScratch {
  std::vector<std::uint32_t> triangles = {};
  std::vector<std::uint32_t> near = {};  // triangles near a position
  std::vector<SurfaceContact> contacts = {};
  std::vector<ContactResultPoint> points = {};  // of all contacts, one after the other
  std::vector<std::size_t> first_point = {};    // by contact, and the number of all points at the end
  Ghosts ghosts = {};
  std::vector<PatchResult> patches = {};
  std::vector<PatchResult> unjoined = {};  // patches, before some are joined
  std::vector<std::uint32_t> order = {};   // order of those patches
};

/// A is a one-sided mesh: only what is in front of a triangle touches it. Replaces scratch.patches, in
/// ascending order. Coplanar triangles are one patch; if there are more than a few patches, those with
/// similar normals are joined. Triangles that others cover (find_ghosts) are left out, so that a mesh feels
/// the same however its faces are cut. Returns a lower bound of the distance if there are no patches [m].
Real collide_mesh(const PlacedMesh& a, const Convex& b, const MeshReach& reach, MeshScratch& scratch);

}  // namespace hooke::collision
