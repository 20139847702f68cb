#include "base/disjoint_sets.h"
#include "geometry/mesh/mesh_clean.h"
#include "math/trig.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hooke::geometry {

namespace {

/// Above this number of closed surfaces each is evaluated alone, because the search for nested ones takes the
/// square of it.
constexpr std::ptrdiff_t kMaxNested = 2048;

/// One side of a triangle, named by its ends in ascending order.
struct Border {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::uint32_t triangle = 0;
  bool ascending = false;  ///< The triangle runs from `low` to `high`.
};

struct Surface {
  std::vector<std::uint32_t> triangles = {};
  bool is_closed = true;
  double volume = 0.0;
  DVec3 low = {};
  DVec3 high = {};
};

std::vector<Border> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Border> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles[t][i];
      const std::uint32_t to = triangles[t][(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Border& a, const Border& b) {
    if (a.low != b.low) return a.low < b.low;
    return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
  });
  return sides;
}

/// Calls `visit` with the sides of each edge.
template <class Visit>
void for_edges(std::span<const Border> sides, const Visit& visit) {
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t last = first + 1;
    while (last < sides.size() && sides[last].low == sides[first].low &&
           sides[last].high == sides[first].high) {
      ++last;
    }
    visit(sides.subspan(first, last - first));
    first = last;
  }
}

/// For each triangle, the number of its surface: triangles that share an edge share a surface.
std::vector<std::uint32_t> find_surfaces(std::span<const Border> sides, std::size_t triangle_count) {
  base::DisjointSets sets(triangle_count);
  for_edges(sides, [&](std::span<const Border> edge) {
    for (const Border& side : edge) sets.merge(edge[0].triangle, side.triangle);
  });
  std::vector<std::uint32_t> surface_of(triangle_count);
  std::uint32_t count = 0;
  for (std::uint32_t t = 0; t < triangle_count; ++t) {
    const std::uint32_t root = sets.root(t);
    surface_of[t] = root == t ? count++ : surface_of[root];  // a root comes before its members
  }
  return surface_of;
}

/// The neighbors of a triangle across edges with two sides.
struct Neighbors {
  struct Link {
    std::uint32_t to = 0;
    bool must_differ = false;  ///< Exactly one of the two must be turned for them to agree.
  };
  std::array<Link, 3> links = {};
  std::size_t count = 0;
};

std::vector<Neighbors> find_neighbors(std::span<const Border> sides, std::size_t triangle_count) {
  std::vector<Neighbors> neighbors(triangle_count);
  for_edges(sides, [&](std::span<const Border> edge) {
    if (edge.size() != 2) return;
    const bool differ = edge[0].ascending == edge[1].ascending;
    Neighbors& a = neighbors[edge[0].triangle];
    Neighbors& b = neighbors[edge[1].triangle];
    a.links[a.count++] = {edge[1].triangle, differ};
    b.links[b.count++] = {edge[0].triangle, differ};
  });
  return neighbors;
}

/// Turns triangles over so that neighbors agree with each other, as far as edges with two sides lead from
/// `start`. It turns the smaller number of them; of equal numbers not that with `start`.
void agree_from(std::uint32_t start, std::span<const Neighbors> neighbors, std::vector<std::uint8_t>& is_seen,
                std::vector<std::uint8_t>& flipped) {
  std::vector<std::uint32_t> reached = {start};
  std::size_t flipped_count = 0;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::uint32_t t = reached[next];
    flipped_count += flipped[t];
    for (std::size_t i = 0; i < neighbors[t].count; ++i) {
      const Neighbors::Link link = neighbors[t].links[i];
      if (std::exchange(is_seen[link.to], std::uint8_t{1}) != 0) continue;
      flipped[link.to] = flipped[t] ^ static_cast<std::uint8_t>(link.must_differ);
      reached.push_back(link.to);
    }
  }
  if (2 * flipped_count <= reached.size()) return;
  for (const std::uint32_t t : reached) flipped[t] ^= 1u;
}

/// Makes each surface agree with the majority of its triangles.
void make_consistent(std::span<const Border> sides, std::vector<std::uint8_t>& flipped) {
  const std::vector<Neighbors> neighbors = find_neighbors(sides, flipped.size());
  std::vector<std::uint8_t> is_seen(flipped.size(), 0);
  for (std::uint32_t start = 0; start < flipped.size(); ++start) {
    if (std::exchange(is_seen[start], std::uint8_t{1}) == 0) agree_from(start, neighbors, is_seen, flipped);
  }
}

/// Whether as many sides run along the edge as against it.
bool is_balanced(std::span<const Border> edge, std::span<const std::uint8_t> flipped) {
  std::ptrdiff_t sum = 0;
  for (const Border& side : edge) sum += side.ascending != (flipped[side.triangle] != 0) ? 1 : -1;
  return sum == 0;
}

