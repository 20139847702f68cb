#include "solver/surface/surface_mesh.h"

#include "base/assert.h"
#include "base/disjoint_sets.h"
#include "base/lists_by_key.h"
#include "geometry/triangle_mesh.h"
#include "solver/surface/surface_tree.h"
#include "state/surface_triangles.h"

#include <algorithm>
#include <utility>

namespace hooke::solver {

namespace {

using geometry::kNone;
using geometry::MeshTopology;
using geometry::Triangle;

/// Pairs triangles that share an edge.
class Pairing {
 public:
  Pairing(std::span<const Triangle> triangles, const MeshTopology& topology, std::span<const Vec3> rest)
      : triangles_(triangles), topology_(topology), rest_(rest), taken_(triangles.size(), 0) {}

  /// Returns pairs, and single triangles with kNone. First come pairs across the longest edge of both, then
  /// each triangle takes the neighbor that has the fewest free neighbors.
  std::vector<std::array<std::uint32_t, 2>> make() {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
      taken_[a] = 1;
      if (b != kNone) taken_[b] = 1;
      pairs.push_back({a, b});
    };
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (taken_[i] != 0) continue;
      const std::size_t k = longest_edge(i);
      const std::uint32_t other = other_side(i, k);
      if (other != kNone &&
          topology_.triangle_edges[other][longest_edge(other)] == topology_.triangle_edges[i][k])
        join(i, other);
    }
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (taken_[i] == 0) join(i, most_lonely_neighbor(i));
    }
    return pairs;
  }

 private:
  [[nodiscard]] std::size_t longest_edge(std::uint32_t triangle) const {
    std::size_t longest = 0;
    Real most = Real(-1);
    for (std::size_t k = 0; k < 3; ++k) {
      const Real squared =
          length_squared(rest_[triangles_[triangle][(k + 1) % 3]] - rest_[triangles_[triangle][k]]);
      if (squared > most) longest = k;
      most = std::max(most, squared);
    }
    return longest;
  }

  /// The free triangle across an edge, or kNone.
  [[nodiscard]] std::uint32_t other_side(std::uint32_t triangle, std::size_t k) const {
    const geometry::EdgeSides& sides = topology_.edge_sides[topology_.triangle_edges[triangle][k]];
    const std::uint32_t other = sides.triangles[0] == triangle ? sides.triangles[1] : sides.triangles[0];
    return other != kNone && taken_[other] == 0 ? other : kNone;
  }

  [[nodiscard]] std::uint32_t most_lonely_neighbor(std::uint32_t triangle) const {
    std::uint32_t best = kNone;
    int fewest = 4;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = other_side(triangle, k);
      if (other == kNone || other == triangle) continue;
      int count = 0;
      for (std::size_t side = 0; side < 3; ++side) count += other_side(other, side) != kNone ? 1 : 0;
      if (count >= fewest) continue;
      best = other;
      fewest = count;
    }
    return best;
  }

  std::span<const Triangle> triangles_;
  const MeshTopology& topology_;
  std::span<const Vec3> rest_;
  std::vector<std::uint8_t> taken_;
};

