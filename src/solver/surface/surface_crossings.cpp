#include "solver/surface/surface_crossings.h"

#include "base/disjoint_sets.h"
#include "geometry/box.h"
#include "geometry/orientation.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace hooke::solver {

namespace {

using CrossingBox = geometry::Box3<double>;

CrossingBox with(const CrossingBox& box, DVec3 p) {
  return geometry::merge(box, p);
}

/// The boxes of the cells and nodes of a surface where it is now.
struct MeshBoxes {
  std::vector<CrossingBox> cells;
  std::vector<CrossingBox> nodes;

  MeshBoxes(const SurfaceMesh& mesh, std::span<const DVec3> position) {
    cells.reserve(mesh.cells.size());
    for (const SurfaceCell& cell : mesh.cells) {
      CrossingBox box;
      for (std::uint32_t i = cell.first_triangle; i < cell.end_triangle; ++i) {
        for (const std::uint32_t vertex : mesh.triangles[i].vertex) box = with(box, position[vertex]);
      }
      for (std::uint32_t i = cell.first_edge; i < cell.end_edge; ++i) {
        for (const std::uint32_t vertex : mesh.edges[i].vertex) box = with(box, position[vertex]);
      }
      cells.push_back(box);
    }
    nodes.resize(mesh.nodes.size());
    for (std::size_t i = mesh.nodes.size(); i-- > 0;) {
      for (const std::uint32_t child : mesh.nodes[i].child) {
        if (child != SurfaceNode::kNone) nodes[i] = geometry::merge(nodes[i], at(child));
      }
    }
  }

  /// The box of a child of a node.
  [[nodiscard]] const CrossingBox& at(std::uint32_t child) const {
    return (child & SurfaceNode::kCell) != 0 ? cells[child & ~SurfaceNode::kCell] : nodes[child];
  }
};

/// Walks over the trees of two surfaces and tests what lies together.
class CrossingFinder {
 public:
  CrossingFinder(const SurfaceMeshes& surfaces, std::span<const DVec3> position, double reserve,
                 std::vector<SurfaceCrossing>& found)
      : surfaces_(surfaces), position_(position), reserve_(reserve), found_(found) {}

  void run(std::uint32_t first, std::uint32_t second) {
    first_ = &surfaces_.meshes[first];
    second_ = &surfaces_.meshes[second];
    if (first_->nodes.empty() || second_->nodes.empty()) return;
    const MeshBoxes boxes(*first_, position_);
    if (first == second) return walk(boxes, 0, boxes, 0);
    const MeshBoxes others(*second_, position_);
    walk(boxes, 0, others, 0);
  }

 private:
  void walk(const MeshBoxes& a, std::uint32_t i, const MeshBoxes& b, std::uint32_t j) {
    if (!overlap(a.at(i), b.at(j))) return;
    const bool i_is_cell = (i & SurfaceNode::kCell) != 0;
    const bool j_is_cell = (j & SurfaceNode::kCell) != 0;
    if (i_is_cell && j_is_cell) {
      const SurfaceCell& cell = first_->cells[i & ~SurfaceNode::kCell];
      const SurfaceCell& other = second_->cells[j & ~SurfaceNode::kCell];
      test(*first_, cell, *second_, other, true);
      // A surface with itself meets each pair of its cells twice, in either order.
      if (first_ != second_) test(*second_, other, *first_, cell, false);
      return;
    }
    const bool down_first = !i_is_cell && (j_is_cell || i <= j);
    for (const std::uint32_t child : (down_first ? first_->nodes[i] : second_->nodes[j]).child) {
      if (child == SurfaceNode::kNone) continue;
      down_first ? walk(a, child, b, j) : walk(a, i, b, child);
    }
  }

  void test(const SurfaceMesh& edges, const SurfaceCell& edge_cell, const SurfaceMesh& triangles,
            const SurfaceCell& triangle_cell, bool edge_is_first) {
    for (std::uint32_t i = edge_cell.first_edge; i < edge_cell.end_edge; ++i) {
      for (std::uint32_t j = triangle_cell.first_triangle; j < triangle_cell.end_triangle; ++j)
        test(edges.edges[i].vertex, triangles, triangles.triangles[j], edge_is_first);
    }
  }

