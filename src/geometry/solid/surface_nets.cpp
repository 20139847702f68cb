#include "geometry/solid/surface_nets.h"

#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <cmath>

namespace hooke::geometry {

namespace {

// Crossings keep this part of an edge from its ends, so that no two vertices of the net coincide.
constexpr double kLeastPart = 0.05;

/// Finds the squares and cubes of a grid whose inner nodes touch only at corners, and fills one more node of
/// each.
class WellComposer {
 public:
  WellComposer(NodeGrid& grid, double value_inside) : grid_(grid), value_inside_(value_inside) {
    const std::size_t row = grid.counts[0];
    step_ = {1, row, row * grid.counts[1]};
  }

  void run() {
    while (sweep()) {
    }
  }

 private:
  [[nodiscard]] bool is_inside(std::size_t node) const { return grid_.value[node] < 0; }

  bool sweep() {
    bool changed = false;
    for (int z = 0; z + 1 < grid_.counts[2]; ++z) {
      for (int y = 0; y + 1 < grid_.counts[1]; ++y) {
        for (int x = 0; x + 1 < grid_.counts[0]; ++x) changed = mend_cube(grid_.index(x, y, z)) || changed;
      }
    }
    return changed;
  }

  bool mend_cube(std::size_t node) {
    int inner = 0;
    for (std::size_t k = 0; k < 8; ++k) inner += is_inside(corner(node, k)) ? 1 : 0;
    if (inner < 2 || inner > 6) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = step_[(axis + 1) % 3];
      const std::size_t v = step_[(axis + 2) % 3];
      for (const std::size_t first : {node, node + step_[axis]}) {
        if (mend_square({first, first + u, first + u + v, first + v})) return true;
      }
    }
    return (inner == 2 || inner == 6) && mend_opposite(node, inner == 2);
  }

  [[nodiscard]] std::size_t corner(std::size_t node, std::size_t k) const {
    return node + (k & 1) * step_[0] + (k >> 1 & 1) * step_[1] + (k >> 2) * step_[2];
  }

  bool mend_square(const std::array<std::size_t, 4>& around) {
    for (std::size_t k = 0; k < 2; ++k) {
      const bool is_diagonal = is_inside(around[k]) && is_inside(around[k + 2]) &&
                               !is_inside(around[k + 1]) && !is_inside(around[(k + 3) % 4]);
      if (is_diagonal) return fill_nearer(around[k + 1], around[(k + 3) % 4]);
    }
    return false;
  }

  /// Mends a cube of which two opposite corners, and no others, are inside, or outside.
  bool mend_opposite(std::size_t node, bool are_inside) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t a = corner(node, k);
      const std::size_t b = corner(node, 7 - k);
      if (is_inside(a) != are_inside || is_inside(b) != are_inside) continue;
      return are_inside ? fill_nearer(corner(node, k ^ 1U), corner(node, k ^ 2U)) : fill_nearer(a, b);
    }
    return false;
  }

  /// Fills the one of two outer nodes that is less far outside.
  bool fill_nearer(std::size_t a, std::size_t b) {
    grid_.value[grid_.value[b] < grid_.value[a] ? b : a] = value_inside_;
    return true;
  }

  NodeGrid& grid_;
  double value_inside_;
  std::array<std::size_t, 3> step_ = {};
};

/// Makes the vertices of a net, and then its squares.
class NetMaker {
 public:
  explicit NetMaker(const NodeGrid& grid) : grid_(grid), vertex_of_(grid.value.size(), kNone) {}

  MeshDesc make() {
    for (int z = 0; z + 1 < grid_.counts[2]; ++z) {
      for (int y = 0; y + 1 < grid_.counts[1]; ++y) {
        for (int x = 0; x + 1 < grid_.counts[0]; ++x) add_vertex({x, y, z});
      }
    }
    for (int z = 1; z + 1 < grid_.counts[2]; ++z) {
      for (int y = 1; y + 1 < grid_.counts[1]; ++y) {
        for (int x = 1; x + 1 < grid_.counts[0]; ++x) add_squares({x, y, z});
      }
    }
    return std::move(mesh_);
  }

 private:
  using Node = std::array<int, 3>;

  [[nodiscard]] double value(const Node& n) const { return grid_.value[grid_.index(n[0], n[1], n[2])]; }

  static Node moved(Node n, std::size_t axis, int by) {
    n[axis] += by;
    return n;
  }

  void add_vertex(const Node& node) {
    DVec3 sum;
    int count = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      for (int k = 0; k < 4; ++k) {
        const Node from = moved(moved(node, u, k & 1), v, k >> 1);
        const double a = value(from);
        const double b = value(moved(from, axis, 1));
        if ((a < 0) == (b < 0)) continue;
        const double part = std::clamp(a / (a - b), kLeastPart, 1 - kLeastPart);
        DVec3 place = {static_cast<double>(from[0]), static_cast<double>(from[1]),
                       static_cast<double>(from[2])};
        (axis == 0 ? place.x : axis == 1 ? place.y : place.z) += part;
        sum += place;
        ++count;
      }
    }
    if (count == 0) return;
    vertex_of_[grid_.index(node[0], node[1], node[2])] = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(
        vector_cast<Real>(grid_.corner + grid_.spacing / static_cast<double>(count) * sum));
  }

  /// Makes the square about each crossed edge that starts at the node, its outside outside.
  void add_squares(const Node& node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_inside = value(node) < 0;
      if (is_inside == (value(moved(node, axis, 1)) < 0)) continue;
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      std::array<std::uint32_t, 4> around = {};
      const int offsets[4][2] = {{-1, -1}, {0, -1}, {0, 0}, {-1, 0}};
      for (std::size_t k = 0; k < 4; ++k) {
        const Node cube = moved(moved(node, u, offsets[k][0]), v, offsets[k][1]);
        around[k] = vertex_of_[grid_.index(cube[0], cube[1], cube[2])];
      }
      if (!is_inside) std::swap(around[1], around[3]);
      add_square(around);
    }
  }

  /// Divides a square along its shorter diagonal.
  void add_square(const std::array<std::uint32_t, 4>& q) {
    const auto& x = mesh_.positions;
    const bool first_is_short = !(length_squared(x[q[3]] - x[q[1]]) < length_squared(x[q[2]] - x[q[0]]));
    if (first_is_short) {
      mesh_.triangles.push_back({q[0], q[1], q[2]});
      mesh_.triangles.push_back({q[0], q[2], q[3]});
    } else {
      mesh_.triangles.push_back({q[0], q[1], q[3]});
      mesh_.triangles.push_back({q[1], q[2], q[3]});
    }
  }

  const NodeGrid& grid_;
  MeshDesc mesh_;
  std::vector<std::uint32_t> vertex_of_;  // By the first node of the cube.
};

}  // namespace

void make_well_composed(NodeGrid& grid, double value_inside) {
  WellComposer(grid, value_inside).run();
}

MeshDesc make_surface_net(const NodeGrid& grid) {
  return NetMaker(grid).make();
}

}  // namespace hooke::geometry
