#include "collision/manifold/manifold_mesh.h"

#include "base/assert.h"
#include "base/take_turns.h"
#include "collision/manifold/manifold_axes.h"
#include "collision/manifold/manifold_features.h"
#include "collision/manifold/manifold_tuning.h"
#include "geometry/closest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace hooke::collision {

namespace {

/// The box of the shape and of its reach, in the frame of the mesh.
geometry::Box bounds_in(const PlacedMesh& mesh, const Convex& b, const MeshReach& reach) {
  const auto side = [&](Vec3 axis) {
    return dot(axis, support_of(b, axis)) + skin_of(b) + reach.along(-axis);
  };
  const Vec3 upper = {side(mesh.axes.x), side(mesh.axes.y), side(mesh.axes.z)};
  const Vec3 lower = {-side(-mesh.axes.x), -side(-mesh.axes.y), -side(-mesh.axes.z)};
  return {mesh.origin + lower, mesh.origin + upper};
}

Vec3 front_of(const Convex& triangle) {
  const auto& [p, q, r] = triangle.corners;
  return normalize(cross(q - p, r - p));
}

/// Makes the points of the shape over the face.
void collide_face(const Convex& triangle, const Convex& b, ContactResult& result) {
  Feature face;
  face.kind = Feature::Kind::kPolygon;
  face.normal = result.normal;
  for (std::uint32_t i = 0; i < 3; ++i) face.add(triangle.corners[i], i, i);
  overlap_features(face, feature_along(b, -result.normal, kSteepFaceCosine), Real(0), skin_of(b), result);
}

/// A ball touches a triangle at the point nearest to its center, along the line between the two. Along any
/// other line its spin would seem to bring them together.
bool collide_ball(const Convex& triangle, const Convex& ball, Real margin, ContactResult& result) {
  const auto& [p, q, r] = triangle.corners;
  const Vec3 front = front_of(triangle);
  const Real height = dot(front, ball.center - p);
  if (!(height > Real(0)) || !(height - skin_of(ball) <= margin)) return false;
  const Vec3 place = geometry::closest_on_triangle(ball.center, p, q, r).point;
  const Vec3 out = ball.center - place;
  // This holds over an edge within a flat floor, too.
  const bool over_face = length(out - height * front) <= kOverFaceTilt * height;
  const Real distance = over_face ? height : length(out);
  if (!(distance - skin_of(ball) <= margin)) return false;
  result.count = 0;
  result.normal = over_face ? front : normalize(out);
  result.separation = distance - skin_of(ball);
  result.add({.on_a = place,
              .on_b = ball.center - skin_of(ball) * result.normal,
              .separation = result.separation,
              .key = kVertexOfB});
  return true;
}

/// The part of the triangle's rim that is farthest along n: a corner, or the point of an edge nearest to p.
Vec3 rim_along(const Convex& triangle, Vec3 n, Vec3 p) {
  std::array<Vec3, 3> rim = triangle.corners;
  const auto height = [n](Vec3 corner) { return dot(n, corner); };
  std::sort(rim.begin(), rim.end(), [&](Vec3 a, Vec3 b) { return height(a) > height(b); });
  const bool whole_edge = height(rim[1]) >= height(rim[0]) - kFlush;
  return whole_edge ? geometry::closest_on_segment(p, rim[0], rim[1]).point : rim[0];
}

/// Whether the direction from the triangle to the middle of the shape separates them. This excludes most of
/// the triangles whose boxes overlap that of the shape.
bool is_apart(const Convex& triangle, const Convex& b, const MeshReach& reach) {
  const auto& [p, q, r] = triangle.corners;
  const Vec3 middle = middle_of(b);
  const Vec3 away = middle - geometry::closest_on_triangle(middle, p, q, r).point;
  const Real size = length(away);
  if (!(size > Real(0))) return false;
  const Vec3 n = (Real(1) / size) * away;
  return separation_along(triangle, b, n) > reach.along(n);
}

/// Returns false if they are too far apart to meet, or the shape is behind the triangle.
bool collide_triangle(const PlacedMesh& a, std::uint32_t index, const Convex& b, const MeshReach& reach,
                      std::vector<std::uint32_t>& near, ContactResult& result) {
  const Real margin = reach.margin();
  const Convex triangle = a.triangle(index);
  if (b.shape.kind == ShapeKind::kSphere) return collide_ball(triangle, b, margin, result);
  const Vec3 front = front_of(triangle);
  result.count = 0;
  result.normal = front;
  result.separation = dot(front, support_of(b, -front) - triangle.corners[0]) - skin_of(b);
  const bool in_front = dot(front, middle_of(b) - triangle.corners[0]) > Real(0);
  if (!in_front || !(result.separation <= reach.along(front)) || is_apart(triangle, b, reach)) return false;
  const Real tolerance = axis_tolerance(triangle, b);
  collide_face(triangle, b, result);
  if (deepest_of(result) <= result.separation + Real(4) * tolerance) return true;
  // The shape is deepest beside the face.
  Axis axis = {front, result.separation, kAxisOfA};
  const Distance apart = distance_between(triangle, b, margin);
  if (apart.distance > margin) return false;
  const Nearest nearest = improve_axis(triangle, b, apart, tolerance, axis);
  if (!(axis.separation <= margin) || !(dot(axis.n, front) > Real(0))) return false;
  if (axis.separation < Real(0) && !(exit_direction(a, index, b, axis.n, near) == axis.n))
    return result.count > 0;
  if (axis.code == kFreeAxis) {
    result.count = 0;
    result.normal = axis.n;
    result.separation = axis.separation;
    overlap_features(feature_along(triangle, axis.n), feature_along(b, -axis.n), Real(0), skin_of(b), result);
  }
  complete_points(nearest, Real(4) * tolerance, result);
  return result.count > 0;
}

/// Vertices of the shape keep their key from triangle to triangle, other points do not.
std::uint32_t key_on(std::uint32_t triangle, std::uint32_t key) {
  const std::uint32_t kind = key & kNearest;
  if (kind == kVertexOfB) return key;
  return kind | ((key + (triangle + 1) * 0x9E3779B1u) & ~kNearest);
}

void append_contact(const Convex& triangle, std::uint32_t index, const ContactResult& result,
                    MeshScratch& scratch) {
  const auto points = std::span(result.point.data(), static_cast<std::size_t>(result.count));
  const auto deepest = std::min_element(
      points.begin(), points.end(), [](const auto& p, const auto& q) { return p.separation < q.separation; });
  HOOKE_ASSERT(deepest != points.end());
  scratch.contacts.push_back({triangle, index, result.normal, deepest->on_a, result.separation});
  for (ContactResultPoint p : points) {
    p.key = key_on(index, p.key);
    scratch.points.push_back(p);
  }
  scratch.first_point.push_back(scratch.points.size());
}

/// Adds a point to a patch. If there is no room for more, its points are reduced: those farthest out stay.
void add_point(const ContactResultPoint& point, ContactResult& result) {
  const auto points = std::span(result.point.data(), static_cast<std::size_t>(result.count));
  const bool known =
      (point.key & kNearest) == kVertexOfB &&
      std::any_of(points.begin(), points.end(), [&](const auto& p) { return p.key == point.key; });
  if (known) return;
  if (result.count == ContactResult::kMaxPoints)
    reduce_points(result, std::numeric_limits<Real>::infinity(), {});
  result.add(point);
}

void join(const ContactResult& from, PatchResult& patch) {
  ContactResult& to = patch.result;
  for (int i = 0; i < from.count; ++i) {
    ContactResultPoint p = from.point[static_cast<std::size_t>(i)];
    p.separation = dot(to.normal, p.on_b - p.on_a);
    add_point(p, to);
  }
  to.separation = std::min(to.separation, from.separation);
}

/// Adds a contact to the patch of its plane.
void add_to_patches(const SurfaceContact& contact, std::span<const ContactResultPoint> points,
                    std::vector<PatchResult>& patches) {
  const auto is_same_plane = [&](const PatchResult& patch) {
    const ContactResultPoint& p = patch.result.point[0];
    HOOKE_ASSERT(patch.result.count > 0);
    return is_same_direction(patch.result.normal, contact.normal) &&
           std::fabs(dot(contact.normal, contact.place - p.on_a)) <= kFlush;
  };
  auto patch = std::find_if(patches.begin(), patches.end(), is_same_plane);
  if (patch == patches.end()) {
    patches.push_back({.patch = contact.index});
    patch = patches.end() - 1;
    patch->result.normal = contact.normal;
    patch->result.separation = contact.separation;
  }
  for (const ContactResultPoint& p : points) add_point(p, patch->result);
  patch->result.separation = std::min(patch->result.separation, contact.separation);
}

/// Adds the points of a covered triangle to the patch with the most similar normal, if they are deeper in the
/// shape than that patch. They push along the normal of that patch. Otherwise the shape would sink in there
/// while it rotates about the points that stay.
void join_ghost(const SurfaceContact& ghost, std::span<const ContactResultPoint> points,
                std::vector<PatchResult>& patches) {
  const auto likeness = [&](const PatchResult& p) { return dot(p.result.normal, ghost.normal); };
  const auto nearest = std::max_element(patches.begin(), patches.end(), [&](const auto& p, const auto& q) {
    return likeness(p) < likeness(q);
  });
  if (nearest == patches.end() || !(likeness(*nearest) > kPatchLikeness)) return;
  ContactResult& to = nearest->result;
  const Real deepest = std::min(deepest_of(to), Real(0)) - kFlush;
  for (ContactResultPoint p : points) {
    p.separation = dot(to.normal, p.on_b - p.on_a);
    if (p.separation < deepest) add_point(p, to);
  }
}

/// Joins patches whose normals differ by less than the angle with this cosine to the deepest of them.
void join_patches(Real cosine, MeshScratch& scratch) {
  std::vector<PatchResult>& patches = scratch.patches;
  const std::vector<PatchResult>& unjoined = scratch.unjoined;
  std::vector<std::uint32_t>& order = scratch.order;
  base::take_turns(patches, scratch.unjoined);
  order.resize(unjoined.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::sort(order.begin(), order.end(), [&](std::uint32_t p, std::uint32_t q) {
    const Real gap_p = unjoined[p].result.separation;
    const Real gap_q = unjoined[q].result.separation;
    return gap_p != gap_q ? gap_p < gap_q : p < q;
  });
  patches.clear();
  for (const std::uint32_t i : order) {
    const PatchResult& patch = unjoined[i];
    const auto near = std::find_if(patches.begin(), patches.end(), [&](const PatchResult& p) {
      return dot(p.result.normal, patch.result.normal) >= cosine;
    });
    if (near == patches.end()) {
      patches.push_back(patch);
    } else {
      near->patch = std::min(near->patch, patch.patch);
      join(patch.result, *near);
    }
  }
}

}  // namespace

Vec3 exit_direction(const PlacedMesh& a, std::uint32_t triangle, const Convex& b, Vec3 n,
                    std::vector<std::uint32_t>& near) {
  const Convex own = a.triangle(triangle);
  const Vec3 front = front_of(own);
  if (is_same_direction(n, front)) return n;
  const Vec3 rim = rim_along(own, n, middle_of(b));
  const Vec3 at = a.origin + transpose(a.axes) * rim;
  const Vec3 margin = {kFlush, kFlush, kFlush};
  geometry::find_triangles(a.mesh.bvh, {at - margin, at + margin}, near);
  const Real height = dot(n, support_of(own, n));
  bool goes_on = false;
  Axis best = {front, separation_along(own, b, front)};
  for (const std::uint32_t index : near) {
    const Convex other = a.triangle(index);
    const auto& [p, q, r] = other.corners;
    if (index == triangle || length(geometry::closest_on_triangle(rim, p, q, r).point - rim) > kFlush)
      continue;
    goes_on |= dot(n, support_of(other, n)) > height + kFlush;
    const Vec3 n_other = front_of(other);
    const Real separation = separation_along(own, b, n_other);
    if (dot(n_other, front) > Real(0) && separation > best.separation) best = {n_other, separation};
  }
  return goes_on ? best.n : n;
}

Convex PlacedMesh::triangle(std::uint32_t index) const {
  HOOKE_ASSERT(index < mesh.desc.triangles.size());
  Convex convex = {.shape = {.kind = ShapeKind::kMesh}};
  for (std::size_t i = 0; i < 3; ++i) {
    convex.corners[i] = axes * (mesh.desc.positions[mesh.desc.triangles[index][i]] - origin);
  }
  return convex;
}

void find_triangles_near(const PlacedMesh& a, const Convex& b, const MeshReach& reach,
                         std::vector<std::uint32_t>& found) {
  geometry::find_triangles(a.mesh.bvh, bounds_in(a, b, reach), found);
}

Real collide_mesh(const PlacedMesh& a, const Convex& b, const MeshReach& reach, MeshScratch& scratch) {
  scratch.contacts.clear();
  scratch.points.clear();
  scratch.first_point.assign(1, 0);
  scratch.patches.clear();
  find_triangles_near(a, b, reach, scratch.triangles);
  ContactResult result;
  for (const std::uint32_t index : scratch.triangles) {
    if (collide_triangle(a, index, b, reach, scratch.near, result))
      append_contact(a.triangle(index), index, result, scratch);
  }
  find_ghosts(scratch.contacts, Pieces::kOfOneMesh, scratch.ghosts);
  const auto points_of = [&scratch](std::size_t i) {
    const std::size_t first = scratch.first_point[i];
    HOOKE_ASSERT(first < scratch.first_point[i + 1] && scratch.first_point[i + 1] <= scratch.points.size());
    return std::span(scratch.points).subspan(first, scratch.first_point[i + 1] - first);
  };
  const std::vector<std::uint8_t>& is_ghost = scratch.ghosts.is_ghost;
  for (std::size_t i = 0; i < is_ghost.size(); ++i)
    if (is_ghost[i] == 0) add_to_patches(scratch.contacts[i], points_of(i), scratch.patches);
  for (std::size_t i = 0; i < is_ghost.size(); ++i)
    if (is_ghost[i] != 0) join_ghost(scratch.contacts[i], points_of(i), scratch.patches);
  for (const Real cosine : {Real(0.999), Real(0.99), Real(0.9), Real(0.5), Real(-1)}) {
    if (scratch.patches.size() > kMostPatches) join_patches(cosine, scratch);
  }
  std::sort(scratch.patches.begin(), scratch.patches.end(),
            [](const PatchResult& p, const PatchResult& q) { return p.patch < q.patch; });
  // Out of reach does not mean the whole margin apart, and the bodies may move in another direction later.
  if (scratch.triangles.empty()) find_triangles_near(a, b, MeshReach(reach.margin()), scratch.triangles);
  return scratch.triangles.empty() ? reach.margin() : Real(0);
}

}  // namespace hooke::collision
