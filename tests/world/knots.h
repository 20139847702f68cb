#pragma once

#include "hooke/world.h"

#include "geometry/closest.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/// \file
/// Ropes that touch each other, a knot in one, and what knot it is.

namespace hooke::test {

inline constexpr double kRopeRadius = 0.005;  // [m]

/// Of the lines in the middle of two ropes, or of one, whose segments count from an arc of `between` on.
inline double least_distance(PointView p, PointView q, bool is_same, double between = 0) {
  double least = 1e9;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    double arc = 0;
    for (std::size_t j = is_same ? i + 1 : 0; j + 1 < q.size(); ++j) {
      const auto near = geometry::closest_between_segments<double>({p[i], p[i + 1]}, {q[j], q[j + 1]});
      if (!is_same || arc >= between) least = std::min(least, std::sqrt(near.distance_squared));
      arc += length(q[j + 1] - q[j]);
    }
  }
  return least;
}

/// Where a line seen along z crosses itself: how far along it the strand below is there, and the one above.
struct StrandCrossing {
  double below = 0;
  double above = 0;
};

/// In the order in which they pass below.
inline std::vector<StrandCrossing> crossings_of(const std::vector<DVec3>& p) {
  std::vector<StrandCrossing> found;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    for (std::size_t j = i + 2; j + 1 < p.size(); ++j) {
      const DVec3 u = p[i + 1] - p[i];
      const DVec3 v = p[j + 1] - p[j];
      const DVec3 w = p[j] - p[i];
      const double area = cross(u, v).z;
      const double s = cross(w, v).z / area;
      const double t = cross(w, u).z / area;
      if (!(s >= 0 && s < 1 && t >= 0 && t < 1)) continue;
      const double a = static_cast<double>(i) + s;
      const double b = static_cast<double>(j) + t;
      found.push_back(p[i].z + s * u.z < p[j].z + t * v.z ? StrandCrossing{a, b} : StrandCrossing{b, a});
    }
  }
  std::sort(found.begin(), found.end(), [](StrandCrossing a, StrandCrossing b) { return a.below < b.below; });
  return found;
}

/// Of the knot that a rope along x makes when its ends are joined far away: 1 of a plain rope, 3 of an
/// overhand knot, whatever its shape; it changes only where the rope passes through itself or off its end. By
/// the equations of Fox's colorings: at each crossing twice the arc above is the sum of the two below.
inline double knot_determinant(PointView rope) {
  constexpr DVec3 kFar = {10, 0, 0};
  constexpr DVec3 kRound = {0, 10, 0};
  std::vector<DVec3> p = {rope[0] - kFar + kRound, rope[0] - kFar};
  for (std::size_t i = 0; i < rope.size(); ++i) p.push_back(rope[i]);
  p.insert(p.end(), {p.back() + kFar, p.back() + kFar + kRound});
  const std::vector<StrandCrossing> crossings = crossings_of(p);
  const std::size_t n = crossings.size();
  if (n == 0) return 1;
  std::vector<std::vector<double>> rows(n, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto above = std::find_if(crossings.begin(), crossings.end(),
                                    [&](StrandCrossing c) { return c.below > crossings[i].above; });
    rows[i][static_cast<std::size_t>(above - crossings.begin()) % n] += 2;
    rows[i][i] -= 1;
    rows[i][(i + 1) % n] -= 1;
  }
  double determinant = 1;
  for (std::size_t k = 0; k + 1 < n; ++k) {  // without the last row and column
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(k);
    const auto largest = std::max_element(
        first, rows.end() - 1, [&](const auto& a, const auto& b) { return std::abs(a[k]) < std::abs(b[k]); });
    std::iter_swap(first, largest);
    determinant *= rows[k][k];
    for (std::size_t i = k + 1; i + 1 < n && rows[k][k] != 0; ++i) {
      const double share = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j + 1 < n; ++j) rows[i][j] -= share * rows[k][j];
    }
  }
  return std::abs(determinant);
}

inline RopeDesc touching(std::vector<DVec3> points, double mass, double friction) {
  RopeDesc desc;
  desc.points = std::move(points);
  desc.total_mass = static_cast<Real>(mass);
  desc.pins = {};
  desc.radius = static_cast<Real>(kRopeRadius);
  desc.touches_ropes = true;
  desc.contact.friction = static_cast<Real>(friction);
  return desc;
}

inline std::vector<DVec3> straight(DVec3 from, DVec3 to, int n) {
  std::vector<DVec3> points;
  for (int i = 0; i < n; ++i) points.push_back(from + (i / (n - 1.0)) * (to - from));
  return points;
}

inline std::uint32_t last_of(const RopeDesc& desc) {
  return static_cast<std::uint32_t>(desc.points.size()) - 1;
}

/// Points `spacing` apart on a line through `fine` ones.
inline std::vector<DVec3> resampled(const std::vector<DVec3>& fine, double spacing) {
  std::vector<DVec3> points = {fine.front()};
  for (const DVec3 x : fine) {
    if (length(x - points.back()) >= spacing)
      points.push_back(points.back() + spacing * normalize(x - points.back()));
  }
  return points;
}

/// A loose overhand knot with its ends along x.
inline RopeDesc overhand(double spacing, double friction) {
  constexpr double kSize = 0.02;  // [m]
  constexpr double kEnd = 2.05;
  const auto place = [](double t) {
    return kSize * DVec3{t * t * t - 3 * t, 0.7 * (t * t * t * t - 4 * t * t),
                         0.55 * (0.2 * t * t * t * t * t - 2 * t)};
  };
  const DVec3 tail = 0.25 * normalize(DVec3{1, 0.3, 0});
  std::vector<DVec3> fine = straight(place(-kEnd) - DVec3{tail.x, -tail.y, 0}, place(-kEnd), 2000);
  for (int i = 1; i < 20000; ++i) fine.push_back(place(-kEnd + 2 * kEnd * i / 20000.0));
  const std::vector<DVec3> behind = straight(place(kEnd), place(kEnd) + tail, 2000);
  fine.insert(fine.end(), behind.begin(), behind.end());
  RopeDesc desc = touching(resampled(fine, spacing), 0.08, friction);
  desc.total_mass = static_cast<Real>(0.08 * spacing * last_of(desc));
  return desc;
}

}  // namespace hooke::test
