#include "render/shapes.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace hooke::render {

namespace {

constexpr int kSides = 14;
constexpr int kTubeCapRings = 4;

/// A Station is a point of the curve and its unit tangent.
struct Station {
  Vec3 point;
  Vec3 tangent;
};

std::vector<Vec3> usable_points(std::span<const Vec3> points, float radius) {
  std::vector<Vec3> result;
  const float closest = 1e-3F * radius;
  for (const Vec3 p : points) {
    if (is_finite(p) && (result.empty() || length(p - result.back()) > closest)) result.push_back(p);
  }
  return result;
}

/// Returns a point at `part` of the way from p1 to p2 on the Catmull-Rom curve with centripetal knots, by
/// Barry and Goldman's pyramid. This curve makes no loops where points are close together (Yuksel, Schaefer,
/// Keyser 2011).
Vec3 curve_point(const std::array<Vec3, 4>& p, float part) {
  std::array<float, 4> t = {};
  for (std::size_t i = 1; i < 4; ++i) t[i] = t[i - 1] + std::sqrt(std::max(length(p[i] - p[i - 1]), 1e-9F));
  const float now = t[1] + part * (t[2] - t[1]);
  const auto mix = [&](Vec3 a, Vec3 b, std::size_t i, std::size_t j) {
    const float s = (now - t[i]) / (t[j] - t[i]);
    return (1 - s) * a + s * b;
  };
  const Vec3 a = mix(p[0], p[1], 0, 1);
  const Vec3 b = mix(p[1], p[2], 1, 2);
  const Vec3 c = mix(p[2], p[3], 2, 3);
  return mix(mix(a, b, 0, 2), mix(b, c, 1, 3), 1, 2);
}

/// Cuts the curve so finely that one piece is about as long as the rope is thick.
std::vector<Station> make_stations(const std::vector<Vec3>& points, float radius) {
  std::vector<Station> stations;
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    const Vec3 before = i > 0 ? points[i - 1] : 2 * points[0] - points[1];
    const Vec3 after = i + 1 < last ? points[i + 2] : 2 * points[last] - points[last - 1];
    const std::array<Vec3, 4> knots = {before, points[i], points[i + 1], after};
    const float pieces = std::ceil(length(points[i + 1] - points[i]) / (2 * radius));
    const int steps = static_cast<int>(std::clamp(pieces, 1.0F, 6.0F));
    for (int s = 0; s < steps; ++s) {
      stations.push_back({curve_point(knots, static_cast<float>(s) / static_cast<float>(steps)), {}});
    }
  }
  stations.push_back({points[last], {}});
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Vec3 from = stations[i > 0 ? i - 1 : 0].point;
    const Vec3 to = stations[std::min(i + 1, stations.size() - 1)].point;
    stations[i].tangent = normalize(to - from);
  }
  return stations;
}

/// Adds a circle of vertices about `center`. Their normals are across the axis where `lean` is 0 and along it
/// where `lean` is 1.
void add_ring(Vec3 center, float radius, const Mat3& frame, float lean, MeshGeometry& geometry) {
  const float flat = std::sqrt(std::max(1 - lean * lean, 0.0F));
  for (int i = 0; i < kSides; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSides;
    const Vec3 normal = flat * (std::cos(angle) * frame.x + std::sin(angle) * frame.y) + lean * frame.z;
    geometry.vertices.push_back({center + radius * normal, normal, static_cast<float>(i) / kSides, 0});
  }
}

void join_rings(std::uint32_t first, std::uint32_t ring_count, MeshGeometry& geometry) {
  for (std::uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const std::uint32_t a = first + ring * kSides + i;
      const std::uint32_t b = first + ring * kSides + (i + 1) % kSides;
      geometry.indices.insert(geometry.indices.end(), {a, b, a + kSides, a + kSides, b, b + kSides});
    }
  }
}

/// Returns `frame` rotated to the next tangent by the smallest rotation, so that the tube does not twist.
Mat3 carried_frame(const Mat3& frame, Vec3 tangent) {
  Vec3 x = normalize(frame.x - dot(frame.x, tangent) * tangent);
  // In a hairpin within one piece the old x axis runs along the rope; the old y axis cannot.
  if (x == Vec3{}) x = normalize(cross(frame.y, tangent));
  return {x, cross(tangent, x), tangent};
}

}  // namespace

void add_tube(std::span<const Vec3> points, float radius, MeshGeometry& geometry) {
  if (!(radius > 0) || !std::isfinite(radius)) return;
  const std::vector<Vec3> usable = usable_points(points, radius);
  if (usable.size() < 2) return;
  const std::vector<Station> stations = make_stations(usable, radius);

  // Seen from all sides, a polygon is on average this much narrower than its circle.
  const float widening = 2 / (1 + std::cos(std::numbers::pi_v<float> / kSides));
  const float ring_radius = widening * radius;
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  const Vec3 start = stations.front().tangent;
  const Vec3 aside = std::abs(start.y) < 0.9F ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  Mat3 frame = carried_frame({cross(aside, start), aside, start}, start);
  const auto lean_of = [](int ring) {
    return std::sin(0.5F * std::numbers::pi_v<float> * static_cast<float>(ring) / kTubeCapRings);
  };
  for (int ring = kTubeCapRings; ring > 0; --ring) {
    add_ring(stations.front().point, ring_radius, frame, -lean_of(ring), geometry);
  }
  for (const Station& station : stations) {
    if (station.tangent != Vec3{}) frame = carried_frame(frame, station.tangent);
    add_ring(station.point, ring_radius, frame, 0, geometry);
  }
  for (int ring = 1; ring <= kTubeCapRings; ++ring) {
    add_ring(stations.back().point, ring_radius, frame, lean_of(ring), geometry);
  }
  const auto rings = (static_cast<std::uint32_t>(geometry.vertices.size()) - first) / kSides;
  join_rings(first, rings, geometry);
}

}  // namespace hooke::render
