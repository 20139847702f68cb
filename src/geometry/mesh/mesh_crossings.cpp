#include "geometry/mesh/mesh_clean.h"
#include "geometry/orientation.h"

#include <algorithm>

namespace hooke::geometry {

namespace {

/// Whether `p` and `q`, in one plane with the segment, lie on the same side of it: then the triangles are
/// folded back.
bool is_folded(DVec3 from, DVec3 to, DVec3 p, DVec3 q) {
  if (orientation(from, to, p, q) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const Point2 a = seen_along(axis, from);
    const Point2 b = seen_along(axis, to);
    const int side = orientation(a, b, seen_along(axis, p));
    if (side != 0) return side == orientation(a, b, seen_along(axis, q));
  }
  return false;
}

}  // namespace

bool triangles_cross(const MeshView& mesh, std::uint32_t a, std::uint32_t b) {
  // Shared corners come first in both triangles.
  Triangle of_a = mesh.triangles[a];
  Triangle of_b = mesh.triangles[b];
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto same = std::find(of_b.begin() + static_cast<std::ptrdiff_t>(shared), of_b.end(), of_a[i]);
    if (same == of_b.end()) continue;
    std::swap(of_a[shared], of_a[i]);
    std::iter_swap(of_b.begin() + static_cast<std::ptrdiff_t>(shared), same);
    ++shared;
  }
  const auto at = [&](std::uint32_t vertex) { return mesh.positions[vertex]; };
  const DTriangle corners_a = {at(of_a[0]), at(of_a[1]), at(of_a[2])};
  const DTriangle corners_b = {at(of_b[0]), at(of_b[1]), at(of_b[2])};
  switch (shared) {
    case 0:
      return triangles_overlap(corners_a, corners_b);
    case 1:
      return segment_meets_triangle(corners_a[1], corners_a[2], corners_b) ||
             segment_meets_triangle(corners_b[1], corners_b[2], corners_a);
    case 2:
      return is_folded(corners_a[0], corners_a[1], corners_a[2], corners_b[2]);
    default:
      return true;
  }
}

void find_crossings(const MeshView& mesh, std::vector<TrianglePair>& found) {
  const OrientedBoxTree tree = build_volume_tree<OrientedBox>(mesh);
  found.clear();
  find_candidates(tree, tree, {}, 0, found);
  std::erase_if(found, [&](const TrianglePair& pair) {
    return pair.first >= pair.second || !triangles_cross(mesh, pair.first, pair.second);
  });
  std::sort(found.begin(), found.end());
}

}  // namespace hooke::geometry
