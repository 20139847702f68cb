#include "build/tethers.h"

#include "base/assert.h"
#include "base/disjoint_sets.h"
#include "geometry/mesh/geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::build {

namespace {

constexpr std::size_t kMostTethersOfPoint = 4;
/// Pins that are asked for each point. Distances along a curved surface take long to find.
constexpr std::size_t kMostPinsOfFlat = 256;
constexpr std::size_t kMostPinsOfCurved = 32;
/// Two pins hold a point against the same if the angle between them is less than 10 degrees, as seen from
/// it; this is the cosine.
constexpr double kAlike = 0.985;

/// Ties the points that a pin holds to it.
void append_tethers_of(const TetherSurface& surface, std::uint32_t pin, std::span<const std::uint32_t> held,
                       std::vector<Tether>& tethers) {
  if (surface.is_flat) {
    for (const std::uint32_t i : held)
      tethers.push_back({i, pin, static_cast<Real>(length(surface.points[i] - surface.points[pin]))});
    return;
  }
  std::vector<Vec3> offsets;
  for (const DVec3& p : surface.points) offsets.push_back(vector_cast<Real>(p - surface.points[pin]));
  const auto field =
      geometry::compute_geodesic_field(offsets, surface.triangles, surface.topology, {&pin, 1});
  HOOKE_ASSERT(field.distance.size() == surface.points.size());
  for (const std::uint32_t i : held) tethers.push_back({i, pin, field.distance[i]});
}

/// Of many pins, keeps `most` that lie far apart: each is the farthest one from those before it.
std::vector<std::uint32_t> thin_out(const TetherSurface& surface, std::vector<std::uint32_t> pins,
                                    std::size_t most) {
  if (pins.size() <= most) return pins;
  std::vector<double> gap(pins.size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> kept;
  std::size_t next = 0;
  while (kept.size() < most) {
    kept.push_back(pins[next]);
    const DVec3 last = surface.points[pins[next]];
    for (std::size_t i = 0; i < pins.size(); ++i)
      gap[i] = std::min(gap[i], length_squared(surface.points[pins[i]] - last));
    next = static_cast<std::size_t>(std::distance(gap.begin(), std::max_element(gap.begin(), gap.end())));
  }
  return kept;
}

/// Chooses the pins that hold a point.
class PinChoice {
 public:
  PinChoice(const TetherSurface& surface, std::span<const std::uint32_t> pins)
      : surface_(surface), pins_(pins), parts_(surface.points.size()), sight_(pins.size()) {
    for (const geometry::Edge& edge : surface.topology.edges) parts_.merge(edge[0], edge[1]);
    for (const std::uint32_t pin : pins) part_of_pin_.push_back(parts_.root(pin));
  }

  /// The nearest pin of its part of the surface, and then those whose directions differ most from the
  /// directions to the ones before.
  const std::vector<std::uint32_t>& choose(std::uint32_t point) {
    chosen_.clear();
    std::size_t next = look(point);
    while (next < pins_.size() && chosen_.size() < kMostTethersOfPoint) {
      chosen_.push_back(pins_[next]);
      next = find_other_side(sight_[next].direction);
    }
    return chosen_;
  }

 private:
  /// A pin as seen from the point.
  struct Sight {
    DVec3 direction = {};
    double alike = 0;  ///< Largest cosine of the angle to the pins that are chosen.
  };

  /// Looks at all pins from a point. Returns which is nearest, or the number of pins if there is none.
  std::size_t look(std::uint32_t point) {
    std::size_t nearest = pins_.size();
    double least = std::numeric_limits<double>::infinity();
    const std::uint32_t part = parts_.root(point);
    for (std::size_t i = 0; i < pins_.size(); ++i) {
      const DVec3 way = surface_.points[pins_[i]] - surface_.points[point];
      const double distance = length(way);
      const bool counts = distance > 0 && part_of_pin_[i] == part;
      sight_[i] = counts ? Sight{(1 / distance) * way, -1} : Sight{{}, 1};
      if (!counts || distance >= least) continue;
      least = distance;
      nearest = i;
    }
    return nearest;
  }

  std::size_t find_other_side(DVec3 last) {
    std::size_t other = pins_.size();
    double least = kAlike;
    for (std::size_t i = 0; i < pins_.size(); ++i) {
      Sight& sight = sight_[i];
      sight.alike = std::max(sight.alike, dot(last, sight.direction));
      if (sight.alike >= least) continue;
      least = sight.alike;
      other = i;
    }
    return other;
  }

  const TetherSurface& surface_;
  std::span<const std::uint32_t> pins_;
  base::DisjointSets parts_;  ///< Points that edges join.
  std::vector<std::uint32_t> part_of_pin_;
  std::vector<Sight> sight_;  ///< By pin.
  std::vector<std::uint32_t> chosen_;
};

}  // namespace

std::vector<Tether> find_tethers(const TetherSurface& surface, std::span<const std::uint32_t> pins) {
  std::vector<bool> is_pin(surface.points.size(), false);
  std::vector<std::uint32_t> distinct;
  for (const std::uint32_t pin : pins) {
    HOOKE_ASSERT(pin < is_pin.size());
    if (!is_pin[pin]) distinct.push_back(pin);
    is_pin[pin] = true;
  }
  const std::vector<std::uint32_t> asked =
      thin_out(surface, std::move(distinct), surface.is_flat ? kMostPinsOfFlat : kMostPinsOfCurved);
  PinChoice choice(surface, asked);
  std::vector<std::vector<std::uint32_t>> held(surface.points.size());  // By pin: the points that it holds.
  for (std::uint32_t i = 0; i < surface.points.size(); ++i) {
    if (is_pin[i]) continue;
    for (const std::uint32_t pin : choice.choose(i)) held[pin].push_back(i);
  }
  std::vector<Tether> tethers;
  for (const std::uint32_t pin : asked) {
    if (!held[pin].empty()) append_tethers_of(surface, pin, held[pin], tethers);
  }
  return tethers;
}

}  // namespace hooke::build
