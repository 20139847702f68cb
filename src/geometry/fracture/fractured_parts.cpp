#include "geometry/fracture/fractured_parts.h"

#include "hooke/fracture.h"

#include "base/disjoint_sets.h"
#include "geometry/box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr double kInPlane = 1e-8;  ///< In diagonals of the box around the solid.

/// A connected surface: the outside of a part, or the inside of a hollow in one.
struct Shell {
  std::vector<Triangle> triangles;
  Box3<double> box;
  double volume = 0;
};

std::vector<Shell> shells_of(const SolidMesh& solid) {
  base::DisjointSets sets(solid.positions.size());
  for (const auto& [a, b, c] : solid.triangles) {
    sets.merge(a, b);
    sets.merge(a, c);
  }
  std::vector<std::uint32_t> shell_of(solid.positions.size(), kNone);
  std::vector<Shell> shells;
  for (const Triangle& t : solid.triangles) {
    std::uint32_t& shell = shell_of[sets.root(t[0])];
    if (shell == kNone) {
      shell = static_cast<std::uint32_t>(shells.size());
      shells.emplace_back();
    }
    shells[shell].triangles.push_back(t);
    for (const std::uint32_t v : t) shells[shell].box = merge(shells[shell].box, solid.positions[v]);
  }
  for (Shell& shell : shells) shell.volume = six_volumes(solid.positions, shell.triangles) / 6;
  return shells;
}

/// Puts hollows into the smallest part whose box is around theirs.
std::vector<Shell> with_hollows(std::vector<Shell> shells) {
  std::vector<Shell> parts;
  for (Shell& shell : shells) {
    if (shell.volume > 0) parts.push_back(std::move(shell));
  }
  for (const Shell& shell : shells) {
    if (shell.triangles.empty()) continue;  // It was moved to the parts.
    Shell* around = nullptr;
    for (Shell& part : parts) {
      if (contains(part.box, shell.box) && (around == nullptr || part.volume < around->volume))
        around = &part;
    }
    if (around != nullptr)
      around->triangles.insert(around->triangles.end(), shell.triangles.begin(), shell.triangles.end());
  }
  return parts;
}

FracturedPart part_of(const SolidMesh& solid, const Shell& shell, std::uint32_t seed) {
  FracturedPart part = {.seed = seed};
  std::vector<std::uint32_t> renamed(solid.positions.size(), kNone);
  for (Triangle t : shell.triangles) {
    for (std::uint32_t& v : t) {
      if (renamed[v] == kNone) {
        renamed[v] = static_cast<std::uint32_t>(part.points.size());
        part.points.push_back(solid.positions[v]);
      }
      v = renamed[v];
    }
    part.triangles.push_back(t);
  }
  part.across.assign(part.triangles.size(), FractureCell::kSurface);
  return part;
}

/// A triangle of a part that lies in the plane to another seed.
struct CutTriangle {
  std::uint32_t part = 0;
  std::uint32_t triangle = 0;
};

/// Triangles in the planes between two seeds, by (own seed, other seed).
using CutTriangles = std::map<std::array<std::uint32_t, 2>, std::vector<CutTriangle>>;

/// Triangles of a part whose corners lie in the plane.
std::vector<std::uint32_t> triangles_in(const FracturedPart& part, const Plane& plane, double in_plane) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t t = 0; t < part.triangles.size(); ++t) {
    const bool is_in = std::ranges::all_of(part.triangles[t], [&](std::uint32_t v) {
      return std::abs(signed_distance(plane, part.points[v])) <= in_plane;
    });
    if (is_in) found.push_back(t);
  }
  return found;
}

