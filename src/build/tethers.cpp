#include "build/tethers.h"

#include "base/assert.h"
#include "geometry/mesh/geodesic.h"

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
  const auto field =
      geometry::compute_geodesic_field(offsets, surface.triangles, surface.topology, {&pin, 1});
  result.assign(field.distance.begin(), field.distance.end());
  return result;
}

struct NearestPin {
  double length = std::numeric_limits<double>::infinity();
  std::uint32_t pin = 0;
};

/// Finds for each point the nearest of the pins for which counts(point, pin) is true.
template <class Counts>
std::vector<NearestPin> find_nearest_pins(const TetherSurface& surface, std::span<const std::uint32_t> pins,
                                          Counts&& counts) {
  std::vector<NearestPin> nearest(surface.points.size());
  std::vector<std::uint32_t> points;  // Points for which the pin counts.
  for (const std::uint32_t pin : pins) {
    points.clear();
    for (std::uint32_t i = 0; i < nearest.size(); ++i) {
      if (counts(i, pin)) points.push_back(i);
    }
    if (points.empty()) continue;  // Distances along a curved surface take long to find.
    const std::vector<double> distance = distances_from(surface, pin);
    HOOKE_ASSERT(distance.size() == nearest.size());
    for (const std::uint32_t i : points) {
      if (distance[i] < nearest[i].length) nearest[i] = {distance[i], pin};
    }
  }
  return nearest;
}

/// Whether `other` and `pin` lie on different sides of the point: the directions to them differ by more than
/// a right angle. Those to two pins on one straight edge do not.
bool is_opposite(const TetherSurface& surface, std::uint32_t point, std::uint32_t pin, std::uint32_t other) {
  const DVec3 to_pin = surface.points[pin] - surface.points[point];
  const DVec3 to_other = surface.points[other] - surface.points[point];
  return dot(to_pin, to_other) < 0;
}

}  // namespace

std::vector<Tether> find_tethers(const TetherSurface& surface, std::span<const std::uint32_t> pins) {
  std::vector<bool> is_pin(surface.points.size(), false);
  std::vector<std::uint32_t> distinct;
  for (const std::uint32_t pin : pins) {
    HOOKE_ASSERT(pin < is_pin.size());
    if (!is_pin[pin]) distinct.push_back(pin);
    is_pin[pin] = true;
  }
  const bool few = pins.size() <= kMostPinsWithSecond;
  const std::vector<NearestPin> first =
      find_nearest_pins(surface, distinct, [](std::uint32_t, std::uint32_t) { return true; });
  const std::vector<NearestPin> second =
      find_nearest_pins(surface, distinct, [&](std::uint32_t point, std::uint32_t pin) {
        return few ? pin != first[point].pin : is_opposite(surface, point, first[point].pin, pin);
      });
  std::vector<Tether> tethers;
  for (const std::vector<NearestPin>& round : {first, second}) {
    for (std::uint32_t i = 0; i < round.size(); ++i) {
      if (is_pin[i] || std::isinf(round[i].length)) continue;
      tethers.push_back({i, round[i].pin, static_cast<Real>(round[i].length)});
    }
  }
  return tethers;
}

}  // namespace hooke::build
