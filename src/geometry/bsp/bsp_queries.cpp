#include "hooke/bsp.h"

#include "geometry/box.h"
#include "geometry/closest.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <cmath>

namespace hooke {

namespace {

constexpr double kNoFraction = std::numeric_limits<double>::infinity();
constexpr std::size_t kUsualDepth = 64;
constexpr double kGrazing = 1e-12;  // relative: a motion that is nearer than this to sliding along a surface
                                    // slides along it

std::uint32_t root_of(const BspTree& tree) {
  return tree.nodes.empty() ? kBspEmpty : 0;
}

double height_over(const BspNode& node, DVec3 p) {
  return dot(node.normal, p) - node.offset;
}

/// A part of the ray that is in a child.
struct Stretch {
  std::uint32_t child = 0;
  std::uint32_t entered = 0;  // the node at whose plane it begins
  double begin = 0;
  double end = 0;
};

/// Visits the leaves along the ray in their order: `visit(is_solid, begin, entered)` returns whether to go
/// on. The stretches join without gaps, so that nothing slips through between them.
template <class Visit>
void visit_leaves(const BspTree& tree, DVec3 origin, DVec3 direction, double fraction_max,
                  const Visit& visit) {
  std::vector<Stretch> stack;
  stack.reserve(kUsualDepth);
  stack.push_back({.child = root_of(tree), .end = fraction_max});
  while (!stack.empty()) {
    Stretch s = stack.back();
    stack.pop_back();
    while (!is_bsp_leaf(s.child)) {
      const BspNode& node = tree.nodes[s.child];
      const double height = height_over(node, origin);
      const double rate = dot(node.normal, direction);
      const bool is_first_above = rate < 0 || (!(rate > 0) && height >= 0);
      const double crossing = rate < 0 || rate > 0 ? -height / rate : kNoFraction;
      const std::uint32_t first = is_first_above ? node.above : node.below;
      const std::uint32_t second = is_first_above ? node.below : node.above;
      if (crossing > s.begin && crossing < s.end) {
        stack.push_back({second, s.child, crossing, s.end});
        s.end = crossing;
        s.child = first;
      } else {
        s.child = crossing <= s.begin ? second : first;
      }
    }
    if (!visit(s.child == kBspSolid, s.begin, s.entered)) return;
  }
}

/// Does the same for the points where the ray passes the surface.
template <class Visit>
void visit_crossings(const BspTree& tree, DVec3 origin, DVec3 direction, double fraction_max,
                     const Visit& visit) {
  const bool is_ray = is_finite(origin) && is_finite(direction) && direction != DVec3{};
  if (!is_ray || !(fraction_max >= 0)) return;
  std::optional<bool> was_solid;
  visit_leaves(tree, origin, direction, fraction_max,
               [&](bool is_solid, double fraction, std::uint32_t entered) {
                 const bool goes_on =
                     !was_solid || *was_solid == is_solid || visit(BspCrossing{fraction, entered, is_solid});
                 was_solid = is_solid;
                 return goes_on;
               });
}

}  // namespace

bool is_solid_at(const BspTree& tree, DVec3 p) {
  std::uint32_t child = is_finite(p) ? root_of(tree) : kBspEmpty;
  while (!is_bsp_leaf(child)) {
    const BspNode& node = tree.nodes[child];
    child = height_over(node, p) >= 0 ? node.above : node.below;
  }
  return child == kBspSolid;
}

void find_crossings(const BspTree& tree, DVec3 origin, DVec3 direction, double fraction_max,
                    std::vector<BspCrossing>& crossings) {
  crossings.clear();
  visit_crossings(tree, origin, direction, fraction_max, [&](const BspCrossing& crossing) {
    crossings.push_back(crossing);
    return true;
  });
}

std::optional<BspCrossing> cast_ray(const BspTree& tree, DVec3 origin, DVec3 direction, double fraction_max) {
  std::optional<BspCrossing> first;
  visit_crossings(tree, origin, direction, fraction_max, [&](const BspCrossing& crossing) {
    first = crossing;
    return false;
  });
  return first;
}

std::optional<BspHit> move_point(const BspTree& tree, DVec3 origin, DVec3 motion) {
  if (!is_finite(origin) || !is_finite(motion)) return std::nullopt;
  std::optional<BspHit> hit;
  bool is_start = true;
  visit_leaves(tree, origin, motion, 1.0, [&](bool is_solid, double fraction, std::uint32_t entered) {
    if (is_solid) hit = {fraction, {}};
    if (is_solid && !is_start) {
      const DVec3 normal = tree.nodes[entered].normal;
      hit->normal = dot(normal, motion) < 0 ? normal : -normal;
    }
    is_start = false;
    return !is_solid;
  });
  return hit;
}

namespace {

std::span<const DVec3> corners_of(const BspTree& tree, const BspFace& face) {
  return std::span(tree.corners).subspan(face.first_corner, face.corner_count);
}

/// Depth of `p` inside the outline, in the plane across `normal`; negative outside, where it is no distance.
double depth_in_outline(std::span<const DVec3> corners, DVec3 normal, DVec3 p) {
  double depth = kNoFraction;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const DVec3 inward = cross(normal, corners[(k + 1) % corners.size()] - corners[k]);
    depth = std::min(depth, dot(normalize(inward), p - corners[k]));
  }
  return depth;
}

/// Unit normal, outward.
DVec3 normal_of(std::span<const DVec3> corners) {
  DVec3 sum = {};
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    sum += cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
  }
  return geometry::direction_or(sum, DVec3{});
}

}  // namespace

