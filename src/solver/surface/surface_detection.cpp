#include "solver/surface/surface_detection.h"

#include "base/assert.h"
#include "solver/surface/surface_kernels.h"
#include "solver/surface/surface_rows.h"
#include "solver/surface/surface_tuning.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace hooke::solver {

namespace {

/// Calls `work` with each of `count` items, on several threads if there is a pool.
template <class Work>
void for_items(parallel::ThreadPool* pool, std::size_t count, Work work) {
  if (pool != nullptr) {
    return parallel::for_items(*pool, static_cast<int>(count),
                               [&](int i) { work(static_cast<std::size_t>(i)); });
  }
  for (std::size_t i = 0; i < count; ++i) work(i);
}

constexpr double kMovingShare = 0.95;  ///< Share of the points that decides how long cages last.

/// Takes positions at the start of the substep and velocities of now.
void place_vertices(const state::Tables& t, SurfaceContacts& c, SurfaceGroup& group) {
  group.origin = t.objects[c.surfaces.meshes[group.meshes.front()].object].origin;
  for (const std::uint32_t i : group.meshes)
    c.shift[i] = vector_cast<Real>(t.objects[c.surfaces.meshes[i].object].origin - group.origin);
  Real largest = Real(0);
  group.held = false;
  for_vertices(c, group, [&](std::uint32_t vertex, std::uint32_t mesh) {
    const Vec3 x = c.start[vertex].x + c.shift[mesh];
    c.found_at[vertex] = c.position[vertex] = {x, t.objects[c.surfaces.meshes[mesh].object].surface.radius};
    c.velocity[vertex] = t.particles.velocity[c.surfaces.particle[vertex]];
    largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    group.held = group.held || c.velocity[vertex].inverse_mass == Real(0);
  });
  group.reserve = kSurfaceReserve * (largest + Real(0.05));
  group.displacement = {};
}

/// The value below which are 95 % of those from `first` on; it changes their order.
Real most_of(std::vector<Real>& values, std::size_t first) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  const auto at = static_cast<std::ptrdiff_t>(kMovingShare * static_cast<double>(values.end() - begin - 1));
  std::nth_element(begin, begin + at, values.end());
  return *(begin + at);
}

/// Displacement of the faster points in a substep, over the length of their edges: of all, and of each rope,
/// of which there may be few beside those of a cloth.
Real displacement_of_fast_points(const state::Tables& t, const SurfaceContacts& c, Vec3 mean, Real h,
                                 SurfaceGroup& group) {
  group.speeds.clear();
  Real of_ropes = Real(0);
  for (const std::uint32_t i : group.meshes) {
    const SurfaceMesh& mesh = c.surfaces.meshes[i];
    const std::size_t first = group.speeds.size();
    const Real edge = t.objects[mesh.object].surface.edge;
    for (std::uint32_t vertex = mesh.first_vertex; vertex < mesh.end_vertex(); ++vertex) {
      const Real displacement = length(c.velocity[vertex].v - mean) * h / edge;
      group.speeds.push_back(is_finite(c.velocity[vertex].v) ? displacement : Real(0));
    }
    if (mesh.is_rope()) of_ropes = std::max(of_ropes, most_of(group.speeds, first));
  }
  return std::max(of_ropes, most_of(group.speeds, 0));
}

void make_cages(const state::Tables& t, Real h, SurfaceContacts& c, SurfaceGroup& group) {
  const Vec3 mean = mean_velocity(c, group, [&](std::uint32_t vertex) { return c.velocity[vertex].v; });
  const Real displacement = displacement_of_fast_points(t, c, mean, h, group);
  const auto most = static_cast<Real>(c.substeps_left);
  const Real lasts =
      displacement * most > kCageDisplacement ? std::floor(kCageDisplacement / displacement) : most;
  group.substeps_left = std::max(1, static_cast<int>(lasts));
  const Real time = h * static_cast<Real>(group.substeps_left);
  const Real moving =
      std::min(Real(1), displacement * static_cast<Real>(group.substeps_left) / kCalmDisplacement);
  const Real share = kCalmRoom + (kRoom - kCalmRoom) * moving;
  for_vertices(c, group, [&](std::uint32_t vertex, std::uint32_t mesh) {
    const Real edge = t.objects[c.surfaces.meshes[mesh].object].surface.edge;
    const Vec3 drift = time * (c.velocity[vertex].v - mean);
    Real room = share * edge;
    if (group.substeps_left > 1) room = std::min(room + kCageDisplacement * length(drift), kMostRoom * edge);
    c.cage[vertex] = {drift, room};
  });
}

