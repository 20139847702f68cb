/// Fills a closed surface with the lattice: it decides which cells are filled, moves the outer points onto
/// the surface, and finds where the surface's own vertices lie in it.

#include "geometry/box.h"
#include "geometry/mesh/bvh.h"
#include "geometry/solid/cell_joining.h"
#include "geometry/solid/ray_winding.h"
#include "geometry/solid/tetrahedral_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr std::size_t kMostCells = std::size_t{1} << 22;
constexpr std::uint32_t kFittingSweeps = 3;
constexpr double kLeastVolume = 0.1;  ///< Least volume of a tetrahedron after its points moved, over the one
                                      ///< before.

/// The point where a line along x meets a triangle, and the sign of its winding about the line.
struct RayCrossing {
  double x = 0;
  int sign = 0;
};

/// Fills half cells, by the winding number at their centers.
class Filler {
 public:
  Filler(const MeshDesc& mesh, CellGrid& grid)
      : mesh_(mesh), grid_(grid), rows_(2 * grid.counts[1]), layers_(2 * grid.counts[2]) {}

  void fill() {
    rays_.resize(static_cast<std::size_t>(rows_) * layers_);
    for (const Triangle& t : mesh_.triangles) cross_rays(t);
    std::vector<int> inside(grid_.filled.size(), 0);
    for (int layer = 0; layer < layers_; ++layer) {
      for (int row = 0; row < rows_; ++row) count_ray(row, layer, inside);
    }
    for (std::size_t i = 0; i < inside.size(); ++i) grid_.filled[i] = inside[i] >= 4 ? 1 : 0;
  }

 private:
  [[nodiscard]] double y_of(int row) const { return grid_.corner.y + (row + 0.5) * 0.5 * grid_.cell.y; }
  [[nodiscard]] double z_of(int layer) const { return grid_.corner.z + (layer + 0.5) * 0.5 * grid_.cell.z; }

  /// The half cells whose centers may lie in [least, most].
  static std::array<int, 2> range_of(double least, double most, double corner, double half, int count) {
    const auto at = [&](double p) {
      return static_cast<int>(std::clamp(std::floor((p - corner) / half), -1.0, static_cast<double>(count)));
    };
    return {std::max(at(least) - 1, 0), std::min(at(most) + 1, count - 1)};
  }

  void cross_rays(const Triangle& triangle) {
    std::array<DVec3, 3> t;
    for (int k = 0; k < 3; ++k) t[k] = vector_cast<double>(mesh_.positions[triangle[k]]);
    const Box3<double> box = box_of(t[0], t[1], t[2]);
    const auto rows = range_of(box.lower.y, box.upper.y, grid_.corner.y, 0.5 * grid_.cell.y, rows_);
    const auto layers = range_of(box.lower.z, box.upper.z, grid_.corner.z, 0.5 * grid_.cell.z, layers_);
    for (int layer = layers[0]; layer <= layers[1]; ++layer) {
      for (int row = rows[0]; row <= rows[1]; ++row) {
        const int winding = winding_about(t, y_of(row), z_of(layer));
        if (winding == 0) continue;
        rays_[static_cast<std::size_t>(layer) * rows_ + row].push_back(
            {crossing_of(t, y_of(row), z_of(layer)), winding});
      }
    }
  }

  void count_ray(int row, int layer, std::vector<int>& inside) {
    const auto& ray = rays_[static_cast<std::size_t>(layer) * rows_ + row];
    if (ray.empty()) return;
    for (int i = 0; i < 2 * grid_.counts[0]; ++i) {
      const double x = grid_.corner.x + (i + 0.5) * 0.5 * grid_.cell.x;
      int winding = 0;
      for (const RayCrossing& c : ray) winding += c.x > x ? c.sign : 0;
      if (winding > 0) ++inside[grid_.index(i / 2, row / 2, layer / 2)];
    }
  }

  const MeshDesc& mesh_;
  CellGrid& grid_;
  int rows_, layers_;
  std::vector<std::vector<RayCrossing>> rays_;
};