/// Makes one surface out of triangles whose corners count from 0.
class MeshBuilder {
 public:
  /// `rest` holds the position of each vertex at rest.
  MeshBuilder(std::span<const Triangle> triangles, std::span<const Vec3> rest)
      : triangles_(triangles),
        topology_(geometry::compute_topology(rest.size(), triangles)),
        pairs_(Pairing(triangles, topology_, rest).make()),
        cell_of_(triangles.size()),
        rest_(rest),
        vertex_count_(static_cast<std::uint32_t>(rest.size())) {
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
      for (const std::uint32_t triangle : pairs_[i]) {
        if (triangle != kNone) cell_of_[triangle] = i;
      }
    }
  }

  void build(SurfaceMesh& mesh) {
    mesh.vertex_count = vertex_count_;
    add_features(mesh);
    add_neighbors(mesh);
    std::vector<Vec3> centers;
    for (const SurfaceCell& cell : mesh.cells) {
      const auto& [a, b, c] = mesh.triangles[cell.first_triangle].vertex;
      centers.push_back(rest_[a - mesh.first_vertex] + rest_[b - mesh.first_vertex] +
                        rest_[c - mesh.first_vertex]);
    }
    mesh.nodes = build_surface_tree(centers);
  }

 private:
  /// Gives each of `count` parts to the cell of its triangles that has the fewest so far.
  template <class TrianglesAt>
  base::ListsByKey<std::uint32_t> share_out(std::size_t count, TrianglesAt triangles_at) {
    std::vector<std::uint32_t> cell_of_part(count, kNone);
    std::vector<std::uint32_t> owned(pairs_.size(), 0);
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint32_t best = kNone;
      for (const std::uint32_t triangle : triangles_at(i)) {
        const std::uint32_t cell = triangle == kNone ? kNone : cell_of_[triangle];
        if (cell == kNone) continue;
        if (best == kNone || owned[cell] < owned[best]) best = cell;
      }
      cell_of_part[i] = best;
      if (best != kNone) ++owned[best];
    }
    base::ListsByKey<std::uint32_t> parts;
    parts.fill(pairs_.size(), [&](auto visit) {
      for (std::uint32_t i = 0; i < count; ++i) {
        if (cell_of_part[i] != kNone) visit(cell_of_part[i], i);
      }
    });
    return parts;
  }

  void add_features(SurfaceMesh& mesh) {
    const auto vertices =
        share_out(vertex_count_, [&](std::uint32_t vertex) { return topology_.triangles_at(vertex); });
    const auto edges = share_out(topology_.edges.size(), [&](std::uint32_t edge) {
      return std::span<const std::uint32_t>(topology_.edge_sides[edge].triangles);
    });
    std::vector<std::uint32_t> edge_row(topology_.edges.size(), 0);
    const auto size = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
    for (std::uint32_t cell = 0; cell < pairs_.size(); ++cell) {
      SurfaceCell rows = {size(mesh.vertices), 0, size(mesh.edges), 0, size(mesh.triangles), 0};
      for (const std::uint32_t vertex : vertices.of(cell))
        mesh.vertices.push_back(mesh.first_vertex + vertex);
      for (const std::uint32_t edge : edges.of(cell)) {
        edge_row[edge] = size(mesh.edges);
        mesh.edges.push_back(edge_at(edge, mesh.first_vertex));
      }
      for (const std::uint32_t triangle : pairs_[cell]) {
        if (triangle != kNone) mesh.triangles.push_back(triangle_at(triangle, mesh.first_vertex));
      }
      rows.end_vertex = size(mesh.vertices);
      rows.end_edge = size(mesh.edges);
      rows.end_triangle = size(mesh.triangles);
      mesh.cells.push_back(rows);
    }
    for (SurfaceTriangle& triangle : mesh.triangles) {
      for (std::uint32_t& edge : triangle.edge) edge = edge_row[edge];
    }
    give_vertices_to_edges(mesh);
  }

  /// Lets the first edge of each vertex speak for it.
  void give_vertices_to_edges(SurfaceMesh& mesh) const {
    std::vector<std::uint8_t> taken(vertex_count_, 0);
    for (SurfaceEdge& edge : mesh.edges) {
      for (std::size_t k = 0; k < 2; ++k) {
        std::uint8_t& is_taken = taken[edge.vertex[k] - mesh.first_vertex];
        if (is_taken == 0) edge.owns_vertex |= static_cast<std::uint8_t>(1U << k);
        is_taken = 1;
      }
    }
  }

  [[nodiscard]] SurfaceEdge edge_at(std::uint32_t edge, std::uint32_t first) const {
    SurfaceEdge result;
    for (std::size_t k = 0; k < 2; ++k) {
      result.vertex[k] = first + topology_.edges[edge][k];
      const std::uint32_t opposite = topology_.edge_sides[edge].opposite[k];
      result.opposite[k] = opposite == kNone ? SurfaceEdge::kNone : first + opposite;
    }
    return result;
  }

  [[nodiscard]] SurfaceTriangle triangle_at(std::uint32_t triangle, std::uint32_t first) const {
    SurfaceTriangle result;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = triangles_[triangle][k];
      result.vertex[k] = first + vertex;
      result.edge[k] = topology_.triangle_edges[triangle][k];
      const auto bit = static_cast<std::uint8_t>(1U << k);
      if (topology_.edge_sides[result.edge[k]].triangles[0] == triangle) result.owns_edge |= bit;
      if (topology_.triangles_at(vertex).front() == triangle) result.owns_vertex |= bit;
    }
    return result;
  }

  void add_neighbors(SurfaceMesh& mesh) const {
    base::ListsByKey<std::uint32_t> lists;
    lists.fill(vertex_count_, [&](auto visit) {
      for (const auto& [a, b] : topology_.edges) {
        visit(a, mesh.first_vertex + b);
        visit(b, mesh.first_vertex + a);
      }
    });
    mesh.neighbor_begin.reserve(vertex_count_ + std::size_t{1});
    mesh.neighbors.reserve(2 * topology_.edges.size());
    for (std::uint32_t vertex = 0; vertex < vertex_count_; ++vertex) {
      mesh.neighbor_begin.push_back(static_cast<std::uint32_t>(mesh.neighbors.size()));
      const std::span<const std::uint32_t> list = lists.of(vertex);
      mesh.neighbors.insert(mesh.neighbors.end(), list.begin(), list.end());
    }
    mesh.neighbor_begin.push_back(static_cast<std::uint32_t>(mesh.neighbors.size()));
  }

  std::span<const Triangle> triangles_;
  MeshTopology topology_;
  std::vector<std::array<std::uint32_t, 2>> pairs_;
  std::vector<std::uint32_t> cell_of_;  ///< By triangle.
  std::span<const Vec3> rest_;
  std::uint32_t vertex_count_;
};