/// The box of where a vertex may go, and of what is within `reach` [m] of its expected path.
SurfaceBox box_of_cage(const SurfaceContacts& c, std::uint32_t vertex, Real reserve, Real reach) {
  const Vec3 x = c.position[vertex].x;
  const SurfaceCage& cage = c.cage[vertex];
  const Real room = std::max(cage.room, reach) + reserve;
  SurfaceBox box;
  const auto set = [&](std::size_t k, Real at, Real drift) {
    box.lower[k] = at + std::min(drift, Real(0)) - room;
    box.negated_upper[k] = -(at + std::max(drift, Real(0)) + room);
  };
  set(0, x.x, cage.drift.x);
  set(1, x.y, cage.drift.y);
  set(2, x.z, cage.drift.z);
  return box;
}

SurfaceBox join(const SurfaceBox& a, const SurfaceBox& b) {
  SurfaceBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.lower[k] = std::min(a.lower[k], b.lower[k]);
    box.negated_upper[k] = std::min(a.negated_upper[k], b.negated_upper[k]);
  }
  return box;
}

/// Makes the boxes of surfaces out of the cages of their vertices.
class BoxFitter {
 public:
  /// Vertices and faces reach `reach` [m] beyond their expected paths, edges `edge_reach`, both not more.
  BoxFitter(const SurfaceMesh& mesh, Real reserve, Real reach, Real edge_reach, SurfaceBoxes& boxes)
      : mesh_(mesh), boxes_(boxes), reserve_(reserve), reach_(reach), edge_reach_(edge_reach) {}

  void fit(const SurfaceContacts& c) {
    boxes_.by_vertex.resize(mesh_.vertex_count);
    boxes_.by_end.resize(mesh_.vertex_count);
    for (std::uint32_t i = 0; i < mesh_.vertex_count; ++i) {
      boxes_.by_vertex[i] = box_of_cage(c, mesh_.first_vertex + i, reserve_, reach_);
      boxes_.by_end[i] = box_of_cage(c, mesh_.first_vertex + i, reserve_, edge_reach_);
    }
    boxes_.parts.resize(mesh_.parts.size());
    boxes_.cells.resize(mesh_.cells.size());
    boxes_.nodes.resize(mesh_.nodes.size());
    boxes_.children.resize(mesh_.nodes.size());
    for (std::uint32_t i = 0; i < mesh_.cells.size(); ++i) boxes_.cells[i] = fit_cell(mesh_.cells[i]);
    for (std::size_t i = mesh_.nodes.size(); i-- > 0;) fit_node(i);
  }

 private:
  [[nodiscard]] const SurfaceBox& at(std::uint32_t vertex) const {
    return boxes_.by_vertex[vertex - mesh_.first_vertex];
  }

  [[nodiscard]] const SurfaceBox& end_at(std::uint32_t vertex) const {
    return boxes_.by_end[vertex - mesh_.first_vertex];
  }

  /// Returns the box of the cell, of which that of the whole edges, triangles and vertices is a part.
  SurfaceBox fit_cell(const SurfaceCell& cell) {
    const std::uint32_t first =
        mesh_.is_rope() ? mesh_.vertices[cell.first_vertex] : mesh_.triangles[cell.first_triangle].vertex[0];
    SurfaceBox all = at(first);
    for (std::uint32_t i = cell.first_part; i < cell.end_part; ++i)
      fit_part(mesh_.parts[i], boxes_.parts[i], all);
    return all;
  }