/// Moves points of the surface to the nearest points of the mesh, or part of that distance.
void fit_surface(const MeshDesc& target, TetrahedralMesh& mesh) {
  const Bvh bvh = build_bvh(target.positions, target.triangles);
  std::vector<std::uint8_t> outer(mesh.points.size(), 0);
  for (const Triangle& t : surface_of(mesh.tetrahedra)) {
    for (const std::uint32_t p : t) outer[p] = 1;
  }
  std::vector<std::vector<std::uint32_t>> around(mesh.points.size());
  std::vector<double> least;
  for (std::uint32_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    const Tetrahedron& t = mesh.tetrahedra[i];
    for (const std::uint32_t p : t) around[p].push_back(i);
    least.push_back(kLeastVolume *
                    volume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]));
  }
  const auto fits = [&](std::uint32_t point) {
    return std::all_of(around[point].begin(), around[point].end(), [&](std::uint32_t i) {
      const Tetrahedron& t = mesh.tetrahedra[i];
      return volume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) >= least[i];
    });
  };
  const auto count = static_cast<std::uint32_t>(mesh.points.size());
  // A point that a neighbor stopped the first time may have room the next time.
  for (std::uint32_t i = 0; i < kFittingSweeps * count; ++i) {
    const std::uint32_t p = i % count;
    if (outer[p] == 0) continue;
    const DVec3 from = mesh.points[p];
    const auto closest = find_closest(bvh, vector_cast<Real>(from));
    if (!closest) continue;
    const DVec3 offset = vector_cast<double>(closest->point) - from;
    for (const double part : {1.0, 0.75, 0.5, 0.25, 0.0}) {
      mesh.points[p] = from + part * offset;
      if (fits(p)) break;
    }
  }
}

Result<CellGrid> grid_around(const MeshDesc& mesh, double cell) {
  Box extent;
  for (const Triangle& t : mesh.triangles)
    extent = merge(extent, box_of(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]));
  CellGrid grid;
  grid.corner = vector_cast<double>(extent.lower);
  const DVec3 size = vector_cast<double>(extent.upper) - grid.corner;
  const double along[3] = {size.x, size.y, size.z};
  double lengths[3] = {};
  double count = 1;
  for (int k = 0; k < 3; ++k) {
    const double cells = std::max(1.0, std::floor(along[k] / cell + 0.5));
    count *= cells;
    if (!(count <= static_cast<double>(kMostCells))) {
      return Error{ErrorCode::kOutOfRange, "cell",
                   "is too small: the mesh would have more than 4194304 cells"};
    }
    grid.counts[k] = static_cast<int>(cells);
    lengths[k] = along[k] / cells;
  }
  grid.cell = {lengths[0], lengths[1], lengths[2]};
  grid.filled.assign(static_cast<std::size_t>(count), 0);
  return grid;
}

/// Cells of a solid, and which of them were added.
struct FilledCells {
  CellGrid grid;
  CellAdditions additions;
};

Result<FilledCells> find_cells(const MeshDesc& mesh, double cell) {
  const Result<void> solid = validate_solid(mesh);
  if (!solid) return solid.error();
  if (!(cell > 0) || !std::isfinite(cell)) {
    return Error{ErrorCode::kOutOfRange, "cell", "must be positive and finite"};
  }
  Result<CellGrid> grid = grid_around(mesh, cell);
  if (!grid) return grid.error();
  FilledCells cells = {.grid = std::move(grid).value(), .additions = {}};
  Filler(mesh, cells.grid).fill();
  cells.additions = join_cells(mesh, cells.grid);
  return cells;
}

}  // namespace

Result<TetrahedralMesh> fill_solid(const MeshDesc& mesh, double cell) {
  const Result<FilledCells> cells = find_cells(mesh, cell);
  if (!cells) return cells.error();
  TetrahedralMesh filled = fill_cells(cells.value().grid);
  if (filled.tetrahedra.empty()) {
    return Error{ErrorCode::kOutOfRange, "cell", "is too large: no cell lies inside the mesh"};
  }
  fit_surface(mesh, filled);
  return filled;
}

Result<CellAdditions> measure_additions(const MeshDesc& mesh, double cell) {
  const Result<FilledCells> cells = find_cells(mesh, cell);
  if (!cells) return cells.error();
  return cells.value().additions;
}

