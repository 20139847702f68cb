#include "geometry/mesh/preselection.h"

#include <algorithm>

namespace hooke {

const char* name_of(Preselection preselection) {
  constexpr const char* kNames[] = {"all_pairs",    "vertex_sphere", "sphere",   "box",
                                    "oriented_box", "sphere_tree",   "box_tree", "oriented_box_tree"};
  return kNames[static_cast<std::size_t>(preselection)];
}

namespace geometry {

namespace {

template <class Volume>
Candidates by_volume(const Volume& a, const Volume& b, const RigidPose& b_in_a, double margin,
                     std::uint64_t all) {
  return {1, may_overlap(a, b, b_in_a, margin) ? all : 0};
}

template <class Volume>
Candidates by_tree(const VolumeTree<Volume>& a, const VolumeTree<Volume>& b, const RigidPose& b_in_a,
                   double margin) {
  std::vector<TrianglePair> found;
  const std::uint64_t compared = find_candidates(a, b, b_in_a, margin, found);
  return {compared, found.size()};
}

}  // namespace

BoundingVolumes make_bounding_volumes(const MeshView& mesh, std::span<const Preselection> kinds) {
  BoundingVolumes volumes = {.positions = {mesh.positions.begin(), mesh.positions.end()},
                             .triangle_count = static_cast<std::uint32_t>(mesh.triangles.size())};
  const auto wants = [&](Preselection kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  if (wants(Preselection::kVertexSphere)) volumes.vertex_sphere = vertex_sphere(mesh.positions);
  if (wants(Preselection::kSphere)) volumes.sphere = minimum_sphere(mesh.positions);
  if (wants(Preselection::kOrientedBox)) volumes.oriented_box = tight_box(mesh.positions);
  if (wants(Preselection::kSphereTree)) volumes.sphere_tree = build_volume_tree<BoundingSphere>(mesh);
  if (wants(Preselection::kBoxTree)) volumes.box_tree = build_volume_tree<DBox>(mesh);
  if (wants(Preselection::kOrientedBoxTree)) volumes.oriented_box_tree = build_volume_tree<OrientedBox>(mesh);
  return volumes;
}

DBox world_box(const BoundingVolumes& volumes, const RigidPose& pose) {
  DBox box;
  for (const DVec3& p : volumes.positions) {
    const DVec3 q = to_world(pose, p);
    box = merge(box, q);
  }
  return box;
}

Candidates count_candidates(Preselection preselection, const BoundingVolumes& a, const RigidPose& pose_a,
                            const BoundingVolumes& b, const RigidPose& pose_b, double margin) {
  const std::uint64_t all = std::uint64_t{a.triangle_count} * b.triangle_count;
  const RigidPose b_in_a = relative_pose(pose_b, pose_a);
  switch (preselection) {
    case Preselection::kAllPairs:
      break;
    case Preselection::kVertexSphere:
      return by_volume(a.vertex_sphere, b.vertex_sphere, b_in_a, margin, all);
    case Preselection::kSphere:
      return by_volume(a.sphere, b.sphere, b_in_a, margin, all);
    case Preselection::kBox:
      return by_volume(world_box(a, pose_a), world_box(b, pose_b), {}, margin, all);
    case Preselection::kOrientedBox:
      return by_volume(a.oriented_box, b.oriented_box, b_in_a, margin, all);
    case Preselection::kSphereTree:
      return by_tree(a.sphere_tree, b.sphere_tree, b_in_a, margin);
    case Preselection::kBoxTree:
      return by_tree(a.box_tree, b.box_tree, b_in_a, margin);
    case Preselection::kOrientedBoxTree:
      return by_tree(a.oriented_box_tree, b.oriented_box_tree, b_in_a, margin);
  }
  return {0, all};
}

}  // namespace geometry

}  // namespace hooke