  void fit_part(const SurfacePart& part, SurfacePartBoxes& boxes, SurfaceBox& all) const {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      boxes.vertices.set(lane, lane < part.vertices ? at(part.vertex[lane]) : SurfaceBox4::none());
      // Points of a rope between segments that are gone belong to no edge.
      if (mesh_.is_rope() && lane < part.vertices) all = join(all, at(part.vertex[lane]));
      if (lane >= part.edges) {
        boxes.edges.set(lane, SurfaceBox4::none());
        continue;
      }
      const SurfaceBox edge = join(end_at(part.edge[0][lane]), end_at(part.edge[1][lane]));
      boxes.edges.set(lane, edge);
      if (mesh_.is_rope()) all = join(all, edge);
    }
    for (std::size_t lane = 0; lane < 2; ++lane) {
      SurfaceBox triangle = SurfaceBox4::none();
      if (lane < part.triangles) {
        triangle =
            join(join(at(part.triangle[0][lane]), at(part.triangle[1][lane])), at(part.triangle[2][lane]));
        all = join(all, triangle);
      }
      boxes.triangles.set(lane, triangle);
      boxes.triangles.set(lane + 2, triangle);
    }
  }

  void fit_node(std::size_t number) {
    const SurfaceNode& node = mesh_.nodes[number];
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::uint32_t child = node.child[lane];
      const bool is_cell = (child & SurfaceNode::kCell) != 0;
      SurfaceBox box = SurfaceBox4::none();
      if (child != SurfaceNode::kNone)
        box = is_cell ? boxes_.cells[child & ~SurfaceNode::kCell] : boxes_.nodes[child];
      boxes_.children[number].set(lane, box);
      if (child != SurfaceNode::kNone)
        boxes_.nodes[number] = lane == 0 ? box : join(boxes_.nodes[number], box);
    }
  }

  const SurfaceMesh& mesh_;
  SurfaceBoxes& boxes_;
  Real reserve_;
  Real reach_;
  Real edge_reach_;
};

/// All blocks but the last one are full.
std::uint32_t count_pairs(const std::vector<SurfacePairBlock>& blocks) {
  if (blocks.empty()) return 0;
  return static_cast<std::uint32_t>((blocks.size() - 1) * kLanes) +
         static_cast<std::uint32_t>(blocks.back().count);
}

/// Makes rows and pairs of what was found.
class RowMaker {
 public:
  RowMaker(const state::Tables& tables, SurfaceContacts& contacts, SurfaceGroup& group)
      : t_(tables), c_(contacts), group_(group), packer_(contacts.in_open_block, group.rows) {}

  void finish() { packer_.finish(); }

  /// Distance that two surfaces keep, or one from itself.
  [[nodiscard]] Real distance_of(std::uint32_t mesh_a, std::uint32_t mesh_b) const {
    if (mesh_a == mesh_b) return object(mesh_a).surface.self_distance;
    return object(mesh_a).surface.radius + object(mesh_b).surface.radius;
  }

  /// Says which rows there will be. It changes nothing else, so that threads may do it at once.
  void set_shares(std::span<SurfaceFound> all) const {
    for (SurfaceFound& found : all) {
      if ((found.flags & SurfaceFound::kUncertain) == 0) found.share = share_of(found);
    }
  }

  /// Distance of two edges below which a row may hold them apart.
  [[nodiscard]] Real edge_near(std::uint32_t mesh_a, std::uint32_t mesh_b) const {
    const Real share = any_rope(mesh_a, mesh_b) ? kRopeShare + kSurfaceMargin : kEdgeShare + kEdgeMargin;
    return share * distance_of(mesh_a, mesh_b);
  }

  /// Begins with a pair of surfaces; of those that go through each other with their tangle, else null.
  void begin_pair(const SurfaceTangle* tangle) {
    mark_passed(0);
    tangle_ = tangle;
    mark_passed(1);
    if (tangle == nullptr) return;
    for (const SurfaceCrossing& crossing : tangle->crossings) add_way_back(crossing);
  }

  void take(const SurfaceFound& found) {
    if (tangle_ != nullptr && has_passed(found.vertex)) return;
    if ((found.flags & SurfaceFound::kUncertain) != 0 && !separate(found)) return;
    if ((found.flags & SurfaceFound::kReachable) != 0) add_pair(found);
    add_row(found);
  }

 private:
  void mark_passed(std::uint8_t mark) {
    if (tangle_ == nullptr) return;
    for (const std::uint32_t vertex : tangle_->passed) c_.passed[vertex] = mark;
  }

  [[nodiscard]] bool has_passed(const std::array<std::uint32_t, 4>& vertex) const {
    return std::any_of(vertex.begin(), vertex.end(), [&](std::uint32_t i) { return c_.passed[i] != 0; });
  }