std::uint32_t triangle_at(const BspTree& tree, std::uint32_t node, DVec3 p) {
  std::uint32_t best = geometry::kNone;
  double depth = -kNoFraction;
  const BspNode& plane = tree.nodes[node];
  for (std::uint32_t f = plane.first_face; f < plane.first_face + plane.face_count; ++f) {
    const auto corners = corners_of(tree, tree.faces[f]);
    const double here = depth_in_outline(corners, normal_of(corners), p);
    if (!(here > depth)) continue;
    depth = here;
    best = tree.faces[f].triangle;
  }
  return best;
}

namespace {

struct Sphere {
  DVec3 center = {};
  DVec3 motion = {};
  double radius = 0;

  [[nodiscard]] DVec3 at(double fraction) const { return center + fraction * motion; }
};

DVec3 closest_on_face(std::span<const DVec3> corners, DVec3 normal, DVec3 p) {
  if (depth_in_outline(corners, normal, p) >= 0) return p - dot(normal, p - corners[0]) * normal;
  geometry::SegmentPoint<double> best = {.distance_squared = kNoFraction};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto near = geometry::closest_on_segment(p, corners[k], corners[(k + 1) % corners.size()]);
    if (near.distance_squared < best.distance_squared) best = near;
  }
  return best.point;
}

/// The first root of |offset + t motion| = radius, if t is not negative. A grazing root does not count: a
/// sphere that slides along a plane must not stop at the edges in it.
double time_to_distance(DVec3 offset, DVec3 motion, double radius) {
  const double speed = geometry::safe_length(motion);
  if (!(speed > 0)) return kNoFraction;
  const DVec3 direction = (1 / speed) * motion;
  const double along = dot(offset, direction);
  const double across_squared = length_squared(offset - along * direction);
  if (across_squared >= (1 - kGrazing) * radius * radius) return kNoFraction;
  const double distance = -along - std::sqrt(radius * radius - across_squared);
  return distance >= 0 ? distance / speed : kNoFraction;
}

/// The first time at which the sphere, away from the face at the start, touches a corner or an edge.
double time_to_outline(std::span<const DVec3> corners, const Sphere& sphere) {
  double first = kNoFraction;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const DVec3 a = corners[k];
    const DVec3 b = corners[(k + 1) % corners.size()];
    const DVec3 edge = geometry::direction_or(b - a, DVec3{});
    const DVec3 offset = sphere.center - a;
    first = std::min(first, time_to_distance(offset, sphere.motion, sphere.radius));
    // The line of the edge is tested, so the components along it are removed.
    const double time = time_to_distance(offset - dot(offset, edge) * edge,
                                         sphere.motion - dot(sphere.motion, edge) * edge, sphere.radius);
    if (!(time < first)) continue;
    const double place = dot(sphere.at(time) - a, edge);
    if (place >= 0 && place <= geometry::safe_length(b - a)) first = time;
  }
  return first;
}

