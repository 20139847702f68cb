#include "build/tethers.h"

#include "geometry/geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::build {

namespace {

constexpr std::size_t kMostPinsWithSecond = 8;

std::vector<double> distances_from(const TetherSurface& surface, std::uint32_t pin) {
  std::vector<double> result;
  if (surface.is_flat) {
    for (const DVec3& p : surface.points) result.push_back(length(p - surface.points[pin]));
    return result;
  }
  std::vector<Vec3> offsets;
  for (const DVec3& p : surface.points) offsets.push_back(vector_cast<Real>(p - surface.points[pin]));
  const auto field = geometry::compute_geodesic_field(offsets, surface.triangles, surface.topology, {&pin, 1});
  result.assign(field.distance.begin(), field.distance.end());
  return result;
}

}  // namespace

std::vector<Tether> find_tethers(const TetherSurface& surface, std::span<const std::uint32_t> pins) {
  const double inf = std::numeric_limits<double>::infinity();
  struct Best {
    double length[2];
    std::uint32_t pin[2];
  };
  std::vector<Best> best(surface.points.size(), {{inf, inf}, {0, 0}});
  std::vector<bool> is_pin(surface.points.size(), false);
  for (const std::uint32_t pin : pins) {
    if (is_pin[pin]) continue;
    is_pin[pin] = true;
    const std::vector<double> distance = distances_from(surface, pin);
    for (std::size_t i = 0; i < best.size(); ++i) {
      Best& b = best[i];
      const int place = distance[i] < b.length[0] ? 0 : (distance[i] < b.length[1] ? 1 : 2);
      if (place == 0) b = {{distance[i], b.length[0]}, {pin, b.pin[0]}};
      if (place == 1) b = {{b.length[0], distance[i]}, {b.pin[0], pin}};
    }
  }
  std::vector<Tether> tethers;
  const int rounds = pins.size() > kMostPinsWithSecond ? 1 : 2;
  for (int round = 0; round < rounds; ++round) {
    for (std::uint32_t i = 0; i < best.size(); ++i) {
      if (is_pin[i] || std::isinf(best[i].length[round])) continue;
      tethers.push_back({i, best[i].pin[round], static_cast<Real>(best[i].length[round])});
    }
  }
  return tethers;
}

}  // namespace hooke::build
