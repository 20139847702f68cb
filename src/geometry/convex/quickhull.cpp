#include "geometry/convex/quickhull.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>

namespace hooke::geometry {

namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFF;

DVec3 as_double(GridPoint p) {
  return vector_cast<double>(p);
}

/// A triangle of the hull so far, and the points outside that are assigned to it.
struct Facet : HullTriangle {
  std::vector<std::uint32_t> outside;
  std::uint32_t farthest = kNobody;
  double height = 0;  // height of the farthest point
  bool is_alive = true;
};

/// An edge between a facet that the new point sees and one that it does not see.
struct HorizonEdge {
  std::uint32_t start = 0, end = 0;
  std::uint32_t beyond = 0;  // the facet that stays
};

class Quickhull {
 public:
  Quickhull(std::span<const GridPoint> points, double tolerance)
      : points_(points), tolerance_(tolerance), facet_from_(points.size(), kNobody) {}

  /// Returns false if all points lie in one plane.
  bool begin() {
    const std::array<std::uint32_t, 4> corners = find_first_corners();
    if (corners[3] == kNobody) return false;
    const auto [a, b, c, d] = corners;
    for (const std::array<std::uint32_t, 3>& t : {std::array{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}}) {
      add_facet(t);
    }
    const std::array<std::array<std::uint32_t, 3>, 4> neighbors = {
        {{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}}};
    for (std::size_t i = 0; i < 4; ++i) facets_[i].neighbor = neighbors[i];
    std::vector<std::uint32_t> all(points_.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    share_out(all, 0);
    return true;
  }

  /// Returns false if no point is outside.
  bool add_farthest() {
    const Facet* highest = &facets_.front();
    for (const Facet& facet : facets_) {
      if (facet.is_alive && facet.farthest != kNobody &&
          (!is_candidate(*highest) || facet.height > highest->height)) {
        highest = &facet;
      }
    }
    if (!is_candidate(*highest)) return false;
    add_point(static_cast<std::uint32_t>(highest - facets_.data()), highest->farthest);
    return true;
  }

  [[nodiscard]] std::vector<HullTriangle> triangles() const {
    std::vector<std::uint32_t> number(facets_.size(), kNobody);
    std::vector<HullTriangle> result;
    for (std::size_t i = 0; i < facets_.size(); ++i) {
      if (!facets_[i].is_alive) continue;
      number[i] = static_cast<std::uint32_t>(result.size());
      result.push_back(facets_[i]);
    }
    for (HullTriangle& t : result) {
      HOOKE_ASSERT(std::ranges::all_of(t.neighbor, [&](std::uint32_t n) { return number[n] != kNobody; }));
      for (std::uint32_t& n : t.neighbor) n = number[n];
    }
    return result;
  }

 private:
  static bool is_candidate(const Facet& facet) { return facet.is_alive && facet.farthest != kNobody; }

  /// The ends of the order, the point farthest from their line, and the one farthest from the plane of the
  /// three, which sees the back of the first three; kNobody if there is none.
  [[nodiscard]] std::array<std::uint32_t, 4> find_first_corners() const {
    std::array<std::uint32_t, 4> corner = {0, static_cast<std::uint32_t>(points_.size() - 1), kNobody,
                                           kNobody};
    const GridPoint origin = points_.front();
    const GridPoint along = points_.back() - origin;
    double distance_max = 0;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const double distance = length_squared(as_double(cross(along, points_[i] - origin)));
      if (distance > distance_max) {
        distance_max = distance;
        corner[2] = i;
      }
    }
    if (corner[2] == kNobody) return corner;
    const GridPoint normal = cross(along, points_[corner[2]] - origin);
    std::int64_t farthest = 0;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const std::int64_t height = dot(normal, points_[i] - origin);
      if (std::abs(height) > std::abs(farthest)) {
        farthest = height;
        corner[3] = i;
      }
    }
    if (farthest > 0) std::swap(corner[0], corner[1]);
    return corner;
  }