  /// Draws the end of an edge that has come through a triangle back to the side of the other end.
  void add_way_back(const SurfaceCrossing& crossing) {
    const auto has_passed = [&](std::size_t end) { return c_.passed[crossing.end[end]] != 0; };
    if (has_passed(0) == has_passed(1)) return;
    const std::size_t back = has_passed(0) ? 0 : 1;
    const auto& [a, b, c] = crossing.corner;
    SurfaceRow row;
    row.vertex = {crossing.end[back], a, b, c};
    row.weight[0] = Real(1);
    for (std::size_t k = 0; k < 3; ++k) row.weight[k + 1] = static_cast<Real>(-crossing.weight[k]);
    const double side = crossing.front_end == back ? -1.0 : 1.0;
    row.normal = vector_cast<Real>(side * crossing.normal);
    const std::array<std::uint32_t, 2> pair = {c_.surfaces.mesh_of[row.vertex[0]], c_.surfaces.mesh_of[a]};
    Real gap = Real(0);
    for (std::size_t k = 0; k < 4; ++k) gap += row.weight[k] * dot(row.normal, x(row.vertex[k]));
    const Real step = kWayBack * std::min(object(pair[0]).surface.edge, object(pair[1]).surface.edge);
    row.distance = std::min(gap + step, kEdgeShare * distance_of(pair[0], pair[1]));
    add_row(row, pair[0], pair[1]);
  }

  [[nodiscard]] const state::Deformable& object(std::uint32_t mesh) const {
    return t_.objects[c_.surfaces.meshes[mesh].object];
  }
  [[nodiscard]] Vec3 x(std::uint32_t vertex) const { return c_.position[vertex].x; }
  [[nodiscard]] const SurfaceMesh& mesh(std::uint32_t number) const { return c_.surfaces.meshes[number]; }
  [[nodiscard]] bool any_rope(std::uint32_t mesh_a, std::uint32_t mesh_b) const {
    return mesh(mesh_a).is_rope() || mesh(mesh_b).is_rope();
  }

  [[nodiscard]] Real distance_of(const SurfaceFound& found) const {
    return distance_of(found.first_mesh, found.second_mesh);
  }

  /// Handles a pair whose normal does not separate it. What is apart all the same gets cages so small that it
  /// cannot meet. What touches or crosses has no cage: a row pushes it apart, by the side the surfaces
  /// face. Returns whether the pair is to be treated as others.
  bool separate(const SurfaceFound& found) {
    DVec3 between;
    for (std::size_t k = 0; k < 4; ++k)
      between += static_cast<double>(found.weight[k]) * vector_cast<double>(x(found.vertex[k]));
    const auto distance = static_cast<Real>(length(between));
    if (distance > Real(4) * group_.reserve) {
      const Real room = Real(0.4) * distance - group_.reserve;
      for (const std::uint32_t vertex : found.vertex) {
        SurfaceCage& cage = c_.cage[vertex];
        cage = {{}, std::min(cage.room, room)};
      }
      return false;
    }
    ++group_.counts.uncertain;
    if (found.is_edges) return false;
    const auto& [p, a, b, q] = found.vertex;
    const Vec3 face = cross(x(b) - x(a), x(q) - x(a));
    const Real size = length(face);
    if (!(size > Real(0))) return false;
    SurfaceFound turned = found;
    const bool outward =
        object(found.second_mesh).kind == PointRef::Kind::kSolid || found.first_mesh >= found.second_mesh;
    turned.normal = ((outward ? Real(1) : Real(-1)) / size) * face;
    turned.share = share_of(turned);
    add_row(turned);
    return false;
  }

  void add_pair(const SurfaceFound& found) {
    auto& blocks = found.is_edges ? group_.edge_pairs : group_.face_pairs;
    if (blocks.empty() || blocks.back().count == kLanes) blocks.emplace_back();
    SurfacePairBlock& block = blocks.back();
    // Lanes that are not used yet repeat the first pair, so that they can be measured.
    for (int lane = block.count; lane < (block.count == 0 ? kLanes : block.count + 1); ++lane) {
      for (std::size_t k = 0; k < 4; ++k) block.record[k][lane] = 4 * found.vertex[k];
      block.normal[0][lane] = found.normal.x;
      block.normal[1][lane] = found.normal.y;
      block.normal[2][lane] = found.normal.z;
      block.now[lane] = found.gap;
      block.most[lane] = kKeptShare * distance_of(found);
    }
    ++block.count;
  }

