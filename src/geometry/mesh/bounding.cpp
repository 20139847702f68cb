#include "geometry/mesh/bounding.h"

#include "geometry/convex/convex_hull.h"
#include "geometry/convex/mass_properties.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace hooke::geometry {

namespace {

constexpr double kOutside = 1 + 1e-12;  ///< A point beyond this share of the radius is outside.
/// may_overlap says no only where the gap is more than this part of the sizes involved.
constexpr double kRoundingSlack = 1e-12;

/// The smallest sphere with all points of `support` (two to four) on it; empty if there is none for their
/// positions.
BoundingSphere sphere_through(std::span<const DVec3> support) {
  // center = first + sum of weights along an orthogonal basis, one right side after the other.
  const DVec3 first = support[0];
  DVec3 offset = {};
  std::array<DVec3, 3> basis = {};
  for (std::size_t i = 1; i < support.size(); ++i) {
    const DVec3 along = support[i] - first;
    DVec3 across = along;
    for (std::size_t k = 0; k + 1 < i; ++k) across -= dot(basis[k], across) * basis[k];
    const double height = length(across);
    if (!(height > 1e-12 * length(along))) return {};
    basis[i - 1] = (1 / height) * across;
    // The weight w solves |offset + w basis|^2 = |offset + w basis - along|^2.
    const double w = (0.5 * length_squared(along) - dot(offset, along)) / height;
    offset += w * basis[i - 1];
  }
  return {first + offset, length(offset)};
}

bool holds(const BoundingSphere& sphere, std::span<const DVec3> points) {
  // This is looser than the pivot: the points of a thin support are found less exactly.
  return std::all_of(points.begin(), points.end(),
                     [&](DVec3 p) { return length(p - sphere.center) <= sphere.radius * (1 + 1e-10); });
}

/// A sphere and the points that determine it.
struct Support {
  BoundingSphere sphere = {};
  std::vector<DVec3> points = {};
};

/// The smallest sphere around the support and one more point, which is on it.
Support with_point(const Support& support, DVec3 p) {
  std::vector<DVec3> all = support.points;
  all.push_back(p);
  Support best = {.sphere = {{}, std::numeric_limits<double>::infinity()}};
  for (unsigned subset = 1; subset < (1u << support.points.size()); ++subset) {
    std::vector<DVec3> chosen = {p};
    for (std::size_t i = 0; i < support.points.size(); ++i) {
      if ((subset >> i & 1u) != 0) chosen.push_back(support.points[i]);
    }
    if (chosen.size() > 4) continue;
    const BoundingSphere sphere = sphere_through(chosen);
    if (sphere.radius >= 0 && sphere.radius < best.sphere.radius && holds(sphere, all)) {
      best = {sphere, chosen};
    }
  }
  return best;
}

std::size_t farthest(std::span<const DVec3> points, DVec3 from) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (length_squared(points[i] - from) > length_squared(points[best] - from)) best = i;
  }
  return best;
}

BoundingSphere around(DVec3 center, std::span<const DVec3> points) {
  return {center, length(points[farthest(points, center)] - center)};
}

DVec3 mean_of(std::span<const DVec3> points) {
  DVec3 sum = {};
  for (const DVec3& p : points) sum += p - points[0];
  return points[0] + 1 / static_cast<double>(points.size()) * sum;
}