/// Puts cells into the order in which the tree is walked, so that those that are looked at one after the
/// other are near each other in memory.
void order_cells(SurfaceMesh& mesh) {
  std::vector<SurfaceCell> ordered;
  ordered.reserve(mesh.cells.size());
  std::vector<std::uint32_t> stack = {0};
  while (!stack.empty()) {
    SurfaceNode& node = mesh.nodes[stack.back()];
    stack.pop_back();
    for (std::uint32_t& child : node.child) {
      if (child == SurfaceNode::kNone || (child & SurfaceNode::kCell) == 0) continue;
      ordered.push_back(mesh.cells[child & ~SurfaceNode::kCell]);
      child = SurfaceNode::kCell | static_cast<std::uint32_t>(ordered.size() - 1);
    }
    for (std::size_t lane = 4; lane-- > 0;) {
      if ((node.child[lane] & SurfaceNode::kCell) == 0) stack.push_back(node.child[lane]);
    }
  }
  mesh.cells = std::move(ordered);
}

/// Divides cells into parts.
void make_parts(SurfaceMesh& mesh) {
  for (SurfaceCell& cell : mesh.cells) {
    cell.first_part = static_cast<std::uint32_t>(mesh.parts.size());
    std::uint32_t vertex = cell.first_vertex;
    std::uint32_t edge = cell.first_edge;
    std::uint32_t triangle = cell.first_triangle;
    const auto take = [](std::uint32_t most, std::uint32_t& first, std::uint32_t end) {
      const std::uint32_t count = std::min(most, end - first);
      first += count;
      return static_cast<std::uint8_t>(count);
    };
    while (vertex < cell.end_vertex || edge < cell.end_edge || triangle < cell.end_triangle) {
      SurfacePart part = {.first_vertex = vertex, .first_edge = edge, .first_triangle = triangle};
      part.vertices = take(4, vertex, cell.end_vertex);
      part.edges = take(4, edge, cell.end_edge);
      part.triangles = take(2, triangle, cell.end_triangle);
      mesh.parts.push_back(part);
    }
    cell.end_part = static_cast<std::uint32_t>(mesh.parts.size());
  }
}

