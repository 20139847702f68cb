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

/// A mesh in place, seen from `origin`, the place that offsets of a meeting are from.
struct PlacedMesh {
  const state::Mesh& mesh;
  Mat3 axes = {};
  Vec3 origin = {};  ///< In the mesh's frame.

  /// The triangle as a convex shape.
  [[nodiscard]] Convex triangle(std::uint32_t index) const;
};

/// How far off a mesh a shape is looked for.
class MeshReach {
 public:
  /// Everywhere within `margin` [m].
  explicit MeshReach(Real margin) : margin_(margin), least_(margin) {}
  /// A part of the margin is for the way of the shape's center in the step, against the mesh [m]: what goes
  /// along a triangle, or away from it, needs none of that.
  MeshReach(Real margin, Vec3 displacement)
      : margin_(margin), least_(margin - length(displacement)), displacement_(displacement) {}

  [[nodiscard]] Real margin() const { return margin_; }
  /// How far apart along the unit vector `n`, from the mesh to the shape, they may be and still meet.
  [[nodiscard]] Real along(Vec3 n) const { return least_ - std::min(dot(n, displacement_), Real(0)); }

 private:
  Real margin_;
  Real least_;  ///< In any direction.
  Vec3 displacement_ = {};
};

/// Replaces `found` by the triangles whose boxes come within reach of the shape's, in ascending order.
void find_triangles_near(const PlacedMesh& a, const Convex& b, const MeshReach& reach,
                         std::vector<std::uint32_t>& found);

/// A direction in which a shape may leave a triangle that it overlaps. `n` is one for the triangle alone; it
/// may lean over the rim, where the surface goes on: in a hollow it would lead through the next triangle.
/// Then it is the front of one of those that meet there, along which the two overlap least. Overwrites
/// `near`.
[[nodiscard]] Vec3 exit_direction(const PlacedMesh& a, std::uint32_t triangle, const Convex& b, Vec3 n,
                                  std::vector<std::uint32_t>& near);

/// Points of a mesh with one normal, and the lowest of their triangles.
struct PatchResult {
  std::uint32_t patch = 0;
  ContactResult result = {};
};

/// Memory for meet_mesh.
struct MeshScratch {
  std::vector<std::uint32_t> triangles = {};
  std::vector<std::uint32_t> near = {};  // triangles at a place
  std::vector<SurfaceContact> contacts = {};
  std::vector<ContactResultPoint> points = {};  // of all contacts, one after the other
  std::vector<std::size_t> first_point = {};    // of each contact, and the number of all
  Ghosts ghosts = {};
  std::vector<PatchResult> patches = {};
  std::vector<PatchResult> unjoined = {};  // patches, before some are joined
  std::vector<std::uint32_t> order = {};   // of those
};

/// A is a mesh, one-sided: only what is in front of a triangle meets it. Replaces scratch.patches, in
/// ascending order. Coplanar triangles are one patch; of more than a few patches those that look in similar
/// directions are joined. Triangles that others cover (find_ghosts) are left out: a mesh
/// feels the same however its faces are cut. Returns a distance that they are at least apart if there are no
/// patches [m].
Real collide_mesh(const PlacedMesh& a, const Convex& b, const MeshReach& reach, MeshScratch& scratch);

}  // namespace hooke::collision