  std::uint32_t add_facet(const std::array<std::uint32_t, 3>& vertex) {
    Facet facet;
    facet.vertex = vertex;
    const GridPoint a = points_[vertex[0]];
    facet.normal = cross(points_[vertex[1]] - a, points_[vertex[2]] - a);
    HOOKE_ASSERT(facet.normal != GridPoint{});
    facet.inverse_length = 1.0 / length(as_double(facet.normal));
    facets_.push_back(std::move(facet));
    return static_cast<std::uint32_t>(facets_.size() - 1);
  }

  /// Assigns each point to the facet, of those from `first` on, over which it is highest.
  void share_out(std::span<const std::uint32_t> points, std::size_t first) {
    for (const std::uint32_t point : points) {
      Facet* best = nullptr;
      double height_max = tolerance_;
      for (std::size_t i = first; i < facets_.size(); ++i) {
        const double height = height_over(facets_[i], points_, points_[point]);
        if (!(height > height_max)) continue;
        height_max = height;
        best = &facets_[i];
      }
      if (best == nullptr) continue;
      best->outside.push_back(point);
      if (height_max > best->height) {
        best->height = height_max;
        best->farthest = point;
      }
    }
  }

  /// Replaces the facets that the point sees, `seen` among them, by a cone to the point.
  void add_point(std::uint32_t seen, std::uint32_t point) {
    remove_visible(seen, points_[point]);
    HOOKE_ASSERT(horizon_.size() >= 3);
    const std::size_t first = facets_.size();
    for (const HorizonEdge& edge : horizon_) {
      facet_from_[edge.start] = add_facet({edge.start, edge.end, point});
    }
    for (std::size_t i = 0; i < horizon_.size(); ++i) {
      const HorizonEdge& edge = horizon_[i];
      const auto facet = static_cast<std::uint32_t>(first + i);
      const std::uint32_t next = facet_from_[edge.end];
      HOOKE_ASSERT(next >= first && next < facets_.size());  // the rim is a loop
      facets_[facet].neighbor[0] = edge.beyond;
      facets_[facet].neighbor[1] = next;
      facets_[next].neighbor[2] = facet;
      for (std::size_t k = 0; k < 3; ++k) {
        if (facets_[edge.beyond].vertex[k] == edge.end) facets_[edge.beyond].neighbor[k] = facet;
      }
    }
    share_out(orphans_, first);
  }

  /// Removes the facets that `eye` sees. Puts the rim into `horizon_` and the points outside into `orphans_`.
  /// With exact heights the rim is a simple loop, and `eye` is on none of the lines of its edges.
  void remove_visible(std::uint32_t seen, GridPoint eye) {
    std::vector<std::uint32_t> visible = {seen};
    facets_[seen].is_alive = false;
    for (std::size_t i = 0; i < visible.size(); ++i) {
      for (const std::uint32_t neighbor : facets_[visible[i]].neighbor) {
        if (!facets_[neighbor].is_alive || scaled_height(facets_[neighbor], points_, eye) <= 0) continue;
        facets_[neighbor].is_alive = false;
        visible.push_back(neighbor);
      }
    }
    horizon_.clear();
    orphans_.clear();
    for (const std::uint32_t f : visible) {
      Facet& facet = facets_[f];
      for (std::size_t k = 0; k < 3; ++k) {
        if (!facets_[facet.neighbor[k]].is_alive) continue;
        horizon_.push_back({facet.vertex[k], facet.vertex[(k + 1) % 3], facet.neighbor[k]});
      }
      orphans_.insert(orphans_.end(), facet.outside.begin(), facet.outside.end());
      facet.outside = {};
    }
  }

  std::span<const GridPoint> points_;
  double tolerance_;
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> facet_from_;  // facets of the cone being made, by their first vertex
  std::vector<HorizonEdge> horizon_;
  std::vector<std::uint32_t> orphans_;
};

}  // namespace

std::vector<HullTriangle> triangulate_hull(std::span<const GridPoint> points, double tolerance,
                                           int vertex_limit) {
  if (points.size() < 4) return {};
  Quickhull hull(points, tolerance);
  if (!hull.begin()) return {};
  for (int vertices = 4; vertices < vertex_limit; ++vertices) {
    if (!hull.add_farthest()) break;
  }
  return hull.triangles();
}

}  // namespace hooke::geometry
