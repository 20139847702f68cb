#include "geometry/solid/tetrahedral_mesh.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace hooke::geometry {

namespace {

/// Numbers points when they are first used, and makes tetrahedra of positive volume.
class CellFiller {
 public:
  explicit CellFiller(const CellGrid& grid) : grid_(grid) {}

  TetrahedralMesh fill() {
    number_points();
    for (int z = 0; z < grid_.counts[2]; ++z) {
      for (int y = 0; y < grid_.counts[1]; ++y) {
        for (int x = 0; x < grid_.counts[0]; ++x) {
          if (is_filled({x, y, z})) fill_cell({x, y, z});
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  using Cell = std::array<int, 3>;

  [[nodiscard]] bool is_filled(const Cell& c) const {
    for (int k = 0; k < 3; ++k) {
      if (c[k] < 0 || c[k] >= grid_.counts[k]) return false;
    }
    return grid_.filled[grid_.index(c[0], c[1], c[2])] != 0;
  }

  [[nodiscard]] std::size_t corner_index(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * (grid_.counts[1] + 1) + c[1]) * (grid_.counts[0] + 1) + c[0];
  }

  [[nodiscard]] DVec3 place(double x, double y, double z) const {
    return grid_.corner + DVec3{x * grid_.cell.x, y * grid_.cell.y, z * grid_.cell.z};
  }

  [[nodiscard]] bool touches_filled(const Cell& corner) const {
    for (int i = 0; i < 8; ++i) {
      if (is_filled({corner[0] - (i & 1), corner[1] - (i >> 1 & 1), corner[2] - (i >> 2)})) return true;
    }
    return false;
  }

  void number_points() {
    const auto& n = grid_.counts;
    point_of_corner_.assign(static_cast<std::size_t>(n[0] + 1) * (n[1] + 1) * (n[2] + 1), kNone);
    point_of_cell_.assign(grid_.filled.size(), kNone);
    const auto next = [&] { return static_cast<std::uint32_t>(mesh_.points.size()); };
    for (int z = 0; z <= n[2]; ++z) {
      for (int y = 0; y <= n[1]; ++y) {
        for (int x = 0; x <= n[0]; ++x) {
          if (!touches_filled({x, y, z})) continue;
          point_of_corner_[corner_index({x, y, z})] = next();
          mesh_.points.push_back(place(x, y, z));
        }
      }
    }
    for (std::size_t i = 0; i < grid_.filled.size(); ++i) {
      if (grid_.filled[i] == 0) continue;
      const auto x = static_cast<int>(i % n[0]), y = static_cast<int>(i / n[0] % n[1]);
      const auto z = static_cast<int>(i / n[0] / n[1]);
      point_of_cell_[i] = next();
      mesh_.points.push_back(place(x + 0.5, y + 0.5, z + 0.5));
    }
  }

  void add(Tetrahedron t) {
    const auto& p = mesh_.points;
    if (volume6(p[t[0]], p[t[1]], p[t[2]], p[t[3]]) < 0) std::swap(t[2], t[3]);
    mesh_.tetrahedra.push_back(t);
  }

  /// Makes the tetrahedra at the six faces of a cell; those between two cells belong to the first.
  void fill_cell(const Cell& cell) {
    const std::uint32_t center = point_of_cell_[grid_.index(cell[0], cell[1], cell[2])];
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        Cell beside = cell;
        beside[axis] += side == 0 ? -1 : 1;
        const bool has_neighbor = is_filled(beside);
        if (has_neighbor && side == 0) continue;
        Cell corner = cell;
        corner[axis] += side;
        std::array<std::uint32_t, 4> face = {};  // corners around the face
        for (int k = 0; k < 4; ++k) {
          Cell c = corner;
          c[(axis + 1) % 3] += k == 1 || k == 2 ? 1 : 0;
          c[(axis + 2) % 3] += k >= 2 ? 1 : 0;
          face[k] = point_of_corner_[corner_index(c)];
        }
        if (has_neighbor) {
          const std::uint32_t other = point_of_cell_[grid_.index(beside[0], beside[1], beside[2])];
          for (int k = 0; k < 4; ++k) add({center, other, face[k], face[(k + 1) % 4]});
        } else {
          const int parity = (corner[0] + corner[1] + corner[2]) & 1;
          add({center, face[parity], face[parity + 1], face[parity + 2]});
          add({center, face[parity], face[parity + 2], face[(parity + 3) % 4]});
        }
      }
    }
  }

  const CellGrid& grid_;
  TetrahedralMesh mesh_;
  std::vector<std::uint32_t> point_of_corner_;
  std::vector<std::uint32_t> point_of_cell_;
};

}  // namespace

TetrahedralMesh fill_cells(const CellGrid& grid) {
  return CellFiller(grid).fill();
}

std::vector<Triangle> surface_of(std::span<const Tetrahedron> tetrahedra) {
  // Seen from outside, the corner that is left out lies behind.
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  struct Face {
    Triangle sorted = {}, triangle = {};
    std::size_t order = 0;
  };
  std::vector<Face> faces;
  for (const Tetrahedron& t : tetrahedra) {
    for (const auto& f : kFaces) {
      Face face = {.triangle = {t[f[0]], t[f[1]], t[f[2]]}, .order = faces.size()};
      face.sorted = face.triangle;
      std::sort(face.sorted.begin(), face.sorted.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return a.sorted != b.sorted ? a.sorted < b.sorted : a.order < b.order;
  });
  std::vector<Face> lone;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i;
    while (end < faces.size() && faces[end].sorted == faces[i].sorted) ++end;
    if (end == i + 1) lone.push_back(faces[i]);
    i = end;
  }
  std::sort(lone.begin(), lone.end(), [](const Face& a, const Face& b) { return a.order < b.order; });
  std::vector<Triangle> surface;
  surface.reserve(lone.size());
  for (const Face& face : lone) surface.push_back(face.triangle);
  return surface;
}

}  // namespace hooke::geometry