  /// Whether the normal points away from everything that begins at the vertex.
  [[nodiscard]] bool is_in_cone(std::uint32_t mesh, std::uint32_t vertex, Vec3 normal) const {
    for (const std::uint32_t neighbor : c_.surfaces.meshes[mesh].neighbors_of(vertex)) {
      const Vec3 along = x(neighbor) - x(vertex);
      if (dot(normal, along) > kWedgeCosine * length(along)) return false;
    }
    return true;
  }

  /// Whether the normal points away from both triangles at the edge.
  [[nodiscard]] bool is_in_wedge(const SurfaceEdge& edge, Vec3 normal) const {
    const Vec3 start = x(edge.vertex[0]);
    const Vec3 along = x(edge.vertex[1]) - start;
    const Real squared = length_squared(along);
    for (const std::uint32_t opposite : edge.opposite) {
      if (opposite == SurfaceEdge::kNone) continue;
      Vec3 across = x(opposite) - start;
      if (squared > Real(0)) across = across - (dot(across, along) / squared) * along;
      if (dot(normal, across) > kWedgeCosine * length(across)) return false;
    }
    return true;
  }

  /// The share of the thickness that the pair keeps; 0 if other features speak for it.
  [[nodiscard]] Real share_of_edges(const SurfaceFound& found) const {
    if (any_rope(found.first_mesh, found.second_mesh)) return share_of_segments(found);
    for (const Real weight : found.weight) {
      if (weight == Real(0)) return Real(0);
    }
    const SurfaceEdge& first = c_.surfaces.meshes[found.first_mesh].edges[found.first_feature];
    const SurfaceEdge& second = c_.surfaces.meshes[found.second_mesh].edges[found.second_feature];
    return is_in_wedge(first, -found.normal) && is_in_wedge(second, found.normal) ? kEdgeShare : Real(0);
  }

