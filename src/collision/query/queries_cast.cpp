#include "base/assert.h"
#include "collision/continuous/shape_bounds.h"
#include "collision/distance/distance.h"
#include "collision/manifold/manifold_mesh.h"
#include "collision/manifold/manifold_points.h"
#include "collision/query/queries.h"
#include "geometry/closest.h"
#include "math/rotation.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::collision {

namespace {

constexpr double kRounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
// A grazing path closes half of the gap at a time: this is enough for any gap in Real.
constexpr int kMaxAdvances = 96;

/// A shape in its place. `convex` is about `place`, with its center or corners as offsets from there.
struct PlacedConvex {
  Convex convex = {};
  DVec3 place = {};
  double size = 0;  // no point of it is farther from `place` [m]
};

bool is_convex(const state::ColliderShape& shape) {
  const ShapeKind kind = shape.shape.kind;
  return kind != ShapeKind::kHalfSpace && kind != ShapeKind::kMesh && kind != ShapeKind::kCompound;
}

PlacedConvex place_convex(const state::ColliderShape& shape, const Pose& pose) {
  HOOKE_ASSERT(is_convex(shape));
  const geometry::Box box = bounds_of(shape, {{}, pose.rotation});
  const Vec3 farthest = geometry::max_of(-box.lower, box.upper);
  return {{.shape = shape.shape, .axes = matrix_of(normalize(pose.rotation)), .hull = shape.hull.get()},
          pose.position,
          static_cast<double>(length(farthest))};
}

/// A mesh with its position and rotation.
struct StandingMesh {
  const state::Mesh& mesh;
  Pose pose;

  [[nodiscard]] DVec3 to_mesh(DVec3 v) const { return rotate(conjugate(math::in_double(pose.rotation)), v); }

