#include "io/model/model_geometry.h"

#include <algorithm>
#include <cmath>

namespace hooke::io {

namespace {

/// Up to this many corners the best ear is taken, above it the first one.
constexpr std::size_t kMaxChoosy = 64;

/// Share of the squared extent below which an area counts as zero.
constexpr double kFlat = 1e-12;

struct Point {
  double x = 0.0;
  double y = 0.0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// Returns twice the signed area.
double doubled_area(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Returns the polygon seen along its mean normal (Newell), counter-clockwise.
std::vector<Point> flatten(std::span<const DVec3> corners) {
  DVec3 normal = {};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    normal += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  }
  const DVec3 n = normalize(normal);
  const DVec3 least = std::abs(n.x) <= std::min(std::abs(n.y), std::abs(n.z)) ? DVec3{1, 0, 0}
                      : std::abs(n.y) <= std::abs(n.z)                        ? DVec3{0, 1, 0}
                                                                              : DVec3{0, 0, 1};
  const DVec3 u = normalize(cross(least, n));
  const DVec3 v = cross(n, u);
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const DVec3 p : corners) points.push_back({dot(p - corners[0], u), dot(p - corners[0], v)});
  return points;
}

/// Clips corners off a polygon until three are left.
class Clipper {
 public:
  explicit Clipper(std::vector<Point> points) : points_(std::move(points)), left_(points_.size()) {
    double extent = 0.0;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      left_[i] = i;
      extent = std::max({extent, std::abs(points_[i].x), std::abs(points_[i].y)});
    }
    flat_ = kFlat * extent * extent;
  }

  [[nodiscard]] std::vector<Triangle> run() {
    std::vector<Triangle> triangles;
    while (left_.size() >= 3) {
      const std::size_t ear = choose();
      triangles.push_back(around(ear));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
      start_ = ear < left_.size() ? ear : 0;
    }
    return triangles;
  }

 private:
  [[nodiscard]] Triangle around(std::size_t i) const {
    const std::size_t n = left_.size();
    return {left_[(i + n - 1) % n], left_[i], left_[(i + 1) % n]};
  }

  /// Returns the height over the longest side divided by that side: 0 for a flat ear, 0.87 for equal sides.
  [[nodiscard]] double quality(std::size_t i) const {
    const auto [a, b, c] = around(i);
    const auto squared = [&](std::uint32_t p, std::uint32_t q) {
      const double x = points_[p].x - points_[q].x;
      const double y = points_[p].y - points_[q].y;
      return x * x + y * y;
    };
    const double area = doubled_area(points_[a], points_[b], points_[c]);
    return area > flat_ ? area / std::max({squared(a, b), squared(b, c), squared(c, a)}) : 0.0;
  }

  /// Tells whether no other corner lies in the triangle or on it. A corner at the position of one of the
  /// three does not count, because holes are cut in by such pairs.
  [[nodiscard]] bool is_empty(std::size_t i) const {
    const auto [ia, ib, ic] = around(i);
    const Point a = points_[ia];
    const Point b = points_[ib];
    const Point c = points_[ic];
    return std::none_of(left_.begin(), left_.end(), [&](std::uint32_t other) {
      const Point p = points_[other];
      return p != a && p != b && p != c && doubled_area(a, b, p) >= -flat_ &&
             doubled_area(b, c, p) >= -flat_ && doubled_area(c, a, p) >= -flat_;
    });
  }

  /// Returns the ear to clip: empty and not flat, or the closest to that in a polygon that crosses itself.
  [[nodiscard]] std::size_t choose() const {
    const std::size_t n = left_.size();
    std::size_t best = start_;
    double best_quality = 0.0;
    for (std::size_t step = 0; step < n; ++step) {
      const std::size_t i = (start_ + step) % n;
      const double q = quality(i);
      if (q <= best_quality || !is_empty(i)) continue;
      if (n > kMaxChoosy) return i;
      best = i;
      best_quality = q;
    }
    for (std::size_t i = 0; best_quality == 0.0 && i < n; ++i) {
      if (quality(i) > quality(best)) best = i;
    }
    return best;
  }

  std::vector<Point> points_;
  std::vector<std::uint32_t> left_;
  std::size_t start_ = 0;
  double flat_ = 0.0;
};

}  // namespace

std::vector<Triangle> triangulate(std::span<const DVec3> corners) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  return Clipper(flatten(corners)).run();
}

}  // namespace hooke::io
