#include "geometry/fracture/voronoi.h"

#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr double kOnPlane = 1e-12;   ///< In diagonals of the box around the solid.
constexpr double kSamePlace = 1e-9;  ///< Distance of seeds that count as one, likewise.
constexpr double kRoomAround =
    0.01;  ///< By which the box that is divided is larger than the solid, likewise.

/// A box around the solid, about its origin, larger by some room.
ConvexCell box_around(const FractureSolid& solid) {
  const double room = kRoomAround * solid.diagonal;
  const DVec3 half = solid.half_extents + DVec3{room, room, room};
  ConvexCell box;
  for (std::uint32_t i = 0; i < 8; ++i) {
    box.points.push_back({(i & 1u) != 0 ? half.x : -half.x, (i & 2u) != 0 ? half.y : -half.y,
                          (i & 4u) != 0 ? half.z : -half.z});
  }
  box.loop = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
  for (std::uint32_t face = 0; face < 6; ++face) box.faces.push_back({4 * face, 4, ConvexCell::kUncut});
  return box;
}

/// Divides one solid.
class Divider {
 public:
  Divider(const FractureSolid& solid, std::span<const DVec3> seeds)
      : solid_(solid), seeds_(seeds), is_used_(seeds.size(), 1) {
    whole_ = solid.is_convex ? cell_of(solid.mesh, solid.origin) : box_around(solid);
    if (solid.is_convex) return;
    surface_ = solid_mesh_of(solid.mesh);
    for (DVec3& p : surface_.positions) p -= solid.origin;
  }

  Result<VoronoiCells> run(double least) {
    VoronoiCells cells;
    cells.cells.resize(seeds_.size());
    drop_same_places();
    std::vector<std::uint32_t> to_make;
    for (std::uint32_t i = 0; i < seeds_.size(); ++i) {
      if (is_used_[i] != 0) to_make.push_back(i);
    }
    while (!to_make.empty()) {
      for (const std::uint32_t seed : to_make) {
        if (const Result<void> made = make(seed, cells.cells[seed]); !made) return made.error();
      }
      to_make = drop_small(least, cells.cells);
    }
    for (std::uint32_t i = 0; i < seeds_.size(); ++i) cells.merged += is_used_[i] != 0 ? 0 : 1;
    return cells;
  }