  /// The triangle about its first corner: offsets from there are as small as they can be.
  [[nodiscard]] PlacedConvex triangle(std::uint32_t index) const {
    const Vec3 origin = mesh.desc.positions[mesh.desc.triangles[index][0]];
    const PlacedMesh placed = {mesh, matrix_of(normalize(pose.rotation)), origin};
    const DVec3 offset = rotate(math::in_double(pose.rotation), vector_cast<double>(origin));
    const Convex convex = placed.triangle(index);
    const Real size = std::max(length(convex.corners[1]), length(convex.corners[2]));
    return {convex, pose.position + offset, static_cast<double>(size)};
  }
};

/// Moves A into the neighborhood of B.
Convex seen_from(const PlacedConvex& b, const PlacedConvex& a, DVec3 place) {
  Convex convex = a.convex;
  convex.center = vector_cast<Real>(place - b.place);
  return convex;
}

/// Largest distance at which a sweep ends in front of what it meets [m].
double sweep_tolerance(double size_a, double size_b) {
  return 1e-5 * std::min(size_a, 1.0) + 16 * kRounding * (size_a + size_b);
}

/// The contact of the swept shape A with B.
struct Contact {
  double fraction = 0;
  DVec3 point = {};
  Vec3 normal = {};  // out of B
};

/// For shapes that overlap: the shortest exit, and the deepest point of B.
Contact overlap_contact(const Convex& a, const PlacedConvex& b, DVec3 motion) {
  ContactResult result;
  collide(b.convex, a, {}, result);
  Contact contact = {0, b.place, vector_cast<Real>(geometry::direction_or(-motion, DVec3{0, 1, 0}))};
  if (result.count == 0) return contact;
  const auto* deepest = std::min_element(
      result.point.data(), result.point.data() + result.count,
      [](const ContactResultPoint& p, const ContactResultPoint& q) { return p.separation < q.separation; });
  contact.normal = result.normal;
  contact.point = b.place + vector_cast<double>(deepest->on_a);
  return contact;
}

/// The gap d(t) of two convex shapes, of which one moves straight on, shrinks no faster than the speed along
/// its normal, and that normal separates them for d / speed. What is not met before `limit` may be left out.
std::optional<Contact> sweep(const PlacedConvex& a, DVec3 motion, const PlacedConvex& b, double limit) {
  const double tolerance = sweep_tolerance(a.size, b.size);
  const double rounding = 8 * kRounding * length(motion);
  Contact contact;
  double t = 0;
  for (int i = 0; i < kMaxAdvances && t <= 1; ++i) {
    const Convex convex = seen_from(b, a, a.place + t * motion);
    const Distance near = distance_between(convex, b.convex);
    const auto gap = static_cast<double>(near.distance);
    if (near.cores_overlap || gap <= 0) {
      if (t == 0) return overlap_contact(convex, b, motion);
      return contact;  // rounding went a little too far
    }
    const double speed = dot(vector_cast<double>(near.normal), motion);
    const double left = limit - t;
    contact = {t, b.place + vector_cast<double>(near.point_b), -near.normal};
    if (gap <= tolerance) return gap <= speed * (1 - t) ? std::optional(contact) : std::nullopt;
    if (gap > speed * left + tolerance + rounding * left || !(speed > 0)) return {};
    t += (gap - 0.5 * tolerance - 4 * kRounding * gap) / speed;
    contact.fraction = t;
  }
  return {};
}

std::optional<Contact> sweep_to_half_space(const PlacedConvex& a, DVec3 motion, const Pose& plane) {
  const DVec3 n = rotate(math::in_double(plane.rotation), DVec3{0, 1, 0});
  const Vec3 down = vector_cast<Real>(-n);
  const DVec3 lowest = a.place + vector_cast<double>(support_of(a.convex, down) + skin_of(a.convex) * down);
  const double height = dot(n, lowest - plane.position);
  const double speed = dot(n, motion);
  if (height > 0 && height + speed > 0) return {};
  const double stop = 0.5 * sweep_tolerance(a.size, 0);
  const double t = height > stop ? (stop - height) / speed : 0.0;
  const DVec3 place = lowest + t * motion;
  return Contact{t, place - dot(n, place - plane.position) * n, vector_cast<Real>(n)};
}

struct Sweep {
  const PlacedConvex& shape;
  DVec3 motion;
  DVec3 middle;  // middle of the box around the shape
  double radius;
};

/// Sweeps along the path in the frame of the mesh, over all triangles on it.
std::optional<RayHit> sweep_to_mesh(const Sweep& swept, const StandingMesh& mesh, double limit) {
  const DVec3 origin = mesh.to_mesh(swept.middle - mesh.pose.position);
  // The box rotates with the mesh: the ball around it does not.
  const double radius = std::sqrt(3.0) * swept.radius + 2 * swept.shape.size * kRounding;
  std::vector<geometry::BvhEntry> found;
  geometry::find_triangles_on_path(mesh.mesh.bvh, origin, mesh.to_mesh(swept.motion), radius, found);
  std::optional<RayHit> best;
  for (const geometry::BvhEntry& entry : found) {
    const double end = best ? best->fraction : limit;
    if (entry.fraction > end) break;
    const auto contact = sweep(swept.shape, swept.motion, mesh.triangle(entry.triangle), end);
    if (!contact || (best && !(contact->fraction < best->fraction))) continue;
    best = RayHit{0, entry.triangle, contact->fraction, contact->point, contact->normal};
  }
  return best;
}

std::optional<RayHit> sweep_to_collider(const QueryScene& scene, const Sweep& swept, std::uint32_t collider,
                                        double limit) {
  const state::ColliderShape& shape = scene.colliders.shape[collider];
  const Pose pose = state::frame_of_collider(scene.bodies, scene.colliders, collider);
  if (shape.shape.kind == ShapeKind::kMesh) {
    std::optional<RayHit> hit = sweep_to_mesh(swept, {*shape.mesh, pose}, limit);
    if (hit) hit->collider = collider;
    return hit;
  }
  const auto contact = is_convex(shape) ? sweep(swept.shape, swept.motion, place_convex(shape, pose), limit)
                                        : sweep_to_half_space(swept.shape, swept.motion, pose);
  if (!contact) return {};
  return RayHit{collider, 0, contact->fraction, contact->point, contact->normal};
}

bool overlaps(const PlacedConvex& a, const PlacedConvex& b) {
  const Distance near = distance_between(seen_from(b, a, a.place), b.convex);
  return near.cores_overlap || near.distance <= Real(0);
}

bool overlaps_mesh(const state::ColliderShape& shape, const Pose& pose, const StandingMesh& mesh) {
  const PlacedConvex a = place_convex(shape, pose);
  const Pose in_mesh = {mesh.to_mesh(pose.position - mesh.pose.position),
                        conjugate(mesh.pose.rotation) * pose.rotation};
  std::vector<std::uint32_t> found;
  geometry::find_triangles(mesh.mesh.bvh, bounds_of(shape, in_mesh), found);
  return std::any_of(found.begin(), found.end(),
                     [&](std::uint32_t triangle) { return overlaps(a, mesh.triangle(triangle)); });
}

/// Whether a convex shape overlaps any shape.
bool convex_overlaps(const state::ColliderShape& a, const Pose& pose_a, const state::ColliderShape& b,
                     const Pose& pose_b) {
  if (b.shape.kind == ShapeKind::kMesh) return overlaps_mesh(a, pose_a, {*b.mesh, pose_b});
  const PlacedConvex placed = place_convex(a, pose_a);
  if (is_convex(b)) return overlaps(placed, place_convex(b, pose_b));
  return sweep_to_half_space(placed, {}, pose_b).has_value();
}

}  // namespace