  /// The same for a segment of a rope and another one or an edge. A rope has no faces, so that its segments
  /// speak for the ends of edges, too. The points of a rope are left to the faces of the other.
  [[nodiscard]] Real share_of_segments(const SurfaceFound& found) const {
    const bool other_has_faces = !mesh(found.first_mesh).is_rope() || !mesh(found.second_mesh).is_rope();
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t number = side == 0 ? found.first_mesh : found.second_mesh;
      const SurfaceEdge& edge = mesh(number).edges[side == 0 ? found.first_feature : found.second_feature];
      const Vec3 outward = side == 0 ? -found.normal : found.normal;
      const bool at_second = found.weight[2 * side] == Real(0);
      if (!at_second && found.weight[2 * side + 1] != Real(0)) {
        if (!is_in_wedge(edge, outward)) return Real(0);
        continue;
      }
      const std::size_t end = at_second ? 1 : 0;
      if ((edge.owns_vertex >> end & 1U) == 0 || (other_has_faces && mesh(number).is_rope())) return Real(0);
      if (!is_in_cone(number, edge.vertex[end], outward)) return Real(0);
    }
    return other_has_faces ? kRidgeShare : kRopeShare;
  }

  [[nodiscard]] Real share_of_face(const SurfaceFound& found) const {
    const SurfaceMesh& mesh = c_.surfaces.meshes[found.second_mesh];
    const SurfaceTriangle& triangle = mesh.triangles[found.second_feature];
    std::size_t zeros = 0;
    std::size_t zero = 0;
    std::size_t corner = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_zero = found.weight[k + 1] == Real(0);
      zeros += is_zero ? 1 : 0;
      if (is_zero) zero = k;
      if (!is_zero) corner = k;
    }
    if (zeros == 0) return Real(1);
    if (!is_in_cone(found.first_mesh, found.vertex[0], -found.normal)) return Real(0);
    if (zeros == 1) {
      const std::size_t k = (zero + 1) % 3;
      if ((triangle.owns_edge >> k & 1U) == 0) return Real(0);
      return is_in_wedge(mesh.edges[triangle.edge[k]], found.normal) ? kRidgeShare : Real(0);
    }
    const std::uint32_t tip = triangle.vertex[corner];
    if ((triangle.owns_vertex >> corner & 1U) == 0) return Real(0);
    if (found.vertex[0] > tip && !this->mesh(found.first_mesh).is_rope()) return Real(0);
    return is_in_cone(found.second_mesh, tip, found.normal) ? kRidgeShare : Real(0);
  }

  [[nodiscard]] Real share_of(const SurfaceFound& found) const {
    return found.is_edges ? share_of_edges(found) : share_of_face(found);
  }

  /// Whether both are solids, and one is stiff.
  [[nodiscard]] bool belongs_to_solution(std::uint32_t first, std::uint32_t second) const {
    const std::uint32_t a = c_.surfaces.meshes[first].object;
    const std::uint32_t b = c_.surfaces.meshes[second].object;
    return (c_.stiff[a] | c_.stiff[b]) != 0 && t_.objects[a].tetrahedra.count > 0 &&
           t_.objects[b].tetrahedra.count > 0;
  }

  /// A point of a rope that lies over a ridge or a tip of a flat place is held by the plane of a face, at the
  /// whole thickness. Over ridges at less it would sink between two searches, and rise again over a face.
  [[nodiscard]] SurfaceFound on_plane(const SurfaceFound& found) const {
    constexpr Real kFlat = Real(0.97);  // Cosine between the normal and that of the face.
    if (found.is_edges || found.share != kRidgeShare || !mesh(found.first_mesh).is_rope()) return found;
    const auto& [p, a, b, q] = found.vertex;
    const Vec3 face = cross(x(b) - x(a), x(q) - x(a));
    const Real side = dot(face, found.normal);
    const Real size = length(face);
    if (!(std::abs(side) > kFlat * size)) return found;
    SurfaceFound turned = found;
    turned.normal = ((side > Real(0) ? Real(1) : Real(-1)) / size) * face;
    turned.share = Real(1);
    return turned;
  }

  void add_row(const SurfaceFound& at) {
    if (!(at.share > Real(0))) return;
    const SurfaceFound found = on_plane(at);
    SurfaceRow row;
    row.vertex = found.vertex;
    row.weight = found.weight;
    row.normal = found.normal;
    row.distance = found.share * distance_of(found);
    row.friction = std::sqrt(object(found.first_mesh).friction * object(found.second_mesh).friction);
    add_row(row, found.first_mesh, found.second_mesh);
  }

  void add_row(const SurfaceRow& row, std::uint32_t first_mesh, std::uint32_t second_mesh) {
    if (belongs_to_solution(first_mesh, second_mesh)) {
      group_.stiff_rows.push_back(row);
    } else {
      packer_.add(row);
    }
  }

  const state::Tables& t_;
  SurfaceContacts& c_;
  SurfaceGroup& group_;
  SurfaceRowPacker packer_;
  const SurfaceTangle* tangle_ = nullptr;  ///< That of the pair of surfaces at hand, if they have one.
};

/// Finds where surfaces of the group go through each other, of those that may.
void find_tangles(const state::Tables& t, SurfaceContacts& c, SurfaceGroup& group) {
  group.tangles.clear();
  group.counts.crossings = 0;
  const auto may_cross = [&](std::uint32_t mesh) { return c.may_cross[mesh] != 0; };
  if (std::none_of(group.meshes.begin(), group.meshes.end(), may_cross)) return;
  for_vertices(c, group, [&](std::uint32_t vertex, std::uint32_t) {
    c.exact_position[vertex] = vector_cast<double>(c.position[vertex].x);
  });
  SurfaceTangle tangle;
  for (std::uint32_t i = 0; i < group.pairs.size(); ++i) {
    const auto& [a, b] = group.pairs[i];
    if (!may_cross(a) && !may_cross(b)) continue;
    find_crossings(c.surfaces, a, b, c.exact_position, static_cast<double>(group.reserve), tangle.crossings);
    if (tangle.crossings.empty()) continue;
    list_passed(t, c.surfaces, a, b, tangle.crossings, tangle.passed);
    tangle.pair = i;
    group.counts.crossings += static_cast<std::uint32_t>(tangle.crossings.size());
    group.tangles.push_back(tangle);
  }
}

/// Notes which surfaces of the group are to be looked at again: those that go through others, and where
/// some touched, all that were looked at now.
void note_tangles(SurfaceContacts& c, const SurfaceGroup& group, bool any_touching) {
  for (const std::uint32_t mesh : group.meshes) c.crosses[mesh] = any_touching ? c.may_cross[mesh] : 0;
  for (const SurfaceTangle& tangle : group.tangles) {
    for (const std::uint32_t mesh : group.pairs[tangle.pair]) c.crosses[mesh] = 1;
  }
  for (const std::uint32_t mesh : group.meshes) c.may_cross[mesh] = c.crosses[mesh];
}