/// Columns at right angles, from a rotation.
Matrix3<double> principal_frame(std::span<const DVec3> points) {
  const DVec3 mean = mean_of(points);
  math::Symmetric3<double> m = {};
  for (const DVec3& p : points) {
    const DVec3 d = p - mean;
    m = m + math::Symmetric3<double>{d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
  }
  return matrix_of(principal_axes(m).rotation);
}

/// A point of a plane.
struct Flat {
  double x = 0, y = 0;
};

double signed_area(Flat a, Flat b, Flat c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The convex outline, counter-clockwise (Andrew 1979, monotone chain).
std::vector<Flat> outline_of(std::vector<Flat> points) {
  std::sort(points.begin(), points.end(),
            [](Flat a, Flat b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Flat> outline;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = outline.size();
    for (const Flat p : points) {
      while (outline.size() >= first + 2 &&
             !(signed_area(outline[outline.size() - 2], outline.back(), p) > 0)) {
        outline.pop_back();
      }
      outline.push_back(p);
    }
    outline.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return outline;
}

/// Axes of the smallest of the boxes on the plane across the unit vector `n`.
Matrix3<double> axes_on(DVec3 n, const ConvexHull& hull) {
  const DVec3 side = std::fabs(n.x) < 0.7 ? DVec3{1, 0, 0} : DVec3{0, 1, 0};
  const DVec3 u = normalize(cross(n, side));
  const DVec3 v = cross(n, u);
  std::vector<Flat> seen;
  for (const Vec3& vertex : hull.vertices) {
    const auto p = vector_cast<double>(vertex);
    seen.push_back({dot(u, p), dot(v, p)});
  }
  const std::vector<Flat> outline = outline_of(std::move(seen));
  double least = std::numeric_limits<double>::infinity();
  DVec3 best = u;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Flat next = outline[(i + 1) % outline.size()];
    const DVec3 along = normalize(DVec3{next.x - outline[i].x, next.y - outline[i].y, 0});
    if (along == DVec3{}) continue;
    DBox box;
    for (const Flat p : outline) {
      const DVec3 q = {along.x * p.x + along.y * p.y, along.x * p.y - along.y * p.x, 0};
      box = merge(box, q);
    }
    const double area = (box.upper.x - box.lower.x) * (box.upper.y - box.lower.y);
    if (!(area < least)) continue;
    least = area;
    best = along.x * u + along.y * v;
  }
  return {best, cross(n, best), n};
}

/// The half extents of `box` seen along `axis`.
double reach(const DVec3& half_extents, DVec3 x, DVec3 y, DVec3 z, DVec3 axis) {
  return half_extents.x * std::fabs(dot(x, axis)) + half_extents.y * std::fabs(dot(y, axis)) +
         half_extents.z * std::fabs(dot(z, axis));
}

}  // namespace

BoundingSphere minimum_sphere(std::span<const DVec3> points) {
  if (points.empty()) return {};
  // The search starts from the farthest pair of two passes, which is a good guess.
  const DVec3 first = points[farthest(points, points[0])];
  const DVec3 second = points[farthest(points, first)];
  Support support = {sphere_through(std::array{first, second}), {first, second}};
  if (support.sphere.radius < 0) return {points[0], 0};  // all points at one place
  constexpr int kPassesMax = 1000;
  for (int pass = 0; pass < kPassesMax; ++pass) {
    const DVec3 p = points[farthest(points, support.sphere.center)];
    if (length(p - support.sphere.center) <= kOutside * support.sphere.radius) break;
    const Support next = with_point(support, p);
    // Each support gives a larger sphere than the last one. Where rounding says otherwise, the search ends.
    if (!std::isfinite(next.sphere.radius) || !(next.sphere.radius > support.sphere.radius)) break;
    support = next;
  }
  return around(support.sphere.center, points);
}

BoundingSphere vertex_sphere(std::span<const DVec3> points) {
  return points.empty() ? BoundingSphere{} : around(mean_of(points), points);
}

DBox bounds_of(std::span<const DVec3> points) {
  return std::accumulate(points.begin(), points.end(), DBox{},
                         [](const DBox& box, DVec3 p) { return merge(box, p); });
}

OrientedBox box_along(const Matrix3<double>& axes, std::span<const DVec3> points) {
  if (points.empty()) return {.axes = axes};
  DBox box;
  const Matrix3<double> into = transpose(axes);
  for (const DVec3& p : points) {
    const DVec3 q = into * (p - points[0]);
    box = merge(box, q);
  }
  return {points[0] + axes * (0.5 * (box.lower + box.upper)), axes, 0.5 * (box.upper - box.lower)};
}

OrientedBox tight_box(std::span<const DVec3> points) {
  OrientedBox best = box_along({}, points);
  if (points.empty()) return best;
  const auto try_axes = [&](const Matrix3<double>& axes) {
    const OrientedBox box = box_along(axes, points);
    if (volume_of(box) < volume_of(best) * (1 - 1e-9)) best = box;
  };
  try_axes(principal_frame(points));
  std::vector<Vec3> rounded;
  for (const DVec3& p : points) rounded.push_back(vector_cast<Real>(p));
  const Result<ConvexHull> hull = make_convex_hull(rounded);
  if (!hull) return best;  // flat or tiny
  for (const ConvexHull::Face& face : hull.value().faces) {
    try_axes(axes_on(normalize(vector_cast<double>(face.normal)), hull.value()));
  }
  return best;
}

double volume_of(const BoundingSphere& sphere) {
  const double r = std::max(0.0, sphere.radius);
  return 4.0 / 3.0 * std::numbers::pi * r * r * r;
}

double volume_of(const DBox& box) {
  const DVec3 size = box.upper - box.lower;
  return size.x < 0 ? 0 : size.x * size.y * size.z;
}

double volume_of(const OrientedBox& box) {
  const DVec3 h = box.half_extents;
  return h.x < 0 ? 0 : 8 * h.x * h.y * h.z;
}

bool may_overlap(const BoundingSphere& a, const BoundingSphere& b, const RigidPose& b_in_a, double margin) {
  if (a.radius < 0 || b.radius < 0) return false;
  const double apart = length(to_world(b_in_a, b.center) - a.center);
  return apart <= (a.radius + b.radius + margin) + kRoundingSlack * (apart + a.radius + b.radius);
}

bool may_overlap(const DBox& a, const DBox& b, const RigidPose& b_in_a, double margin) {
  if (a.upper.x < a.lower.x || b.upper.x < b.lower.x) return false;
  const Matrix3<double> r = matrix_of(b_in_a.rotation);
  const DVec3 half = 0.5 * (b.upper - b.lower);
  const DVec3 center = to_world(b_in_a, 0.5 * (b.upper + b.lower));
  const DVec3 turned = {reach(half, r.x, r.y, r.z, {1, 0, 0}), reach(half, r.x, r.y, r.z, {0, 1, 0}),
                        reach(half, r.x, r.y, r.z, {0, 0, 1})};
  const double size = length(center) + length(half) + length(a.lower) + length(a.upper);
  const double grown = margin + kRoundingSlack * size;
  const DVec3 grow = turned + DVec3{grown, grown, grown};
  return overlap(a, DBox{center - grow, center + grow});
}

bool may_overlap(const OrientedBox& a, const OrientedBox& b, const RigidPose& b_in_a, double margin) {
  if (a.half_extents.x < 0 || b.half_extents.x < 0) return false;
  const DVec3 apart = to_world(b_in_a, b.center) - a.center;
  const DVec3 of_a[3] = {a.axes.x, a.axes.y, a.axes.z};
  const DVec3 of_b[3] = {rotate(b_in_a.rotation, b.axes.x), rotate(b_in_a.rotation, b.axes.y),
                         rotate(b_in_a.rotation, b.axes.z)};
  const double size = length(apart) + length(a.half_extents) + length(b.half_extents);
  const double slack = margin + kRoundingSlack * size;
  // An axis of length below one gives a smaller gap, which the whole slack covers all the more.
  const auto separates = [&](DVec3 axis) {
    return std::fabs(dot(axis, apart)) > reach(a.half_extents, of_a[0], of_a[1], of_a[2], axis) +
                                             reach(b.half_extents, of_b[0], of_b[1], of_b[2], axis) + slack;
  };
  for (int i = 0; i < 3; ++i) {
    if (separates(of_a[i]) || separates(of_b[i])) return false;
  }
  for (const DVec3& x : of_a) {
    for (const DVec3& y : of_b) {
      if (separates(cross(x, y))) return false;
    }
  }
  return true;
}

double distance_squared(const BoundingSphere& sphere, DVec3 p) {
  const double out = std::max(0.0, length(p - sphere.center) - sphere.radius);
  return out * out;
}

double distance_squared(const OrientedBox& box, DVec3 p) {
  const DVec3 q = transpose(box.axes) * (p - box.center);
  return distance_squared(DBox{-box.half_extents, box.half_extents}, q);
}

}  // namespace hooke::geometry