  [[nodiscard]] bool share_a_vertex(const std::array<std::uint32_t, 2>& end,
                                    const std::array<std::uint32_t, 3>& corner) const {
    for (const std::uint32_t a : end) {
      for (const std::uint32_t b : corner) {
        if (a == b || surfaces_.joined[a] == surfaces_.joined[b]) return true;
      }
    }
    return false;
  }

  /// On which side of the edge from corner a to corner b the line from p to q passes. A line that meets it is
  /// put to the side on which the triangle beyond the edge puts it, so that one of the two has it.
  [[nodiscard]] int side(DVec3 p, DVec3 q, std::uint32_t a, std::uint32_t b) const {
    const int sign = geometry::orientation(p, q, position_[std::min(a, b)], position_[std::max(a, b)]);
    return (sign < 0) == (a < b) ? -1 : 1;
  }

  /// Whether a line from p to q that passes a triangle within rounding of its edge k only grazes it there:
  /// beyond the edge is nothing that it goes through.
  [[nodiscard]] bool grazes_edge(DVec3 p, DVec3 q, const SurfaceMesh& mesh, const SurfaceTriangle& triangle,
                                 std::size_t k) const {
    const SurfaceEdge& edge = mesh.edges[triangle.edge[k]];
    const std::uint32_t own = triangle.vertex[(k + 2) % 3];
    const std::uint32_t other = edge.opposite[0] == own ? edge.opposite[1] : edge.opposite[0];
    if (other == SurfaceEdge::kNone) return true;
    const DVec3 start = position_[edge.vertex[0]];
    const DVec3 face = cross(position_[edge.vertex[1]] - start, position_[other] - start);
    const double size = length(face);
    const double of_p = dot(face, p - start);
    const double of_q = dot(face, q - start);
    return !(std::min(std::abs(of_p), std::abs(of_q)) > reserve_ * size) || (of_p > 0) == (of_q > 0);
  }

  /// The same where it passes a corner: seen along the line, what begins at the corner lies on one side of
  /// it.
  [[nodiscard]] bool grazes_corner(DVec3 along, const SurfaceMesh& mesh, std::uint32_t corner) const {
    const std::span<const std::uint32_t> neighbors = mesh.neighbors_of(corner);
    const auto from_corner = [&](std::uint32_t vertex) { return position_[vertex] - position_[corner]; };
    const double least = -reserve_ * length(along);
    return std::any_of(neighbors.begin(), neighbors.end(), [&](std::uint32_t first) {
      const DVec3 a = from_corner(first);
      return std::all_of(neighbors.begin(), neighbors.end(), [&](std::uint32_t second) {
        const DVec3 b = from_corner(second);
        return dot(along, cross(a, b)) >= least * (length(a) + length(b));
      });
    });
  }

  /// An edge that goes through a triangle.
  struct Piercing {
    DVec3 p, q;                       ///< Ends of the edge.
    std::array<double, 3> part = {};  ///< By corner, its weight at the place times `whole`.
    double whole = 0;
    DVec3 face;       ///< Normal of the triangle, twice as long as its area.
    double size = 0;  ///< That length.
  };

  /// The side of the triangle on which the first end of an edge is that goes through it, 0 if it does not.
  [[nodiscard]] int side_of_first(const std::array<std::uint32_t, 2>& end,
                                  const std::array<std::uint32_t, 3>& corner) const {
    const DVec3 p = position_[end[0]];
    const DVec3 q = position_[end[1]];
    const DVec3 a = position_[corner[0]];
    const DVec3 b = position_[corner[1]];
    const DVec3 c = position_[corner[2]];
    const int before = geometry::orientation(a, b, c, p);
    if (before == 0 || share_a_vertex(end, corner) || geometry::orientation(a, b, c, q) != -before) return 0;
    const int turn = side(p, q, corner[0], corner[1]);
    const bool goes_through =
        side(p, q, corner[1], corner[2]) == turn && side(p, q, corner[2], corner[0]) == turn;
    return goes_through ? before : 0;
  }