namespace {

std::array<double, 4> weights_at(const TetrahedralMesh& mesh, const Tetrahedron& t, DVec3 p) {
  const auto& x = mesh.points;
  const double whole = volume6(x[t[0]], x[t[1]], x[t[2]], x[t[3]]);
  const double a = volume6(p, x[t[1]], x[t[2]], x[t[3]]) / whole;
  const double b = volume6(x[t[0]], p, x[t[2]], x[t[3]]) / whole;
  const double c = volume6(x[t[0]], x[t[1]], p, x[t[3]]) / whole;
  return {a, b, c, 1.0 - a - b - c};
}

/// Sorts tetrahedra by the cubes that their boxes overlap.
class Buckets {
 public:
  explicit Buckets(const TetrahedralMesh& mesh) : mesh_(mesh) {
    double volume = 0;
    for (const Tetrahedron& t : mesh.tetrahedra)
      volume += volume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
    size_ = std::cbrt(2.0 * volume / static_cast<double>(mesh.tetrahedra.size()));
    if (!(size_ > 0)) size_ = 1;
    // A spike of kilometers in a solid of centimeters would lie in more cubes than memory holds.
    while (count_entries() > kMostCubes * static_cast<double>(mesh.tetrahedra.size())) size_ *= 2;
    for (std::uint32_t i = 0; i < mesh.tetrahedra.size(); ++i) insert(i);
    std::sort(entries_.begin(), entries_.end());
  }

  /// Finds the best of the tetrahedra within `reach` cubes of p. Returns false if there are none.
  bool find_best(DVec3 p, int reach, TetrahedronPlace& best) const {
    const Cube center = cube_of(p);
    std::vector<std::uint32_t> near;
    for (int x = center[0] - reach; x <= center[0] + reach; ++x) {
      for (int y = center[1] - reach; y <= center[1] + reach; ++y) {
        const Entry first = {{x, y, center[2] - reach}, 0};
        const Entry last = {{x, y, center[2] + reach}, kNone};
        for (auto e = std::lower_bound(entries_.begin(), entries_.end(), first);
             e != entries_.end() && *e <= last; ++e)
          near.push_back(e->second);
      }
    }
    std::sort(near.begin(), near.end());
    double least = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : near) take_better(p, i, least, best);
    return !near.empty();
  }

  void take_better(DVec3 p, std::uint32_t i, double& least, TetrahedronPlace& best) const {
    const auto weights = weights_at(mesh_, mesh_.tetrahedra[i], p);
    const double smallest = *std::min_element(weights.begin(), weights.end());
    if (!(smallest > least)) return;
    least = smallest;
    best = {i, weights};
  }

 private:
  using Cube = std::array<int, 3>;
  using Entry = std::pair<Cube, std::uint32_t>;

  static constexpr double kMostCubes = 16;  // per tetrahedron, on average

  [[nodiscard]] Cube cube_of(DVec3 p) const {
    const auto at = [&](double x) { return static_cast<int>(std::clamp(std::floor(x / size_), -1e9, 1e9)); };
    return {at(p.x), at(p.y), at(p.z)};
  }

  /// The first and the last of the cubes that the box around a tetrahedron overlaps.
  [[nodiscard]] std::pair<Cube, Cube> cubes_of(const Tetrahedron& t) const {
    const auto& x = mesh_.points;
    const Box3<double> box = merge(box_of(x[t[0]], x[t[1]], x[t[2]]), box_of(x[t[1]], x[t[2]], x[t[3]]));
    return {cube_of(box.lower), cube_of(box.upper)};
  }

  [[nodiscard]] double count_entries() const {
    double count = 0;
    for (const Tetrahedron& t : mesh_.tetrahedra) {
      const auto [a, b] = cubes_of(t);
      double cubes = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) cubes *= 1.0 + b[axis] - a[axis];
      count += cubes;
    }
    return count;
  }

  void insert(std::uint32_t i) {
    const auto [a, b] = cubes_of(mesh_.tetrahedra[i]);
    for (int i0 = a[0]; i0 <= b[0]; ++i0) {
      for (int i1 = a[1]; i1 <= b[1]; ++i1) {
        for (int i2 = a[2]; i2 <= b[2]; ++i2) entries_.push_back({{i0, i1, i2}, i});
      }
    }
  }

  const TetrahedralMesh& mesh_;
  double size_ = 1;
  std::vector<Entry> entries_;
};

}  // namespace

std::vector<TetrahedronPlace> locate(const TetrahedralMesh& mesh, std::span<const DVec3> places) {
  const Buckets buckets(mesh);
  std::vector<TetrahedronPlace> found;
  for (const DVec3& p : places) {
    TetrahedronPlace& best = found.emplace_back();
    if (buckets.find_best(p, 1, best) || buckets.find_best(p, 3, best)) continue;
    double least = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < mesh.tetrahedra.size(); ++i) buckets.take_better(p, i, least, best);
  }
  return found;
}

}  // namespace hooke::geometry