/// Forgets what the last search of the group found.
void begin_search(SurfaceGroup& group) {
  group.rows.clear();
  group.stiff_rows.clear();
  group.face_pairs.clear();
  group.edge_pairs.clear();
  group.known = true;
  group.first_load = group.end_load = 0;
  ++group.counts.searches;
}

}  // namespace

bool clip_out_of_start(const SurfaceCage& cage, Vec3& displacement) {
  const Real squared = length_squared(cage.drift);
  const Real share =
      squared > Real(0) ? std::clamp(dot(displacement, cage.drift) / squared, Real(0), Real(1)) : Real(0);
  const Vec3 on_line = share * cage.drift;
  const Vec3 off = displacement - on_line;
  const Real distance = length(off);
  if (!(distance > cage.room)) return false;
  // A little less than the room, so that rounding does not lead out of it.
  displacement = on_line + (Real(0.999) * cage.room / distance) * off;
  return true;
}

void find_group_contacts(parallel::ThreadPool* pool, const state::Tables& tables, Real h,
                         SurfaceContacts& contacts, SurfaceGroup& group) {
  place_vertices(tables, contacts, group);
  make_cages(tables, h, contacts, group);
  find_tangles(tables, contacts, group);
  begin_search(group);
  for_items(pool, group.meshes.size(), [&](std::size_t i) {
    const std::uint32_t mesh = group.meshes[i];
    const Real radius = tables.objects[contacts.surfaces.meshes[mesh].object].surface.radius;
    const Real reach = (Real(1) + kSurfaceMargin) * radius;
    const Real edge_reach = group.any_rope ? reach : (kEdgeShare + kEdgeMargin) * radius;
    BoxFitter(contacts.surfaces.meshes[mesh], Real(2) * group.reserve, reach, edge_reach,
              contacts.boxes[mesh])
        .fit(contacts);
  });
  if (group.found.size() < group.pairs.size()) group.found.resize(group.pairs.size());
  RowMaker maker(tables, contacts, group);
  for_items(pool, group.pairs.size(), [&](std::size_t i) {
    const auto& [a, b] = group.pairs[i];
    const Real distance = maker.distance_of(a, b);
    group.found[i].clear();
    wide::search_surfaces({.mesh_a = &contacts.surfaces.meshes[a],
                           .mesh_b = &contacts.surfaces.meshes[b],
                           .boxes_a = &contacts.boxes[a],
                           .boxes_b = &contacts.boxes[b],
                           .number_a = a,
                           .number_b = b,
                           .position = contacts.position.data(),
                           .cage = contacts.cage.data(),
                           .face_near = (Real(1) + kSurfaceMargin) * distance,
                           .edge_near = maker.edge_near(a, b),
                           .reserve = group.reserve},
                          group.found[i]);
    maker.set_shares(group.found[i]);
  });
  const auto pairs = std::span(group.found).first(group.pairs.size());
  group.overflows = std::any_of(pairs.begin(), pairs.end(), [](const std::vector<SurfaceFound>& found) {
    return found.size() == kMostFound;
  });
  if (group.overflows) return;
  // There is room at once for as many pairs as can be, since blocks that are not written cost nothing.
  std::size_t count = 0;
  for (const std::vector<SurfaceFound>& found : pairs) count += found.size();
  group.face_pairs.reserve(count / kLanes + 1);
  group.edge_pairs.reserve(count / kLanes + 1);
  // Rows go into blocks in the order of pairs, whoever found them.
  const std::uint32_t touched_before = group.counts.uncertain;
  auto tangle = group.tangles.begin();
  for (std::size_t i = 0; i < group.pairs.size(); ++i) {
    maker.begin_pair(tangle != group.tangles.end() && tangle->pair == i ? &*tangle++ : nullptr);
    for (const SurfaceFound& found : group.found[i]) maker.take(found);
  }
  maker.begin_pair(nullptr);
  maker.finish();
  note_tangles(contacts, group, group.counts.uncertain > touched_before);
  group.counts.pairs = count_pairs(group.face_pairs) + count_pairs(group.edge_pairs);
}

}  // namespace hooke::solver
