/// Finds where two convex solids touch: it intersects their features at the planes of contact in two
/// dimensions.

#include "lab/shape/convex_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::geometry {

namespace {

struct Point2 {
  double x = 0, y = 0;
};

Point2 operator-(Point2 a, Point2 b) {
  return {a.x - b.x, a.y - b.y};
}
double cross2(Point2 a, Point2 b) {
  return a.x * b.y - a.y * b.x;
}
double distance2(Point2 a, Point2 b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

/// These are the axes of a plane.
struct Plane2 {
  DVec3 u = {}, w = {};
  [[nodiscard]] Point2 of(DVec3 v) const { return {dot(u, v), dot(w, v)}; }
};

Plane2 plane_across(DVec3 n) {
  const DVec3 u = normalize(cross(n, std::abs(n.x) < 0.6 ? DVec3{1, 0, 0} : DVec3{0, 1, 0}));
  return {u, cross(n, u)};
}

/// Applies Andrew's monotone chain. The outline is counter-clockwise, without points on its sides.
std::vector<Point2> convex_outline(std::vector<Point2> points) {
  std::sort(points.begin(), points.end(),
            [](Point2 a, Point2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  if (points.size() < 3) return points;
  std::vector<Point2> outline;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = outline.size();
    for (const Point2 p : points) {
      while (outline.size() >= first + 2 &&
             cross2(outline.back() - outline[outline.size() - 2], p - outline.back()) <= 0)
        outline.pop_back();
      outline.push_back(p);
    }
    outline.pop_back();
    std::reverse(points.begin(), points.end());
  }
  if (outline.size() < 2) return {points.front()};
  return outline;
}

/// Returns the corners of the core within `tolerance` of the plane across n that bounds the core on the side
/// of n.
std::vector<Point2> feature(const ConvexSolid& solid, DVec3 n, const Plane2& plane, double tolerance) {
  double high = -std::numeric_limits<double>::infinity();
  for (const DVec3 v : solid.vertices) high = std::max(high, dot(n, v));
  std::vector<Point2> points;
  for (const DVec3 v : solid.vertices) {
    if (dot(n, v) >= high - tolerance) points.push_back(plane.of(v));
  }
  return convex_outline(std::move(points));
}

Point2 nearest_on(Point2 p, Point2 a, Point2 b) {
  const Point2 ab = b - a;
  const double whole = ab.x * ab.x + ab.y * ab.y;
  const double along = (p.x - a.x) * ab.x + (p.y - a.y) * ab.y;
  const double s = whole > 0 ? std::clamp(along / whole, 0.0, 1.0) : 0.0;
  return {a.x + s * ab.x, a.y + s * ab.y};
}

Point2 nearest_on(Point2 p, const std::vector<Point2>& outline) {
  Point2 best = outline[0];
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point2 near = nearest_on(p, outline[i], outline[(i + 1) % outline.size()]);
    if (distance2(p, near) < distance2(p, best)) best = near;
  }
  return best;
}

bool is_inside(Point2 p, const std::vector<Point2>& outline, double tolerance) {
  if (distance2(p, nearest_on(p, outline)) <= tolerance) return true;
  if (outline.size() < 3) return false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (cross2(outline[(i + 1) % outline.size()] - outline[i], p - outline[i]) < 0) return false;
  }
  return true;
}

class Places {
 public:
  explicit Places(double tolerance) : tolerance_(tolerance) {}

  void add(Point2 p) {
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](Point2 other) { return distance2(p, other) <= tolerance_; });
    if (!known) found.push_back(p);
  }
  void add_corners(const std::vector<Point2>& of, const std::vector<Point2>& on) {
    for (const Point2 p : of) {
      if (is_inside(p, on, tolerance_)) add(p);
    }
  }
  void add_crossings(const std::vector<Point2>& a, const std::vector<Point2>& b) {
    if (a.size() < 2 || b.size() < 2) return;
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; j < b.size(); ++j) {
        const Point2 from_a = a[i], along_a = a[(i + 1) % a.size()] - from_a;
        const Point2 from_b = b[j], along_b = b[(j + 1) % b.size()] - from_b;
        const double sine = cross2(along_a, along_b);
        const double s = cross2(from_b - from_a, along_b) / sine;
        const double t = cross2(from_b - from_a, along_a) / sine;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1) add({from_a.x + s * along_a.x, from_a.y + s * along_a.y});
      }
    }
  }

  std::vector<Point2> found;

 private:
  double tolerance_;
};

}  // namespace

std::vector<DVec3> contact_points(const ConvexSolid& a, const ConvexSolid& b, const SolidGap& gap,
                                  double tolerance) {
  const DVec3 n = gap.normal;
  const Plane2 plane = plane_across(n);
  const std::vector<Point2> of_a = feature(a, n, plane, tolerance);
  const std::vector<Point2> of_b = feature(b, -n, plane, tolerance);
  Places places(tolerance);
  places.add_corners(of_a, of_b);
  places.add_corners(of_b, of_a);
  places.add_crossings(of_a, of_b);
  if (places.found.empty()) {  // The features miss each other by a little, so the contact is between their
                               // nearest corners.
    Point2 best_a = of_a[0];
    for (const Point2 p : of_a) {
      if (distance2(p, nearest_on(p, of_b)) < distance2(best_a, nearest_on(best_a, of_b))) best_a = p;
    }
    const Point2 on_b = nearest_on(best_a, of_b);
    places.add({0.5 * (best_a.x + on_b.x), 0.5 * (best_a.y + on_b.y)});
  }
  double high_a = -std::numeric_limits<double>::infinity();
  double low_b = std::numeric_limits<double>::infinity();
  for (const DVec3 v : a.vertices) high_a = std::max(high_a, dot(n, v) + a.skin);
  for (const DVec3 v : b.vertices) low_b = std::min(low_b, dot(n, v) - b.skin);
  std::vector<DVec3> points;
  for (const Point2 p : places.found)
    points.push_back(p.x * plane.u + p.y * plane.w + (0.5 * (high_a + low_b)) * n);
  return points;
}

}  // namespace hooke::geometry
