#include "geometry/mesh/mesh_clean.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace hooke::geometry {

namespace {

/// A grid with cells of four weld distances: a point's neighborhood then touches one or two cells per axis.
class WeldGrid {
 public:
  WeldGrid(DVec3 low, double distance)
      : low_(low), distance_(distance), cell_(distance > 0 ? 4 * distance : 1) {}

  /// The earliest point stored within the distance of `p`, or kNone.
  [[nodiscard]] std::uint32_t find(DVec3 p) const {
    std::uint32_t best = kNone;
    const DVec3 reach = {distance_, distance_, distance_};
    const auto from = cell_of(p - reach);
    const auto to = cell_of(p + reach);
    for (std::int64_t x = from[0]; x <= to[0]; ++x) {
      for (std::int64_t y = from[1]; y <= to[1]; ++y) {
        for (std::int64_t z = from[2]; z <= to[2]; ++z) best = std::min(best, find_in({x, y, z}, p));
      }
    }
    return best;
  }

  void add(DVec3 p) {
    const auto [entry, is_new] = newest_.try_emplace(key(cell_of(p)), kNone);
    points_.push_back({p, entry->second});
    entry->second = static_cast<std::uint32_t>(points_.size() - 1);
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Stored {
    DVec3 position;
    std::uint32_t older = kNone;  ///< The previous point of the same key.
  };

  [[nodiscard]] Cell cell_of(DVec3 p) const {
    const auto axis = [&](double v) { return static_cast<std::int64_t>(std::floor(v / cell_)); };
    return {axis(p.x - low_.x), axis(p.y - low_.y), axis(p.z - low_.z)};
  }

  /// Cells may share a key: `find_in` compares positions anyway.
  static std::uint64_t key(const Cell& cell) {
    std::uint64_t k = 0;
    for (const std::int64_t axis : cell) {
      k = (k ^ static_cast<std::uint64_t>(axis)) * 0x9E3779B97F4A7C15ULL;
      k ^= k >> 29u;
    }
    return k;
  }

  [[nodiscard]] std::uint32_t find_in(const Cell& cell, DVec3 p) const {
    const auto entry = newest_.find(key(cell));
    std::uint32_t best = kNone;
    for (std::uint32_t i = entry == newest_.end() ? kNone : entry->second; i != kNone; i = points_[i].older) {
      const DVec3 d = points_[i].position - p;
      if (std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= distance_) best = i;
    }
    return best;
  }

  DVec3 low_;
  double distance_;
  double cell_;
  std::unordered_map<std::uint64_t, std::uint32_t> newest_;
  std::vector<Stored> points_;
};

}  // namespace

double weld_distance(std::span<const DVec3> points) {
  if (points.empty()) return 0;
  const DBox box = bounds_of(points);
  return 1e-6 * length(box.upper - box.lower);
}

Weld weld(std::span<const DVec3> points, double distance) {
  Weld result;
  result.welded_of.reserve(points.size());
  WeldGrid grid(points.empty() ? DVec3{} : bounds_of(points).lower, distance);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::uint32_t welded = grid.find(points[i]);
    if (welded == kNone) {
      welded = static_cast<std::uint32_t>(result.first.size());
      result.first.push_back(i);
      grid.add(points[i]);
    }
    result.welded_of.push_back(welded);
  }
  return result;
}

bool is_degenerate(std::span<const DVec3> points, const Triangle& triangle, double distance) {
  const DVec3 a = points[triangle[0]];
  const DVec3 b = points[triangle[1]];
  const DVec3 c = points[triangle[2]];
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  return !(length(cross(b - a, c - a)) > distance * longest);
}

}  // namespace hooke::geometry