/// Writes to each part the vertices of its features, and the numbers of those that hooks join. Lanes without
/// a feature hold some vertex.
void fill_parts(std::span<const std::uint32_t> joined, SurfaceMesh& mesh) {
  for (SurfacePart& part : mesh.parts) {
    part.vertex.fill(mesh.first_vertex);
    for (auto& ends : part.edge) ends.fill(mesh.first_vertex);
    for (auto& corners : part.triangle) corners.fill(mesh.first_vertex);
    for (std::uint32_t i = 0; i < part.vertices; ++i) part.vertex[i] = mesh.vertices[part.first_vertex + i];
    for (std::uint32_t i = 0; i < part.edges; ++i) {
      for (std::size_t k = 0; k < 2; ++k) part.edge[k][i] = mesh.edges[part.first_edge + i].vertex[k];
    }
    for (std::uint32_t i = 0; i < part.triangles; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        part.triangle[k][i] = part.triangle[k][i + 2] = mesh.triangles[part.first_triangle + i].vertex[k];
      }
    }
    const auto number = [&](std::uint32_t vertex) { return joined[vertex]; };
    const auto set = [&](const std::array<std::uint32_t, 4>& from, std::array<std::uint32_t, 4>& to) {
      std::transform(from.begin(), from.end(), to.begin(), number);
    };
    set(part.vertex, part.joined_vertex);
    for (std::size_t k = 0; k < 2; ++k) set(part.edge[k], part.joined_edge[k]);
    for (std::size_t k = 0; k < 3; ++k) set(part.triangle[k], part.joined_triangle[k]);
  }
}

/// Appends the segments of a rope. Each of them speaks for its first point, the last one for both.
void append_rope(const state::Tables& t, std::uint32_t row, SurfaceMeshes& surfaces) {
  constexpr std::uint32_t kSegmentsOfCell = 4;
  const state::Deformable& object = t.objects[row];
  const std::uint32_t segments = object.segments.count;
  const auto joins = [&](std::uint32_t i) {
    return i < segments && t.segments.joins(object.segments.first + i);
  };
  SurfaceMesh& mesh = surfaces.meshes.emplace_back();
  mesh.object = row;
  mesh.revision = t.objects[row].revision;
  mesh.first_particle = t.objects[row].particles.first;
  mesh.first_vertex = static_cast<std::uint32_t>(surfaces.particle.size());
  mesh.vertex_count = segments + 1;
  std::vector<Vec3> centers;
  for (std::uint32_t i = 0; i <= segments; ++i) {
    const std::uint32_t vertex = mesh.first_vertex + i;
    const auto first_edge = static_cast<std::uint32_t>(mesh.edges.size());
    if (i == 0 || (joins(i) && first_edge - mesh.cells.back().first_edge == kSegmentsOfCell)) {
      mesh.cells.push_back({.first_vertex = i, .first_edge = first_edge});
      centers.push_back({static_cast<Real>(i), Real(0), Real(0)});
    }
    surfaces.particle.push_back(object.particles.first + i);
    surfaces.mesh_of.push_back(static_cast<std::uint32_t>(surfaces.meshes.size() - 1));
    mesh.vertices.push_back(vertex);
    mesh.neighbor_begin.push_back(static_cast<std::uint32_t>(mesh.neighbors.size()));
    if (i > 0 && joins(i - 1)) mesh.neighbors.push_back(vertex - 1);
    if (joins(i)) {
      mesh.neighbors.push_back(vertex + 1);
      SurfaceEdge edge = {.vertex = {vertex, vertex + 1}};
      edge.owns_vertex = joins(i + 1) ? 1 : 3;
      mesh.edges.push_back(edge);
    }
    mesh.cells.back().end_vertex = i + 1;
    mesh.cells.back().end_edge = static_cast<std::uint32_t>(mesh.edges.size());
  }
  mesh.neighbor_begin.push_back(static_cast<std::uint32_t>(mesh.neighbors.size()));
  mesh.nodes = build_surface_tree(centers);
  order_cells(mesh);
  make_parts(mesh);
}

/// Numbers the vertices of a mesh from `first` on.
void renumber(std::uint32_t first, SurfaceMesh& mesh) {
  const std::uint32_t change = first - mesh.first_vertex;  // It may wrap.
  mesh.first_vertex = first;
  if (change == 0) return;
  for (std::uint32_t& vertex : mesh.vertices) vertex += change;
  for (std::uint32_t& vertex : mesh.neighbors) vertex += change;
  for (SurfaceEdge& edge : mesh.edges) {
    for (std::uint32_t& vertex : edge.vertex) vertex += change;
    for (std::uint32_t& vertex : edge.opposite) vertex += vertex == SurfaceEdge::kNone ? 0 : change;
  }
  for (SurfaceTriangle& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle.vertex) vertex += change;
  }
}

