#pragma once

#include "hooke/geometry.h"

#include "geometry/mesh/volume_tree.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Applies every Preselection of two meshes, so that the choices can be compared.

namespace hooke::geometry {

/// The bounding volumes of a mesh, made once.
struct BoundingVolumes {
  std::vector<DVec3> positions = {};
  std::uint32_t triangle_count = 0;
  BoundingSphere vertex_sphere = {}, sphere = {};
  OrientedBox oriented_box = {};
  SphereTree sphere_tree = {};
  BoxTree box_tree = {};
  OrientedBoxTree oriented_box_tree = {};
};

/// Makes the volumes of the given kinds; the others stay empty.
[[nodiscard]] BoundingVolumes make_bounding_volumes(const MeshView& mesh,
                                                    std::span<const Preselection> kinds = kPreselections);

/// The box along the axes of the world around the mesh at its pose. It changes as the mesh rotates.
[[nodiscard]] DBox world_box(const BoundingVolumes& volumes, const RigidPose& pose);

struct Candidates {
  std::uint64_t volumes_compared = 0;  ///< Pairs of volumes.
  std::uint64_t pairs_left = 0;        ///< Pairs of triangles, which need a test of their own.
};

/// Counts the pairs of triangles of two meshes that are left by one choice. No pair within `margin` [m] of
/// each other is lost.
[[nodiscard]] Candidates count_candidates(Preselection preselection, const BoundingVolumes& a,
                                          const RigidPose& pose_a, const BoundingVolumes& b,
                                          const RigidPose& pose_b, double margin = 0);

}  // namespace hooke::geometry
