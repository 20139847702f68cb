#include "world/crossings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace hooke {

namespace {

/// A sum of doubles that do not overlap, in ascending order of magnitude (Shewchuk 1997).
using Expansion = std::vector<double>;

/// Sets `sum` to the rounded sum and returns its error, which is exact.
double add_exactly(double a, double b, double& sum) {
  sum = a + b;
  const double part = sum - a;
  return (a - (sum - part)) + (b - part);
}

/// Sets `product` to the rounded product and returns its error, which is exact.
double multiply_exactly(double a, double b, double& product) {
  product = a * b;
  return std::fma(a, b, -product);
}

Expansion plus(Expansion e, double b) {
  for (double& part : e) {
    double sum = 0;
    const double error = add_exactly(b, part, sum);
    part = error;
    b = sum;
  }
  e.push_back(b);
  return e;
}

Expansion plus(Expansion e, const Expansion& f) {
  for (const double part : f) e = plus(std::move(e), part);
  std::erase(e, 0.0);
  return e;
}

Expansion times(const Expansion& e, const Expansion& f) {
  Expansion result;
  for (const double a : e) {
    for (const double b : f) {
      double product = 0;
      const double error = multiply_exactly(a, b, product);
      result = plus(plus(std::move(result), error), product);
    }
  }
  std::erase(result, 0.0);
  return result;
}

Expansion minus(const Expansion& e, Expansion f) {
  for (double& part : f) part = -part;
  return plus(e, f);
}

Expansion offset(double a, double b) {
  return plus(Expansion{a}, -b);
}

int sign(double x) {
  return (x > 0) - (x < 0);
}

int orientation_by_expansions(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const auto row = [&](DVec3 p) { return std::array{offset(p.x, d.x), offset(p.y, d.y), offset(p.z, d.z)}; };
  const auto [ax, ay, az] = row(a);
  const auto [bx, by, bz] = row(b);
  const auto [cx, cy, cz] = row(c);
  const auto minor = [](const Expansion& p, const Expansion& q, const Expansion& r, const Expansion& s) {
    return minus(times(p, s), times(q, r));
  };
  const Expansion volume = plus(plus(times(ax, minor(by, bz, cy, cz)), times(ay, minor(bz, bx, cz, cx))),
                                times(az, minor(bx, by, cx, cy)));
  return volume.empty() ? 0 : sign(volume.back());
}

struct Bounds {
  DVec3 lower, upper;
};

Bounds bounds_of(std::initializer_list<DVec3> points) {
  Bounds box = {*points.begin(), *points.begin()};
  for (const DVec3 p : points) {
    box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y), std::min(box.lower.z, p.z)};
    box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y), std::max(box.upper.z, p.z)};
  }
  return box;
}

bool are_apart(const Bounds& a, const Bounds& b) {
  return a.lower.x > b.upper.x || b.lower.x > a.upper.x || a.lower.y > b.upper.y || b.lower.y > a.upper.y ||
         a.lower.z > b.upper.z || b.lower.z > a.upper.z;
}

using Cell = std::array<long, 3>;

/// Calls `visit` with each cell of a grid that the box touches.
template <class Visit>
void for_cells(const Bounds& box, double size, Visit visit) {
  const auto cell = [size](double x) { return static_cast<long>(std::floor(x / size)); };
  for (long x = cell(box.lower.x); x <= cell(box.upper.x); ++x) {
    for (long y = cell(box.lower.y); y <= cell(box.upper.y); ++y) {
      for (long z = cell(box.lower.z); z <= cell(box.upper.z); ++z) visit(Cell{x, y, z});
    }
  }
}

void count_pair(const Surfaces& s, std::array<std::uint32_t, 2> edge, std::array<std::uint32_t, 3> triangle,
                Crossings& found) {
  for (const std::uint32_t p : triangle) {
    if (p == edge[0] || p == edge[1]) return;
  }
  const DVec3 p = s.points[edge[0]];
  const DVec3 q = s.points[edge[1]];
  const DVec3 a = s.points[triangle[0]];
  const DVec3 b = s.points[triangle[1]];
  const DVec3 c = s.points[triangle[2]];
  if (are_apart(bounds_of({p, q}), bounds_of({a, b, c}))) return;
  const int side_p = exact_orientation(a, b, c, p);
  const int side_q = exact_orientation(a, b, c, q);
  if (side_p == 0 && side_q == 0) {
    ++found.coplanar;
    return;
  }
  if (side_p == side_q) return;
  const std::array around = {exact_orientation(p, q, a, b), exact_orientation(p, q, b, c),
                             exact_orientation(p, q, c, a)};
  const auto [least, most] = std::minmax_element(around.begin(), around.end());
  if (*least < 0 && *most > 0) return;
  ++(side_p == 0 || side_q == 0 ? found.touching : found.crossing);
}

}  // namespace

int exact_orientation(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const DVec3 u = a - d;
  const DVec3 v = b - d;
  const DVec3 w = c - d;
  const double volume = dot(u, cross(v, w));
  const auto size = [](DVec3 p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z); };
  if (std::abs(volume) > 1e-13 * size(u) * size(v) * size(w)) return sign(volume);
  return orientation_by_expansions(a, b, c, d);
}

Crossings count_crossings(const Surfaces& surfaces) {
  std::vector<std::array<std::uint32_t, 2>> edges = surfaces.lines;
  for (const auto& [a, b, c] : surfaces.triangles) {
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      edges.push_back({std::min(p, q), std::max(p, q)});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  double mean = 0;
  for (const auto& [p, q] : edges) mean += length(surfaces.points[p] - surfaces.points[q]);
  Crossings found;
  if (edges.empty() || surfaces.triangles.empty()) return found;
  const double size = std::max(1.5 * mean / static_cast<double>(edges.size()), 1e-9);

  std::map<Cell, std::vector<std::uint32_t>> grid;
  for (std::uint32_t i = 0; i < surfaces.triangles.size(); ++i) {
    const auto& [a, b, c] = surfaces.triangles[i];
    for_cells(bounds_of({surfaces.points[a], surfaces.points[b], surfaces.points[c]}), size,
              [&](Cell cell) { grid[cell].push_back(i); });
  }
  std::vector<std::uint32_t> near;
  for (const auto& edge : edges) {
    near.clear();
    for_cells(bounds_of({surfaces.points[edge[0]], surfaces.points[edge[1]]}), size, [&](Cell cell) {
      if (const auto at = grid.find(cell); at != grid.end())
        near.insert(near.end(), at->second.begin(), at->second.end());
    });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::uint32_t triangle : near) count_pair(surfaces, edge, surfaces.triangles[triangle], found);
  }
  return found;
}

}  // namespace hooke