  [[nodiscard]] Piercing piercing_of(const std::array<std::uint32_t, 2>& end,
                                     const std::array<std::uint32_t, 3>& corner) const {
    Piercing at = {.p = position_[end[0]], .q = position_[end[1]], .face = {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const DVec3 u = position_[corner[(k + 1) % 3]] - at.p;
      const DVec3 v = position_[corner[(k + 2) % 3]] - at.p;
      at.part[k] = std::abs(dot(at.q - at.p, cross(u, v)));
    }
    at.whole = at.part[0] + at.part[1] + at.part[2];
    at.face = cross(position_[corner[1]] - position_[corner[0]], position_[corner[2]] - position_[corner[0]]);
    at.size = length(at.face);
    return at;
  }

  /// Whether it is so near to the border of one of the two that it only grazes.
  [[nodiscard]] bool grazes(const Piercing& at, const SurfaceMesh& mesh,
                            const SurfaceTriangle& triangle) const {
    const std::array<std::uint32_t, 3>& corner = triangle.vertex;
    const auto depth = [&](DVec3 x) { return std::abs(dot(at.face, x - position_[corner[0]])) / at.size; };
    if (!(std::min(depth(at.p), depth(at.q)) > reserve_)) return true;
    for (std::size_t k = 0; k < 3; ++k) {
      // Heights of the place over edge k, and its distance from corner k.
      const double width = length(position_[corner[(k + 1) % 3]] - position_[corner[k]]);
      const double from_edge = at.part[(k + 2) % 3] / at.whole * at.size / width;
      if (!(from_edge > reserve_) && grazes_edge(at.p, at.q, mesh, triangle, k)) return true;
      const double longest = std::max(width, length(position_[corner[(k + 2) % 3]] - position_[corner[k]]));
      const bool is_near = !((1 - at.part[k] / at.whole) * longest > reserve_);
      if (is_near && grazes_corner(at.q - at.p, mesh, corner[k])) return true;
    }
    return false;
  }

  void test(const std::array<std::uint32_t, 2>& end, const SurfaceMesh& mesh, const SurfaceTriangle& triangle,
            bool edge_is_first) {
    const std::array<std::uint32_t, 3>& corner = triangle.vertex;
    const int before = side_of_first(end, corner);
    if (before == 0) return;
    const Piercing at = piercing_of(end, corner);
    if (!(at.whole > 0) || !(at.size > 0) || grazes(at, mesh, triangle)) return;
    const std::array<double, 3>& part = at.part;
    const DVec3 along = at.q - at.p;
    SurfaceCrossing crossing = {.end = end,
                                .corner = corner,
                                .weight = {part[0] / at.whole, part[1] / at.whole, part[2] / at.whole},
                                .place = {},
                                .normal = (1 / at.size) * at.face,
                                .along = 0,
                                .front_end = static_cast<std::uint8_t>(before > 0 ? 0 : 1),
                                .edge_is_first = edge_is_first};
    for (std::size_t k = 0; k < 3; ++k) crossing.place += crossing.weight[k] * position_[corner[k]];
    crossing.along = dot(crossing.place - at.p, along) / dot(along, along);
    found_.push_back(crossing);
  }

  const SurfaceMeshes& surfaces_;
  std::span<const DVec3> position_;
  double reserve_;
  std::vector<SurfaceCrossing>& found_;
  const SurfaceMesh* first_ = nullptr;
  const SurfaceMesh* second_ = nullptr;
};

/// An edge whose ends lie on different sides of the other surface.
struct CutEdge {
  std::uint32_t lower = 0, higher = 0;  ///< Its vertices, in ascending order.
  std::uint32_t behind =
      0;  ///< That of them which lies behind the other surface, by the crossing next to it.