std::optional<RayHit> cast_shape(const QueryScene& scene, const state::ColliderShape& shape,
                                 const Pose& start, DVec3 motion) {
  const PlacedConvex placed = place_convex(shape, start);
  const geometry::Box box = bounds_of(shape, {{}, start.rotation});
  const Vec3 half = Real(0.5) * (box.upper - box.lower);
  const Real radius = std::max({half.x, half.y, half.z});
  const DVec3 middle = start.position + vector_cast<double>(Real(0.5) * (box.lower + box.upper));
  const Sweep swept = {placed, motion, middle, static_cast<double>(radius)};

  // The order of the tree is not used: its history must not choose among hits that are equal within the
  // tolerance.
  std::vector<std::uint32_t> near;
  scene.broad_phase.query_sweep(middle, motion, radius, near);
  sort_by_creation(scene, near);
  std::optional<RayHit> best;
  for (const std::uint32_t collider : near) {
    if (!can_be_found(scene, collider)) continue;
    const auto hit = sweep_to_collider(scene, swept, collider, best ? best->fraction : 1.0);
    if (hit && (!best || hit->fraction < best->fraction)) best = hit;
  }
  return best;
}

void find_overlaps(const QueryScene& scene, const state::ColliderShape& shape, const Pose& pose,
                   std::vector<std::uint32_t>& found) {
  scene.broad_phase.query(bounds_of(shape, pose), found);
  std::erase_if(found, [&](std::uint32_t collider) {
    return !can_be_found(scene, collider) ||
           !convex_overlaps(shape, pose, scene.colliders.shape[collider],
                            state::frame_of_collider(scene.bodies, scene.colliders, collider));
  });
  sort_by_creation(scene, found);
}

bool shapes_overlap(const state::ColliderShape& a, const Pose& pose_a, const state::ColliderShape& b,
                    const Pose& pose_b) {
  if (is_convex(a)) return convex_overlaps(a, pose_a, b, pose_b);
  return is_convex(b) && convex_overlaps(b, pose_b, a, pose_a);
}

}  // namespace hooke::collision
