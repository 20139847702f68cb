#include "geometry/mesh/geodesic.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A smaller change is not worth marching again; it also bounds how often that can happen.
constexpr double kWorthwhile = 1.0 - 1e-7;

/// A triangle laid flat: a at the origin, b on the x axis, c above it.
struct FlatTriangle {
  double base = 0.0;  // x of b
  double x = 0.0;     // x of c
  double y = 0.0;     // y of c, not negative
};

/// Lays a triangle flat. Precondition: a and b are different points.
FlatTriangle lay_flat(DVec3 a, DVec3 b, DVec3 c) {
  const double base = length(b - a);
  const double x = dot(c - a, b - a) / base;
  return {base, x, length(cross(b - a, c - a)) / base};
}

/// Distance of c from a source at the given distances from a and b, on the other side of ab. Infinity if
/// there is no such point, or if the straight line from it to c misses the edge.
double distance_from_point_source(const FlatTriangle& t, double from_a, double from_b) {
  const double source_x = 0.5 * ((from_a - from_b) * (from_a + from_b) / t.base + t.base);
  const double depth_squared = (from_a - source_x) * (from_a + source_x);
  if (!(depth_squared >= 0.0)) return kInfinity;
  const double depth = std::sqrt(depth_squared);
  const double height = depth + t.y;
  if (!(height > 0.0)) return kInfinity;
  const double crossing = source_x + (t.x - source_x) * (depth / height);
  if (crossing < 0.0 || crossing > t.base) return kInfinity;
  return std::sqrt((t.x - source_x) * (t.x - source_x) + height * height);
}

/// Distance of c from a straight front that passes a and b at the given distances.
double distance_from_straight_front(const FlatTriangle& t, double from_a, double from_b) {
  const double along = (from_b - from_a) / t.base;
  const double across_squared = 1.0 - along * along;
  if (!(across_squared > 0.0)) return kInfinity;
  const double across = std::sqrt(across_squared);
  const double crossing = t.x - t.y * along / across;
  if (crossing < 0.0 || crossing > t.base) return kInfinity;
  return from_a + along * t.x + across * t.y;
}

class March {
 public:
  March(std::span<const Vec3> positions, std::span<const std::uint32_t> sources)
      : positions_(positions), distance_(positions.size(), kInfinity), source_(positions.size(), kNone) {
    for (const std::uint32_t source : sources) {
      if (source < positions.size()) offer(source, 0.0, source);
    }
  }

  void run(std::span<const Triangle> triangles, const MeshTopology& topology) {
    while (!front_.empty()) {
      const auto [distance, vertex] = front_.top();
      front_.pop();
      if (distance > distance_[vertex]) continue;
      for (const std::uint32_t t : topology.triangles_at(vertex)) {
        const Triangle& triangle = triangles[t];
        const std::uint32_t corner = triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
        const std::uint32_t after = triangle[(corner + 1) % 3];
        const std::uint32_t before = triangle[(corner + 2) % 3];
        update(vertex, before, after);
        update(vertex, after, before);
      }
    }
  }

  [[nodiscard]] GeodesicField take_field() && {
    GeodesicField field;
    field.distance.reserve(distance_.size());
    for (const double distance : distance_) field.distance.push_back(static_cast<Real>(distance));
    field.source = std::move(source_);
    return field;
  }

 private:
  [[nodiscard]] DVec3 position(std::uint32_t vertex) const { return vector_cast<double>(positions_[vertex]); }

  /// Updates the distance of c across the edge ab, and through a or b.
  void update(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    offer(c, distance_[a] + length(position(c) - position(a)), source_[a]);
    if (distance_[b] == kInfinity || positions_[a] == positions_[b]) return;
    const FlatTriangle flat = lay_flat(position(a), position(b), position(c));
    if (!(flat.base > 0.0)) return;
    if (source_[a] == source_[b]) {
      offer(c, distance_from_point_source(flat, distance_[a], distance_[b]), source_[a]);
      return;
    }
    const double straight_a = length(position(c) - position(source_[a]));
    const double straight_b = length(position(c) - position(source_[b]));
    const bool is_a_nearer = straight_a < straight_b || (straight_a == straight_b && source_[a] < source_[b]);
    offer(c, distance_from_straight_front(flat, distance_[a], distance_[b]), source_[is_a_nearer ? a : b]);
  }

  void offer(std::uint32_t vertex, double candidate, std::uint32_t source) {
    if (!(candidate < kWorthwhile * distance_[vertex])) return;
    candidate = std::max(candidate, length(position(vertex) - position(source)));
    if (!(candidate < kWorthwhile * distance_[vertex])) return;
    distance_[vertex] = candidate;
    source_[vertex] = source;
    front_.push({candidate, vertex});
  }

  using Entry = std::pair<double, std::uint32_t>;

  std::span<const Vec3> positions_;
  std::vector<double> distance_;
  std::vector<std::uint32_t> source_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>>
      front_;  // nearest, then smallest index, first
};

}  // namespace

GeodesicField compute_geodesic_field(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                     const MeshTopology& topology, std::span<const std::uint32_t> sources) {
  HOOKE_ASSERT(topology.vertex_triangle_begin.size() == positions.size() + 1);
  March march(positions, sources);
  march.run(triangles, topology);
  return std::move(march).take_field();
}

}  // namespace hooke::geometry