/// Surfaces of the step before, from which those of unchanged objects are taken.
class SurfacesBefore {
 public:
  explicit SurfacesBefore(SurfaceMeshes& surfaces)
      : meshes_(std::move(surfaces.meshes)), particle_(std::move(surfaces.particle)) {
    surfaces.meshes.clear();
    surfaces.particle.clear();
    surfaces.mesh_of.clear();
    for (std::uint32_t i = 0; i < meshes_.size(); ++i) by_revision_.emplace_back(meshes_[i].revision, i);
    std::sort(by_revision_.begin(), by_revision_.end());
  }

  /// Appends the surface of an object as it was. Returns false if that has changed.
  bool take(const state::Tables& t, std::uint32_t row, SurfaceMeshes& surfaces) {
    const std::pair key{t.objects[row].revision, std::uint32_t{0}};
    const auto known = std::lower_bound(by_revision_.begin(), by_revision_.end(), key);
    if (known == by_revision_.end() || known->first != key.first) return false;
    SurfaceMesh& mesh = meshes_[known->second];
    const auto vertices = std::span(particle_).subspan(mesh.first_vertex, mesh.vertex_count);
    const std::uint32_t change = t.objects[row].particles.first - mesh.first_particle;  // It may wrap.
    renumber(static_cast<std::uint32_t>(surfaces.particle.size()), mesh);
    mesh.object = row;
    mesh.first_particle += change;
    for (const std::uint32_t particle : vertices) surfaces.particle.push_back(particle + change);
    surfaces.meshes.push_back(std::move(mesh));
    surfaces.mesh_of.resize(surfaces.particle.size(), static_cast<std::uint32_t>(surfaces.meshes.size() - 1));
    return true;
  }

 private:
  std::vector<SurfaceMesh> meshes_;
  std::vector<std::uint32_t> particle_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> by_revision_;
};

/// Appends the surface of an object; `vertex_of` is scratch memory by particle, full of kNone.
void append_surface(const state::Tables& t, std::uint32_t row, std::vector<std::uint32_t>& vertex_of,
                    SurfaceMeshes& surfaces) {
  if (t.objects[row].kind == PointRef::Kind::kRope) {
    if (t.objects[row].touches_surfaces) append_rope(t, row, surfaces);
    return;
  }
  std::vector<Triangle> triangles = state::surface_triangles(t, t.objects[row]);
  if (triangles.empty() || !t.objects[row].surface.rest_points) return;
  SurfaceMesh& mesh = surfaces.meshes.emplace_back();
  mesh.object = row;
  mesh.revision = t.objects[row].revision;
  mesh.first_particle = t.objects[row].particles.first;
  mesh.first_vertex = static_cast<std::uint32_t>(surfaces.particle.size());
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t particle : triangle) vertex_of[particle] = 0;
  }
  const state::Rows& rows = t.objects[row].particles;
  for (std::uint32_t particle = rows.first; particle < rows.end(); ++particle) {
    if (vertex_of[particle] == kNone) continue;
    vertex_of[particle] = static_cast<std::uint32_t>(surfaces.particle.size()) - mesh.first_vertex;
    surfaces.particle.push_back(particle);
    surfaces.mesh_of.push_back(static_cast<std::uint32_t>(surfaces.meshes.size() - 1));
  }
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = vertex_of[corner];
  }
  const std::uint32_t count = static_cast<std::uint32_t>(surfaces.particle.size()) - mesh.first_vertex;
  std::vector<Vec3> rest;
  for (std::uint32_t i = mesh.first_vertex; i < mesh.first_vertex + count; ++i)
    rest.push_back((*t.objects[row].surface.rest_points)[surfaces.particle[i] - rows.first]);
  MeshBuilder(triangles, rest).build(mesh);
  order_cells(mesh);
  make_parts(mesh);
}