 private:
  /// Gives up all but the first of seeds at one place.
  void drop_same_places() {
    const double same = kSamePlace * solid_.diagonal;
    std::vector<std::uint32_t> order(seeds_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tie(seeds_[a].x, a) < std::tie(seeds_[b].x, b);
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t k = i + 1; k < order.size(); ++k) {
        if (seeds_[order[k]].x - seeds_[order[i]].x > same) break;
        if (length(seeds_[order[k]] - seeds_[order[i]]) > same) continue;
        is_used_[std::max(order[i], order[k])] = 0;
      }
    }
  }

  /// Cuts the cell of a seed out of the solid, by the planes to other seeds, the nearest first.
  Result<void> make(std::uint32_t seed, VoronoiCell& cell) {
    by_distance_.clear();
    for (std::uint32_t i = 0; i < seeds_.size(); ++i) {
      if (i != seed && is_used_[i] != 0) by_distance_.push_back({length(seeds_[i] - seeds_[seed]), i});
    }
    std::sort(by_distance_.begin(), by_distance_.end());
    cell.polyhedron = whole_;
    double reach = reach_of(cell.polyhedron, seeds_[seed]);
    for (const auto& [distance, other] : by_distance_) {
      if (0.5 * distance > reach) break;
      const Plane plane = bisector_of(seeds_, seed, other);
      if (!cut_cell(plane, kOnPlane * solid_.diagonal, other, scratch_, cell.polyhedron)) continue;
      if (cell.polyhedron.faces.empty()) break;
      reach = reach_of(cell.polyhedron, seeds_[seed]);
    }
    cell.neighbors.clear();
    for (const ConvexCell::Face& face : cell.polyhedron.faces) {
      if (face.cut != ConvexCell::kUncut) cell.neighbors.push_back(face.cut);
    }
    std::sort(cell.neighbors.begin(), cell.neighbors.end());
    cell.neighbors.erase(std::unique(cell.neighbors.begin(), cell.neighbors.end()), cell.neighbors.end());
    return measure(seed, cell);
  }

  [[nodiscard]] static double reach_of(const ConvexCell& cell, DVec3 seed) {
    double reach = 0;
    for (const DVec3& p : cell.points) reach = std::max(reach, length_squared(p - seed));
    return std::sqrt(reach);
  }

  Result<void> measure(std::uint32_t seed, VoronoiCell& cell) {
    const std::vector<Triangle> triangles = triangles_of(cell.polyhedron);
    cell.volume = six_volumes(cell.polyhedron.points, triangles) / 6;
    if (solid_.is_convex || triangles.empty()) return {};
    const SolidMesh around = {.positions = cell.polyhedron.points, .triangles = triangles};
    Result<SolidMesh> inside = combine_solids(surface_, around, SolidOperation::kIntersection);
    if (!inside) {
      return Error{inside.error().code, "mesh",
                   "the cell of seed " + std::to_string(seed) + " cannot be cut out (" +
                       inside.error().message + "); another `seed` may do"};
    }
    cell.solid = std::move(inside).value();
    cell.volume = six_volumes(cell.solid.positions, cell.solid.triangles) / 6;
    return {};
  }

  /// Gives up small cells, the smallest first, but none beside one that was given up before it: what comes
  /// to that one may make it large enough. Returns the seeds whose cells change.
  std::vector<std::uint32_t> drop_small(double least, std::vector<VoronoiCell>& cells) {
    std::vector<std::uint32_t> small;
    std::size_t used = 0;
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
      if (is_used_[i] == 0) continue;
      ++used;
      if (!(cells[i].volume >= least) || !(cells[i].volume > 0)) small.push_back(i);
    }
    std::sort(small.begin(), small.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tie(cells[a].volume, a) < std::tie(cells[b].volume, b);
    });
    std::vector<std::uint8_t> changes(cells.size(), 0);
    for (const std::uint32_t i : small) {
      if (changes[i] != 0 || used == 1) continue;
      is_used_[i] = 0;
      --used;
      for (const std::uint32_t k : cells[i].neighbors) changes[k] = is_used_[k];
      cells[i] = {};
    }
    std::vector<std::uint32_t> again;
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
      if (changes[i] != 0 && is_used_[i] != 0) again.push_back(i);
    }
    return again;
  }

  const FractureSolid& solid_;
  std::span<const DVec3> seeds_;
  std::vector<std::uint8_t> is_used_;
  ConvexCell whole_;
  SolidMesh surface_;
  CellCutScratch scratch_;
  std::vector<std::pair<double, std::uint32_t>> by_distance_;
};

}  // namespace

Plane bisector_of(std::span<const DVec3> seeds, std::uint32_t from, std::uint32_t to) {
  const DVec3 a = seeds[std::min(from, to)];
  const DVec3 b = seeds[std::max(from, to)];
  const DVec3 normal = normalize(b - a);
  const double offset = dot(normal, 0.5 * (a + b));
  return from < to ? Plane{normal, offset} : Plane{-normal, -offset};
}

Result<VoronoiCells> divide(const FractureSolid& solid, std::span<const DVec3> seeds, double least) {
  return Divider(solid, seeds).run(least);
}

double six_volumes(std::span<const DVec3> points, std::span<const Triangle> triangles) {
  double sum = 0;
  if (triangles.empty()) return sum;
  const DVec3 apex = points[triangles[0][0]];
  for (const auto& [a, b, c] : triangles)
    sum += dot(points[a] - apex, cross(points[b] - apex, points[c] - apex));
  return sum;
}

std::vector<Triangle> triangles_of(const ConvexCell& cell) {
  std::vector<Triangle> triangles;
  for (const ConvexCell::Face& face : cell.faces) append_triangles(cell, face, triangles);
  return triangles;
}

}  // namespace hooke::geometry
