#include "lab/rigid/body_preselection.h"

#include <algorithm>
#include <array>
#include <vector>

namespace hooke::lab {

namespace {

/// A Surface is the surface of a body's shapes, without their skins.
struct Surface {
  std::vector<DVec3> positions = {};
  std::vector<geometry::Triangle> triangles = {};
};

/// A solid without faces, such as the core of a sphere or a capsule, becomes a triangle without area.
void add_solid(const geometry::ConvexSolid& solid, Surface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  const auto last = static_cast<std::uint32_t>(solid.vertices.size()) - 1;
  surface.positions.insert(surface.positions.end(), solid.vertices.begin(), solid.vertices.end());
  bool has_face = false;
  for (const geometry::ConvexSolid::Face& face : solid.faces) {
    for (std::size_t k = 2; k < face.loop.size(); ++k)
      surface.triangles.push_back({first + face.loop[0], first + face.loop[k - 1], first + face.loop[k]});
    has_face = has_face || face.loop.size() > 2;
  }
  if (!has_face) surface.triangles.push_back({first, first, first + last});
}

void add_mesh(const RigidShape& shape, Surface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  for (const Vec3 v : shape.mesh->desc.positions)
    surface.positions.push_back(shape.position + rotate(shape.rotation, vector_cast<double>(v)));
  for (const auto& t : shape.mesh->desc.triangles)
    surface.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

geometry::RigidPose middle_of(const DenseMotion& motion) {
  const BodyMotion at = motion.at(0.5);
  return {at.center, at.rotation};
}

/// Returns how far rotation takes any point of the body from where it is in the middle of the step [m].
double largest_swing(const MovingVolumes& body) {
  const double turn = 0.5 * body.motion.largest_rotation();
  return turn > 0 ? std::min(2.0, turn) * body.radius : 0;
}

}  // namespace

BodyVolumes make_body_volumes(const RigidBody& body, Preselection kind) {
  BodyVolumes result;
  Surface surface;
  for (const RigidShape& shape : body.shapes) {
    result.is_everywhere = result.is_everywhere || shape.kind == ShapeKind::kHalfSpace;
    result.skin = std::max(result.skin, shape.solid.skin);
    if (!shape.solid.vertices.empty()) add_solid(shape.solid, surface);
    if (shape.mesh != nullptr) add_mesh(shape, surface);
  }
  result.volumes =
      geometry::make_bounding_volumes({surface.positions, surface.triangles}, std::span(&kind, 1));
  return result;
}

bool may_collide(Preselection kind, const MovingVolumes& a, const MovingVolumes& b, double reach) {
  if (a.volumes.is_everywhere || b.volumes.is_everywhere) return true;
  const geometry::RigidPose at_a = middle_of(a.motion);
  const geometry::RigidPose at_b = middle_of(b.motion);
  const std::array<DVec3, 4> centers_a = a.motion.centers();
  const std::array<DVec3, 4> centers_b = b.motion.centers();
  // Largest motion of one center against the other; it stays within the hull of the control points.
  double moved = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const DVec3 apart = (centers_b[i] - centers_a[i]) - (at_b.position - at_a.position);
    moved = std::max(moved, length(apart));
  }
  const double margin = reach + a.volumes.skin + b.volumes.skin + moved + largest_swing(a) + largest_swing(b);
  return count_candidates(kind, a.volumes.volumes, at_a, b.volumes.volumes, at_b, margin).pairs_left > 0;
}

}  // namespace hooke::lab