/// Calls `visit` with the particles by which a place of a hook is joined with others: all of a surface, and
/// of a rope only the nearest one, so that hooks along a rope do not join all that hangs on it.
template <class Visit>
void for_joined_particles(const state::Tables& t, const state::HookPlace& place,
                          std::span<const std::uint32_t> vertex_of, Visit visit) {
  const bool is_rope = t.objects[place.object].kind == PointRef::Kind::kRope;
  std::uint32_t nearest = 0;
  for (std::uint32_t k = 0; k < place.particle_count; ++k) {
    if (place.weight[k] > place.weight[nearest]) nearest = k;
  }
  for (std::uint32_t k = 0; k < place.particle_count; ++k) {
    if (k == nearest || (!is_rope && vertex_of[place.particle[k]] != kNone)) visit(place.particle[k]);
  }
}

/// Gives the vertices that hooks hold together one number, also those held by the same point of a rope.
void join_hooked(const state::Tables& t, std::span<const std::uint32_t> vertex_of, SurfaceMeshes& surfaces) {
  base::DisjointSets sets(vertex_of.size());
  for (const state::Hook& hook : t.hooks) {
    if (hook.broken || hook.kind == HookKind::kDistance || !hook.a.is_point() || !hook.b.is_point()) continue;
    std::uint32_t first = kNone;
    for (const state::HookPlace* place : {&hook.a, &hook.b}) {
      for_joined_particles(t, *place, vertex_of, [&](std::uint32_t particle) {
        if (first == kNone) first = particle;
        sets.merge(first, particle);
      });
    }
  }
  surfaces.joined.resize(surfaces.particle.size());
  for (std::uint32_t i = 0; i < surfaces.joined.size(); ++i)
    surfaces.joined[i] = sets.root(surfaces.particle[i]);
}

/// Lists the pairs of SurfaceMeshes::sewn.
void list_sewn(const state::Tables& t, std::span<const std::uint32_t> vertex_of, SurfaceMeshes& surfaces) {
  constexpr std::ptrdiff_t kHooksOfSeam = 3;
  std::vector<std::array<std::uint32_t, 2>> hooked;  // A pair for each hook, for one that slides three.
  for (const state::Hook& hook : t.hooks) {
    if (hook.broken || hook.kind == HookKind::kDistance || !hook.a.is_point() || !hook.b.is_point()) continue;
    const std::uint32_t a = vertex_of[hook.a.particle[0]];
    const std::uint32_t b = vertex_of[hook.b.particle[0]];
    if (a == kNone || b == kNone) continue;
    const auto [first, second] = std::minmax(surfaces.mesh_of[a], surfaces.mesh_of[b]);
    if (!surfaces.meshes[first].is_rope() && !surfaces.meshes[second].is_rope()) continue;
    const auto times = static_cast<std::size_t>(hook.kind == HookKind::kRopeSlide ? kHooksOfSeam : 1);
    hooked.insert(hooked.end(), times, {first, second});
  }
  std::sort(hooked.begin(), hooked.end());
  surfaces.sewn.clear();
  for (auto i = hooked.begin(); i != hooked.end();) {
    const auto end = std::upper_bound(i, hooked.end(), *i);
    if (end - i >= kHooksOfSeam) surfaces.sewn.push_back(*i);
    i = end;
  }
}

}  // namespace

bool refresh_surfaces(const state::Tables& tables, SurfaceMeshes& surfaces) {
  const bool stale = surfaces.revision != tables.revision;
  if (!stale && surfaces.hook_revision == tables.hook_revision) return false;
  surfaces.revision = tables.revision;
  surfaces.hook_revision = tables.hook_revision;
  std::vector<std::uint32_t> vertex_of(tables.particles.position.size(), kNone);
  if (stale) {
    SurfacesBefore before(surfaces);
    for (std::uint32_t row = 0; row < tables.objects.size(); ++row) {
      if (!before.take(tables, row, surfaces)) append_surface(tables, row, vertex_of, surfaces);
    }
  }
  for (std::uint32_t i = 0; i < surfaces.particle.size(); ++i) vertex_of[surfaces.particle[i]] = i;
  join_hooked(tables, vertex_of, surfaces);
  for (SurfaceMesh& mesh : surfaces.meshes) fill_parts(surfaces.joined, mesh);
  list_sewn(tables, vertex_of, surfaces);
  return stale;
}

}  // namespace hooke::solver