/// Time at which the sphere touches the face, and the side from which it comes.
BspHit sweep_to_face(std::span<const DVec3> corners, const Sphere& sphere) {
  const DVec3 normal = normal_of(corners);
  const DVec3 gap = sphere.center - closest_on_face(corners, normal, sphere.center);
  if (geometry::safe_length(gap) <= sphere.radius) {
    // The distance to a convex shape grows for ever once it grows. Motion along the face is not motion toward
    // it.
    const double toward = -dot(gap, sphere.motion);
    const bool is_toward =
        toward > kGrazing * geometry::safe_length(gap) * geometry::safe_length(sphere.motion);
    return {is_toward ? 0 : kNoFraction, geometry::direction_or(gap, normal)};
  }
  const double height = dot(normal, sphere.center - corners[0]);
  const double rate = dot(normal, sphere.motion);
  if (rate < 0 && height >= sphere.radius) {
    const double time = (sphere.radius - height) / rate;
    if (depth_in_outline(corners, normal, sphere.at(time)) >= 0) return {time, normal};
  }
  const double time = time_to_outline(corners, sphere);
  if (!(time <= 1)) return {kNoFraction, {}};
  const DVec3 center = sphere.at(time);
  return {time, geometry::direction_or(center - closest_on_face(corners, normal, center), normal)};
}

/// Puts the first hit with a face of the node into `best`, if it comes before that. `own` is the stretch of
/// the motion within reach of the node's plane.
void sweep_to_faces(const BspTree& tree, const BspNode& node, const Sphere& sphere, const Stretch& own,
                    BspHit& best) {
  if (!(own.begin <= own.end)) return;
  const DVec3 around = {sphere.radius, sphere.radius, sphere.radius};
  const geometry::Box3<double> swept = {geometry::min_of(sphere.at(own.begin), sphere.at(own.end)) - around,
                                        geometry::max_of(sphere.at(own.begin), sphere.at(own.end)) + around};
  for (std::uint32_t k = 0; k < node.face_count; ++k) {
    const auto corners = corners_of(tree, tree.faces[node.first_face + k]);
    geometry::Box3<double> box;
    for (const DVec3& p : corners) box = merge(box, p);
    if (!overlap(box, swept)) continue;
    const BspHit hit = sweep_to_face(corners, sphere);
    if (hit.fraction < best.fraction) best = hit;
  }
}

/// The part of the stretch where height + t rate is in [low, high]. An empty part begins after its end.
Stretch clip(Stretch s, double height, double rate, double low, double high) {
  if (!(rate < 0) && !(rate > 0)) {
    if (height < low || height > high) s.end = -kNoFraction;
    return s;
  }
  const double a = (low - height) / rate;
  const double b = (high - height) / rate;
  s.begin = std::max(s.begin, std::min(a, b));
  s.end = std::min(s.end, std::max(a, b));
  return s;
}

}  // namespace

std::optional<BspHit> move_sphere(const BspTree& tree, DVec3 origin, DVec3 motion, double radius) {
  if (!is_finite(origin) || !is_finite(motion) || !(radius >= 0 && std::isfinite(radius)))
    return std::nullopt;
  if (is_solid_at(tree, origin)) return BspHit{};
  const Sphere sphere = {origin, motion, radius};
  BspHit best = {kNoFraction, {}};
  std::vector<Stretch> stack;
  stack.reserve(kUsualDepth);
  stack.push_back({.child = root_of(tree), .end = 1});
  while (!stack.empty()) {
    const Stretch s = stack.back();
    stack.pop_back();
    if (is_bsp_leaf(s.child) || s.begin > s.end || s.begin > best.fraction) continue;
    const BspNode& node = tree.nodes[s.child];
    const double height = height_over(node, origin);
    const double rate = dot(node.normal, motion);
    // Rounding must not lose a face that is touched at the very edge of a stretch.
    const double reach =
        radius + 1e-12 * (radius + std::fabs(height) + std::fabs(rate) + std::fabs(node.offset));
    sweep_to_faces(tree, node, sphere, clip(s, height, rate, -reach, reach), best);
    Stretch above = clip(s, height, rate, -reach, kNoFraction);
    Stretch below = clip(s, height, rate, -kNoFraction, reach);
    above.child = node.above;
    below.child = node.below;
    // The nearer child is taken first, from the end.
    stack.push_back(above.begin <= below.begin ? below : above);
    stack.push_back(above.begin <= below.begin ? above : below);
  }
  if (!(best.fraction <= 1)) return std::nullopt;
  return best;
}

}  // namespace hooke