std::vector<Surface> describe_surfaces(std::span<const DVec3> points, std::span<const Triangle> triangles,
                                       std::span<const Border> sides, std::span<const std::uint8_t> flipped) {
  const std::vector<std::uint32_t> surface_of = find_surfaces(sides, triangles.size());
  const std::uint32_t count =
      surface_of.empty() ? 0 : *std::max_element(surface_of.begin(), surface_of.end()) + 1;
  std::vector<Surface> surfaces(count);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    Surface& surface = surfaces[surface_of[t]];
    const DVec3 origin = points[triangles[t][0]];
    if (surface.triangles.empty()) surface.low = surface.high = origin;
    const DVec3 reference = points[triangles[surface.triangles.empty() ? t : surface.triangles[0]][0]];
    const DVec3 b = points[triangles[t][1]];
    const DVec3 c = points[triangles[t][2]];
    const double volume = dot(origin - reference, cross(b - reference, c - reference)) / 6;
    surface.volume += flipped[t] != 0 ? -volume : volume;
    for (const DVec3 p : {origin, b, c}) {
      surface.low = {std::min(surface.low.x, p.x), std::min(surface.low.y, p.y),
                     std::min(surface.low.z, p.z)};
      surface.high = {std::max(surface.high.x, p.x), std::max(surface.high.y, p.y),
                      std::max(surface.high.z, p.z)};
    }
    surface.triangles.push_back(t);
  }
  for_edges(sides, [&](std::span<const Border> edge) {
    if (!is_balanced(edge, flipped)) surfaces[surface_of[edge[0].triangle]].is_closed = false;
  });
  return surfaces;
}

/// How often the surface winds around `p`: the sum of signed solid angles over 4 pi (Van Oosterom and
/// Strackee, 1983). About +-1 inside a closed surface, about 0 outside.
double reverses(std::span<const DVec3> points, std::span<const Triangle> triangles, const Surface& surface,
                DVec3 p) {
  double sum = 0.0;
  for (const std::uint32_t t : surface.triangles) {
    const DVec3 a = points[triangles[t][0]] - p;
    const DVec3 b = points[triangles[t][1]] - p;
    const DVec3 c = points[triangles[t][2]] - p;
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    sum +=
        2 * math::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

bool box_contains(const Surface& outer, const Surface& inner) {
  const auto within = [](double low, double value, double high) { return low < value && value < high; };
  return within(outer.low.x, inner.low.x, outer.high.x) && within(outer.low.x, inner.high.x, outer.high.x) &&
         within(outer.low.y, inner.low.y, outer.high.y) && within(outer.low.y, inner.high.y, outer.high.y) &&
         within(outer.low.z, inner.low.z, outer.high.z) && within(outer.low.z, inner.high.z, outer.high.z);
}

/// The volume of the outermost closed surface around surface `s`, or its own.
double outermost_volume(std::span<const DVec3> points, std::span<const Triangle> triangles,
                        std::span<const Surface> surfaces, std::size_t s) {
  const Surface* outermost = &surfaces[s];
  const DVec3 p = points[triangles[surfaces[s].triangles[0]][0]];
  for (const Surface& other : surfaces) {
    if (!other.is_closed || !box_contains(other, surfaces[s])) continue;
    if (outermost != &surfaces[s] && !box_contains(other, *outermost)) continue;
    if (std::abs(reverses(points, triangles, other, p)) > 0.5) outermost = &other;
  }
  return outermost->volume;
}

}  // namespace

std::vector<std::uint8_t> find_flipped(std::span<const DVec3> points, std::span<const Triangle> triangles) {
  const std::vector<Border> sides = sorted_sides(triangles);
  std::vector<std::uint8_t> agreed(triangles.size(), 0);
  const std::vector<Surface> given = describe_surfaces(points, triangles, sides, agreed);
  make_consistent(sides, agreed);
  const std::vector<Surface> repaired = describe_surfaces(points, triangles, sides, agreed);
  const auto closed_count =
      std::count_if(given.begin(), given.end(), [](const Surface& surface) { return surface.is_closed; });

  std::vector<std::uint8_t> flipped(triangles.size(), 0);
  for (std::size_t s = 0; s < given.size(); ++s) {
    double volume = 0.0;  // volume of a surface with a border: it has none
    if (given[s].is_closed) {
      volume = closed_count > kMaxNested ? given[s].volume : outermost_volume(points, triangles, given, s);
    } else {
      volume = repaired[s].is_closed ? repaired[s].volume : 0.0;
      for (const std::uint32_t t : given[s].triangles) flipped[t] = agreed[t];
    }
    if (volume >= 0) continue;
    for (const std::uint32_t t : given[s].triangles) flipped[t] ^= 1u;
  }
  return flipped;
}

}  // namespace hooke::geometry
