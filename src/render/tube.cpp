#include "render/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hooke::render {

namespace {

constexpr int kSides = 14;
constexpr std::uint32_t kRing = kSides + 1;  ///< Vertices of a ring.
constexpr int kTubeCapRings = 4;

constexpr float kHairsPerSpread = 5;    ///< Hairs of a tuft per radius of a hair in its spread.
constexpr float kFewestHairs = 24;      ///< Of a tuft.
constexpr float kMostHairs = 96;        ///< The same.
constexpr float kLeastSpread = 4;       ///< Of a tuft, in radii of the hair that was simulated.
constexpr float kMostSpread = 24;       ///< The same.
constexpr float kSpreadPerGap = 0.75F;  ///< Of a tuft, in distances to the next root.
constexpr float kHairRadius = 0.28F;    ///< Radius of a drawn hair, likewise.

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
void add_ring(Vec3 center, float radius, const Mat3& frame, float lean, float v, MeshGeometry& geometry) {
  const float flat = std::sqrt(std::max(1 - lean * lean, 0.0F));
  // The last vertex is the first again with another texture coordinate.
  for (int i = 0; i <= kSides; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSides;
    const Vec3 normal = flat * (std::cos(angle) * frame.x + std::sin(angle) * frame.y) + lean * frame.z;
    geometry.vertices.push_back({center + radius * normal, normal, static_cast<float>(i) / kSides, v});
  }
}

void join_rings(std::uint32_t first, std::uint32_t ring_count, MeshGeometry& geometry) {
  for (std::uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const std::uint32_t a = first + ring * kRing + i;
      const std::uint32_t b = a + 1;
      geometry.indices.insert(geometry.indices.end(), {a, b, a + kRing, a + kRing, b, b + kRing});
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

/// Returns a number from 0 to 1 that is the same for the same hair in every picture.
float lot_of(std::uint32_t hair, std::uint32_t salt) {
  std::uint32_t x = (hair + 1) * 0x9E3779B9U ^ salt * 0x85EBCA6BU;
  x = (x ^ (x >> 16)) * 0x7FEB352DU;
  x = (x ^ (x >> 15)) * 0x846CA68BU;
  return static_cast<float>((x ^ (x >> 16)) >> 8) / 16777216;
}

/// The place of one hair within its tuft.
struct HairPlace {
  float angle = 0;     ///< Direction from the middle.
  float share = 0;     ///< Distance from the middle, in radii of the tuft.
  float length = 1;    ///< In lengths of the tuft.
  float waviness = 0;  ///< In radii of the tuft.
  float lot = 0;
};

HairPlace hair_place(std::uint32_t hair, std::uint32_t tuft) {
  const std::uint32_t seed = hair + 131 * tuft;
  return {2 * std::numbers::pi_v<float> * lot_of(seed, 1), std::sqrt(lot_of(seed, 2)),
          0.86F + 0.14F * lot_of(seed, 3), 0.5F * lot_of(seed, 4), lot_of(seed, 5)};
}

/// Adds one hair as a strip that faces the eye and grows thin toward its tip.
void add_hair(std::span<const Station> stations, std::span<const Mat3> frames, const HairPlace& place,
              const std::array<float, 2>& radii, Vec3 eye, MeshGeometry& geometry) {
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  const auto count =
      static_cast<std::size_t>(std::max(2.0F, std::ceil(place.length * static_cast<float>(stations.size()))));
  const auto last = static_cast<float>(count - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const float v = static_cast<float>(i) / last;
    // Hairs lie close at the root and the tip, and apart between.
    const float spread = radii[0] * (0.55F + 0.9F * v - 0.75F * v * v);
    const float wave = place.waviness * std::sin(9 * v + 6.283F * place.lot);
    const float x = place.share * std::cos(place.angle) + wave * v;
    const float y = place.share * std::sin(place.angle) + wave * (1 - v) * v;
    const Vec3 center = stations[i].point + spread * (x * frames[i].x + y * frames[i].y);
    const Vec3 along = stations[i].tangent;
    Vec3 side = normalize(cross(along, eye - center));
    if (side == Vec3{}) side = frames[i].x;
    const float half = radii[1] * std::max(1 - v * v * v * v, 0.15F);
    geometry.vertices.push_back({center - half * side, along, place.lot, v});
    geometry.vertices.push_back({center + half * side, along, place.lot, v});
  }
  for (std::uint32_t i = 0; i + 1 < static_cast<std::uint32_t>(count); ++i) {
    const std::uint32_t a = first + 2 * i;
    geometry.indices.insert(geometry.indices.end(), {a, a + 1, a + 2, a + 2, a + 1, a + 3});
  }
}

}  // namespace

float tuft_spread(std::span<const Vec3> roots, std::size_t one, float radius) {
  float nearest = HUGE_VALF;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    if (i != one) nearest = std::min(nearest, length(roots[i] - roots[one]));
  }
  // A hair by itself, or one without a place, is no part of a head.
  const float gap = std::isfinite(nearest) ? kSpreadPerGap * nearest : 0;
  return std::clamp(gap, kLeastSpread * radius, kMostSpread * radius);
}

void add_tuft(std::span<const Vec3> points, const Tuft& tuft, Vec3 eye, MeshGeometry& geometry) {
  const float radius = tuft.radius;
  if (!(radius > 0) || !std::isfinite(radius)) return;
  const std::vector<Vec3> usable = usable_points(points, radius);
  if (usable.size() < 2) return;
  const std::vector<Station> stations = make_stations(usable, (tuft.few ? 8 : 4) * radius);
  std::vector<Mat3> frames;
  const Vec3 start = stations.front().tangent;
  const Vec3 aside = std::abs(start.y) < 0.9F ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  Mat3 frame = carried_frame({cross(aside, start), aside, start}, start);
  for (const Station& station : stations) {
    if (station.tangent != Vec3{}) frame = carried_frame(frame, station.tangent);
    frames.push_back(frame);
  }
  const auto hairs = static_cast<std::uint32_t>(
      std::clamp(kHairsPerSpread * tuft.spread / radius, kFewestHairs, kMostHairs));
  const float width = (tuft.few ? 2 : 1) * kHairRadius * radius;
  for (std::uint32_t hair = 0; hair < hairs; hair += tuft.few ? 4 : 1) {
    add_hair(stations, frames, hair_place(hair, tuft.number), {tuft.spread, width}, eye, geometry);
  }
}

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
    add_ring(stations.front().point, ring_radius, frame, -lean_of(ring), 0, geometry);
  }
  const float circumference = 2 * std::numbers::pi_v<float> * radius;
  float along = 0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Station& station = stations[i];
    if (i > 0) along += length(station.point - stations[i - 1].point) / circumference;
    if (station.tangent != Vec3{}) frame = carried_frame(frame, station.tangent);
    add_ring(station.point, ring_radius, frame, 0, along, geometry);
  }
  for (int ring = 1; ring <= kTubeCapRings; ++ring) {
    add_ring(stations.back().point, ring_radius, frame, lean_of(ring), along, geometry);
  }
  const auto rings = (static_cast<std::uint32_t>(geometry.vertices.size()) - first) / kRing;
  join_rings(first, rings, geometry);
}

}  // namespace hooke::render