CutTriangles list_cut_triangles(const FracturedParts& found, const VoronoiCells& cells,
                                std::span<const DVec3> seeds, double in_plane) {
  CutTriangles cut;
  for (std::uint32_t p = 0; p < found.parts.size(); ++p) {
    const std::uint32_t seed = found.parts[p].seed;
    for (const std::uint32_t other : cells.cells[seed].neighbors) {
      const Plane plane = bisector_of(seeds, seed, other);
      for (const std::uint32_t t : triangles_in(found.parts[p], plane, in_plane))
        cut[{seed, other}].push_back({p, t});
    }
  }
  return cut;
}

/// How far inside a triangle a place is, as the least of its three barycentric coordinates.
double depth_in(const std::array<DVec3, 3>& t, DVec3 normal, DVec3 place) {
  double least = std::numeric_limits<double>::infinity();
  const double whole = dot(cross(t[1] - t[0], t[2] - t[0]), normal);
  for (std::size_t k = 0; k < 3; ++k) {
    const double part = dot(cross(t[(k + 1) % 3] - t[k], place - t[k]), normal);
    least = std::min(least, part / whole);
  }
  return least;
}

/// The part on the other side of the middle of a triangle; nothing if there is none.
std::optional<std::uint32_t> part_across(const FracturedParts& found, DVec3 middle, DVec3 normal,
                                         const std::vector<CutTriangle>& others) {
  constexpr double kOutside = -1e-6;
  std::optional<std::uint32_t> best;
  double deepest = kOutside;
  for (const CutTriangle& other : others) {
    const FracturedPart& part = found.parts[other.part];
    const auto [a, b, c] = part.triangles[other.triangle];
    const double depth = depth_in({part.points[a], part.points[b], part.points[c]}, -normal, middle);
    if (!(depth > deepest)) continue;
    deepest = depth;
    best = other.part;
  }
  return best;
}

/// Finds what is across each triangle in a plane between two seeds, and lists the faces.
void join_parts(const CutTriangles& cut, std::span<const DVec3> seeds, FracturedParts& found) {
  std::map<std::array<std::uint32_t, 2>, std::vector<Triangle>> faces;
  for (const auto& [pair, triangles] : cut) {
    const auto others = cut.find({pair[1], pair[0]});
    if (others == cut.end()) continue;
    const DVec3 normal = bisector_of(seeds, pair[0], pair[1]).normal;
    for (const CutTriangle& own : triangles) {
      FracturedPart& part = found.parts[own.part];
      const auto [a, b, c] = part.triangles[own.triangle];
      const DVec3 middle = 1.0 / 3 * (part.points[a] + part.points[b] + part.points[c]);
      const auto across = part_across(found, middle, normal, others->second);
      if (!across) continue;
      part.across[own.triangle] = *across;
      if (own.part < *across) faces[{own.part, *across}].push_back(part.triangles[own.triangle]);
    }
  }
  for (auto& [pair, triangles] : faces) found.faces.push_back({pair[0], pair[1], std::move(triangles)});
}

}  // namespace

FracturedParts find_parts(const VoronoiCells& cells, std::span<const DVec3> seeds, double diagonal) {
  FracturedParts found;
  for (std::uint32_t seed = 0; seed < cells.cells.size(); ++seed) {
    for (const Shell& shell : with_hollows(shells_of(cells.cells[seed].solid)))
      found.parts.push_back(part_of(cells.cells[seed].solid, shell, seed));
  }
  join_parts(list_cut_triangles(found, cells, seeds, kInPlane * diagonal), seeds, found);
  return found;
}

DVec3 center_of(std::span<const DVec3> points, std::span<const Triangle> triangles) {
  if (triangles.empty()) return {};
  const DVec3 apex = points[triangles[0][0]];
  double volume = 0;
  DVec3 first = {};
  for (const auto& [a, b, c] : triangles) {
    const DVec3 u = points[a] - apex;
    const DVec3 v = points[b] - apex;
    const DVec3 w = points[c] - apex;
    const double d = dot(u, cross(v, w));
    volume += d;
    first += d / 4 * (u + v + w);
  }
  return std::abs(volume) > 0 ? apex + 1 / volume * first : apex;
}

}  // namespace hooke::geometry
