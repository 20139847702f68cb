#include "validation/crossings.h"

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

/// All lines and all edges of triangles, each once.
std::vector<std::array<std::uint32_t, 2>> edges_of(const Surfaces& surfaces) {
  std::vector<std::array<std::uint32_t, 2>> edges = surfaces.lines;
  for (const auto& [a, b, c] : surfaces.triangles) {
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      edges.push_back({std::min(p, q), std::max(p, q)});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// The ends of two lines.
using Ends = std::array<DVec3, 4>;

double volume_of(const Ends& x) {
  return dot(x[1] - x[0], cross(x[3] - x[2], x[2] - x[0]));
}

/// Distance of two lines: the least of those of an end and a line, and of the lines across both.
double distance_of(const Ends& x) {
  const auto to_line = [](DVec3 p, DVec3 a, DVec3 b) {
    const DVec3 u = b - a;
    const double share = std::clamp(dot(p - a, u) / std::max(dot(u, u), 1e-300), 0.0, 1.0);
    return length(p - a - share * u);
  };
  double least = std::min({to_line(x[0], x[2], x[3]), to_line(x[1], x[2], x[3]), to_line(x[2], x[0], x[1]),
                           to_line(x[3], x[0], x[1])});
  const DVec3 u = x[1] - x[0];
  const DVec3 v = x[3] - x[2];
  const DVec3 n = cross(u, v);
  const double nn = dot(n, n);
  if (!(nn > 0)) return least;
  const double s = dot(cross(x[2] - x[0], v), n) / nn;
  const double t = dot(cross(x[2] - x[0], u), n) / nn;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
    least = std::min(least, std::abs(dot(x[2] - x[0], n)) / std::sqrt(nn));
  return least;
}

/// Whether two lines meet while their ends go straight from `from` to `to`. The volume of their ends is a
/// cubic in time, which is divided until its Bernstein coefficients have one sign or the time is known.
bool pass(const Ends& from, const Ends& to) {
  struct Piece {
    double begin, end;
    std::array<double, 4> coefficient;
  };
  const auto at = [&](double time) {
    Ends x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = (1 - time) * from[k] + time * to[k];
    return x;
  };
  double farthest = 0;
  for (std::size_t k = 0; k < 4; ++k) farthest = std::max(farthest, length(to[k] - from[k]));
  const double f0 = volume_of(at(0));
  const double f1 = volume_of(at(1.0 / 3));
  const double f2 = volume_of(at(2.0 / 3));
  const double f3 = volume_of(at(1));
  std::vector<Piece> open = {
      {0, 1, {f0, (-5 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 6, (2 * f0 - 9 * f1 + 18 * f2 - 5 * f3) / 6, f3}}};
  while (!open.empty()) {
    const Piece piece = open.back();
    open.pop_back();
    const auto [least, most] = std::minmax_element(piece.coefficient.begin(), piece.coefficient.end());
    if (*least > 0 || *most < 0) continue;
    const double middle = 0.5 * (piece.begin + piece.end);
    const double distance = distance_of(at(middle));
    // Lines that stay in one plane have the volume 0 all the time; how far they go tells whether they may
    // meet.
    if (distance > (piece.end - piece.begin) * farthest + 1e-8) continue;
    if (piece.end - piece.begin < 1e-9) {
      if (distance < 1e-8) return true;
      continue;
    }
    const auto& [a, b, c, d] = piece.coefficient;
    const double ab = 0.5 * (a + b);
    const double bc = 0.5 * (b + c);
    const double cd = 0.5 * (c + d);
    const double abc = 0.5 * (ab + bc);
    const double bcd = 0.5 * (bc + cd);
    const double half = 0.5 * (abc + bcd);
    open.push_back({piece.begin, middle, {a, ab, abc, half}});
    open.push_back({middle, piece.end, {half, bcd, cd, d}});
  }
  return false;
}

/// Where the ends of two edges are.
Ends ends_of(const Surfaces& s, const std::array<std::uint32_t, 2>& one,
             const std::array<std::uint32_t, 2>& other) {
  return {s.points[one[0]], s.points[one[1]], s.points[other[0]], s.points[other[1]]};
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
  const std::vector<std::array<std::uint32_t, 2>> edges = edges_of(surfaces);
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

std::size_t count_passes(const Surfaces& before, const Surfaces& after) {
  const std::vector<std::array<std::uint32_t, 2>> edges = edges_of(before);
  std::vector<Bounds> bounds;
  bounds.reserve(edges.size());
  for (const auto& [p, q] : edges)
    bounds.push_back(bounds_of({before.points[p], before.points[q], after.points[p], after.points[q]}));
  const auto is_line = [&](const std::array<std::uint32_t, 2>& edge) {
    return std::find(before.lines.begin(), before.lines.end(), edge) != before.lines.end();
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!is_line(edges[i])) continue;
    const auto [a, b] = edges[i];
    for (std::size_t j = 0; j < edges.size(); ++j) {
      const auto [c, d] = edges[j];
      if (are_apart(bounds[i], bounds[j]) || a == c || a == d || b == c || b == d) continue;
      if (!before.owners.empty() && before.owners[a] == before.owners[c]) continue;
      if (j < i && is_line(edges[j])) continue;  // It was looked at as the first one.
      if (pass(ends_of(before, edges[i], edges[j]), ends_of(after, edges[i], edges[j]))) ++count;
    }
  }
  return count;
}

}  // namespace hooke