  friend bool operator<(const CutEdge& a, const CutEdge& b) {
    return std::pair(a.lower, a.higher) < std::pair(b.lower, b.higher);
  }
};

/// Lists the edges of one of the surfaces that go through the other one an odd number of times, sorted.
std::vector<CutEdge> cut_edges(std::span<const SurfaceCrossing> crossings, bool of_first) {
  std::vector<const SurfaceCrossing*> own;
  for (const SurfaceCrossing& crossing : crossings) {
    if (crossing.edge_is_first == of_first) own.push_back(&crossing);
  }
  // Crossings of one edge are next to each other then, in order along it.
  std::stable_sort(own.begin(), own.end(), [](const SurfaceCrossing* a, const SurfaceCrossing* b) {
    return std::tuple(a->end, a->along) < std::tuple(b->end, b->along);
  });
  std::vector<CutEdge> cut;
  for (std::size_t i = 0; i < own.size();) {
    std::size_t next = i + 1;
    while (next < own.size() && own[next]->end == own[i]->end) ++next;
    const auto [lower, higher] = std::minmax(own[i]->end[0], own[i]->end[1]);
    if ((next - i) % 2 == 1) cut.push_back({lower, higher, own[i]->end[own[i]->front_end == 0 ? 1 : 0]});
    i = next;
  }
  std::sort(cut.begin(), cut.end());
  return cut;
}

/// Lists the vertices of a surface that have come through another one, or through itself.
void list_passed_of(const SurfaceMesh& mesh, std::span<const SurfaceCrossing> crossings, bool of_first,
                    bool other_is_solid, std::vector<std::uint32_t>& passed) {
  passed.clear();
  const std::vector<CutEdge> cut = cut_edges(crossings, of_first);
  if (cut.empty()) return;
  base::DisjointSets sets(mesh.vertex_count);
  for (const SurfaceEdge& edge : mesh.edges) {
    const auto [a, b] = std::minmax(edge.vertex[0], edge.vertex[1]);
    if (!std::binary_search(cut.begin(), cut.end(), CutEdge{a, b, 0}))
      sets.merge(a - mesh.first_vertex, b - mesh.first_vertex);
  }
  std::vector<std::uint32_t> size(mesh.vertex_count, 0);
  for (std::uint32_t i = 0; i < mesh.vertex_count; ++i) ++size[sets.root(i)];
  std::vector<std::uint8_t> goes_back(mesh.vertex_count, 0);
  if (other_is_solid) {
    for (const CutEdge& edge : cut) goes_back[sets.root(edge.behind - mesh.first_vertex)] = 1;
  } else {
    const auto largest = std::max_element(size.begin(), size.end()) - size.begin();
    goes_back.assign(mesh.vertex_count, 1);
    goes_back[static_cast<std::size_t>(largest)] = 0;
  }
  for (std::uint32_t i = 0; i < mesh.vertex_count; ++i) {
    if (goes_back[sets.root(i)] != 0) passed.push_back(mesh.first_vertex + i);
  }
  if (passed.size() == mesh.vertex_count) passed.clear();
}

}  // namespace

void find_crossings(const SurfaceMeshes& surfaces, std::uint32_t first, std::uint32_t second,
                    std::span<const DVec3> position, double reserve, std::vector<SurfaceCrossing>& found) {
  found.clear();
  CrossingFinder(surfaces, position, reserve, found).run(first, second);
}

void list_passed(const state::Tables& tables, const SurfaceMeshes& surfaces, std::uint32_t first,
                 std::uint32_t second, std::span<const SurfaceCrossing> crossings,
                 std::vector<std::uint32_t>& passed) {
  const SurfaceMesh& mesh = surfaces.meshes[first];
  if (first == second) return list_passed_of(mesh, crossings, true, false, passed);
  const SurfaceMesh& other = surfaces.meshes[second];
  const bool is_solid = tables.objects[mesh.object].kind == PointRef::Kind::kSolid;
  const bool other_is_solid = tables.objects[other.object].kind == PointRef::Kind::kSolid;
  std::vector<std::uint32_t> of_other;
  passed.clear();
  if (other_is_solid || !is_solid) list_passed_of(mesh, crossings, true, other_is_solid, passed);
  if (is_solid || !other_is_solid) list_passed_of(other, crossings, false, is_solid, of_other);
  if (passed.empty() || (!of_other.empty() && of_other.size() < passed.size())) passed = of_other;
}

}  // namespace hooke::solver
