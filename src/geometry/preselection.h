#pragma once

#include "geometry/volume_tree.h"

#include <cstdint>
#include <vector>

/// \file
/// The choice of what tells first that two meshes cannot touch (the paper's preselection, 4.3.1, and its
/// bounding objects, 4.5.2), so that the choices can be compared.

namespace hooke::geometry {

enum class Preselection : std::uint8_t {
  kAllPairs,      ///< All pairs of triangles.
  kVertexSphere,  ///< The paper's sphere about the mean vertex.
  kSphere,        ///< The smallest.
  kBox,           ///< Along the axes of the world.
  kOrientedBox,   ///< Tight, turning with the mesh.
  kSphereTree,
  kBoxTree,  ///< Boxes along the axes of each mesh's own frame.
  kOrientedBoxTree,
};

inline constexpr Preselection kPreselections[] = {Preselection::kAllPairs,    Preselection::kVertexSphere,
                                                  Preselection::kSphere,      Preselection::kBox,
                                                  Preselection::kOrientedBox, Preselection::kSphereTree,
                                                  Preselection::kBoxTree,     Preselection::kOrientedBoxTree};

/// "all_pairs", "vertex_sphere", "sphere", "box", "oriented_box", "sphere_tree", "box_tree",
/// "oriented_box_tree".
[[nodiscard]] const char* name_of(Preselection preselection);

/// The volumes of a mesh, all of them, made once.
struct BoundingVolumes {
  std::vector<DVec3> positions = {};
  std::uint32_t triangle_count = 0;
  BoundingSphere vertex_sphere = {}, sphere = {};
  OrientedBox oriented_box = {};
  SphereTree sphere_tree = {};
  BoxTree box_tree = {};
  OrientedBoxTree oriented_box_tree = {};
};

[[nodiscard]] BoundingVolumes make_bounding_volumes(const MeshView& mesh);

/// The box around the mesh where it is, along the axes of the world: it changes as the mesh turns.
[[nodiscard]] DBox world_box(const BoundingVolumes& volumes, const RigidPose& pose);

struct Candidates {
  std::uint64_t volumes_compared = 0;  ///< Pairs of volumes.
  std::uint64_t pairs_left = 0;        ///< Of triangles, which only a test of their own can tell apart.
};

/// How many pairs of triangles of two meshes are left by one choice. None that overlap is lost.
[[nodiscard]] Candidates count_candidates(Preselection preselection, const BoundingVolumes& a,
                                          const RigidPose& pose_a, const BoundingVolumes& b,
                                          const RigidPose& pose_b);

}  // namespace hooke::geometry
