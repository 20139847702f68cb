#include "base/assert.h"
#include "collision/manifold/manifold_axes.h"
#include "collision/manifold/manifold_features.h"
#include "collision/manifold/manifold_points.h"
#include "collision/manifold/manifold_tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <span>

namespace hooke::collision {

namespace {

using geometry::ConvexHull;

constexpr std::uint32_t kAxisOfEdges = 0x40000000;
constexpr std::uint32_t kEdgeBits = 12;

/// Two hulls and the best axis so far. Scores are separations with preferences.
struct HullPair {
  const Convex& a;
  const Convex& b;
  std::uint32_t last_axis;
  Real keep;
  Real prefer_faces;
  Axis best = {{}, -std::numeric_limits<Real>::infinity(), 0};
  Real score = -std::numeric_limits<Real>::infinity();

  void offer(const Axis& axis, Real bias) {
    const Real s = axis.separation - bias + (axis.code == last_axis ? keep : Real(0));
    if (!(s > score)) return;
    best = axis;
    score = s;
  }
};

Vec3 vertex_of(const Convex& c, std::size_t i) {
  return c.center + c.axes * c.hull->vertices[i];
}

Vec3 farthest_vertex(const Convex& c, Vec3 d) {
  return vertex_of(c, geometry::support(*c.hull, transpose(c.axes) * d));
}

Axis face_axis(const Convex& own, const Convex& other, std::size_t face, std::uint32_t side) {
  const ConvexHull::Face& f = own.hull->faces[face];
  const Vec3 n = own.axes * f.normal;
  const Real separation = dot(n, farthest_vertex(other, -n) - own.center) - f.offset;
  return {side == kAxisOfA ? n : -n, separation, side + static_cast<std::uint32_t>(face)};
}

void offer_faces(const Convex& own, const Convex& other, std::uint32_t side, HullPair& pair) {
  const Vec3 local = transpose(own.axes) * (middle_of(other) - own.center);
  for (std::size_t i = 0; i < own.hull->faces.size(); ++i) {
    const ConvexHull::Face& f = own.hull->faces[i];
    // The other's center is inside it by its inner radius, so this is an upper bound of the separation.
    const Real bound = dot(f.normal, local) - f.offset - other.hull->inner_radius;
    if (bound + pair.keep > pair.score) pair.offer(face_axis(own, other, i, side), Real(0));
  }
}

/// An edge in world axes, with the normals of its faces.
struct WorldEdge {
  Vec3 start, along, normal_a, normal_b;
  std::uint32_t index;
};

WorldEdge world_edge(const Convex& c, std::size_t i) {
  const ConvexHull::Edge& e = c.hull->edges[i];
  const Vec3 start = vertex_of(c, e.vertex_a);
  return {start, vertex_of(c, e.vertex_b) - start, c.axes * c.hull->faces[e.face_a].normal,
          c.axes * c.hull->faces[e.face_b].normal, static_cast<std::uint32_t>(i)};
}

/// A list of such edges. It has room on the stack for those of the largest hull, not filled with zeros,
/// because most hulls have few.
class EdgeList {
 public:
  void add(const WorldEdge& edge) {
    HOOKE_ASSERT(count_ < kMost);
    ::new (memory_ + count_++ * sizeof(WorldEdge)) WorldEdge(edge);
  }
  [[nodiscard]] std::span<const WorldEdge> edges() const {
    return {std::launder(reinterpret_cast<const WorldEdge*>(memory_)), count_};
  }

 private:
  static constexpr std::size_t kMost = ConvexHull::kMaxEdges;
  alignas(WorldEdge) std::byte memory_[kMost * sizeof(WorldEdge)];
  std::size_t count_ = 0;
};

/// The vectors that decide whether edges cross, for eight edges side by side, so that the compiler vectorizes
/// the test.
struct EdgeLanes {
  static constexpr std::size_t kLanes = 8;
  using Lanes = std::array<Real, kLanes>;
  using Vectors = std::array<Lanes, 3>;
  Vectors along, normal_a, normal_b;

  void set(std::size_t lane, const WorldEdge& edge) {
    const auto put = [lane](Vec3 v, Vectors& to) {
      to[0][lane] = v.x;
      to[1][lane] = v.y;
      to[2][lane] = v.z;
    };
    put(edge.along, along);
    put(edge.normal_a, normal_a);
    put(edge.normal_b, normal_b);
  }

  /// Whether the normals of edge p of A and the opposite ones of edges of B cross on the sphere of
  /// directions: only then the two edges span a face of the difference of the hulls (Gregorius, 2013, The
  /// separating axis test between convex polyhedra). The result is negative in each lane where they do.
  void cross_arcs(const WorldEdge& p, Lanes& result) const {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const auto dot_lane = [i](const Vectors& v, Vec3 w) {
        return v[0][i] * w.x + v[1][i] * w.y + v[2][i] * w.z;
      };
      // normal_a x normal_b points along the edge. The normals of the edges of B are negated here:
      const Real cba = dot_lane(normal_a, p.along);
      const Real dba = dot_lane(normal_b, p.along);
      const Real adc = -dot_lane(along, p.normal_a);
      const Real bdc = -dot_lane(along, p.normal_b);
      result[i] = std::max(std::max(cba * dba, adc * bdc), -(cba * bdc));
    }
  }
};

/// Finds the edges of `own` that may separate it from `other` by more than `least`. Normals of an edge lie
/// between those of its faces. Along none of them is the other farther away than by its whole offset across
/// the edge.
void find_edges_toward(const Convex& own, const Convex& other, Real least, EdgeList& edges) {
  const ConvexHull& hull = *own.hull;
  const Vec3 middle = transpose(own.axes) * (middle_of(other) - own.center);
  const Real reach = other.hull->inner_radius + least;
  if (reach < Real(0)) {
    for (std::size_t i = 0; i < hull.edges.size(); ++i) edges.add(world_edge(own, i));
    return;
  }
  std::array<bool, ConvexHull::kMaxFaces> is_in_front;
  for (std::size_t i = 0; i < hull.faces.size(); ++i)
    is_in_front[i] = dot(hull.faces[i].normal, middle) > hull.faces[i].offset;
  for (std::size_t i = 0; i < hull.edges.size(); ++i) {
    const ConvexHull::Edge& e = hull.edges[i];
    if (!is_in_front[e.face_a] && !is_in_front[e.face_b]) continue;
    const Vec3 d = middle - hull.vertices[e.vertex_a];
    const Real along = dot(d, e.direction);
    if (length_squared(d) - along * along > reach * reach) edges.add(world_edge(own, i));
  }
}

bool arcs_cross(const WorldEdge& p, const WorldEdge& q) {
  EdgeLanes lanes = {};
  EdgeLanes::Lanes crossed;
  lanes.set(0, q);
  lanes.cross_arcs(p, crossed);
  return crossed[0] < Real(0);
}

void offer_edge_pair(const WorldEdge& p, const WorldEdge& q, Vec3 middle, HullPair& pair) {
  const Vec3 across = cross(p.along, q.along);
  const Real squared = length_squared(across);
  if (squared < kParallelEdges * length_squared(p.along) * length_squared(q.along)) return;
  const Vec3 unit = Real(1) / std::sqrt(squared) * across;
  const Vec3 n = dot(unit, p.start - middle) < Real(0) ? -unit : unit;
  pair.offer({n, dot(n, q.start - p.start), kAxisOfEdges | p.index << kEdgeBits | q.index},
             pair.prefer_faces);
}

/// Of equally good axes the first is kept: pairs are offered by edge of A, then of B.
void offer_edges(HullPair& pair) {
  constexpr std::size_t kLanes = EdgeLanes::kLanes;
  const Real least = pair.score + pair.prefer_faces - pair.keep;
  EdgeList list_a;
  EdgeList list_b;
  find_edges_toward(pair.a, pair.b, least, list_a);
  find_edges_toward(pair.b, pair.a, least, list_b);
  const std::span<const WorldEdge> edges_b = list_b.edges();
  std::array<EdgeLanes, (ConvexHull::kMaxEdges + kLanes - 1) / kLanes> lanes;
  const std::size_t room = (edges_b.size() + kLanes - 1) / kLanes * kLanes;
  for (std::size_t i = 0; i < room; ++i)
    lanes[i / kLanes].set(i % kLanes, edges_b[std::min(i, edges_b.size() - 1)]);
  const Vec3 middle = middle_of(pair.a);
  for (const WorldEdge& p : list_a.edges()) {
    for (std::size_t first = 0; first < edges_b.size(); first += kLanes) {
      EdgeLanes::Lanes crossed;
      lanes[first / kLanes].cross_arcs(p, crossed);
      const std::size_t count = std::min(kLanes, edges_b.size() - first);
      for (std::size_t i = 0; i < count; ++i) {
        if (crossed[i] < Real(0)) offer_edge_pair(p, edges_b[first + i], middle, pair);
      }
    }
  }
}

/// Offers the axis that separated the hulls in the last step. Edges that no longer span a face of the
/// difference cross nowhere near where the hulls meet. They may only show that the hulls are farther apart
/// than `margin`.
void offer_last(Real margin, HullPair& pair) {
  const std::uint32_t code = pair.last_axis;
  const std::size_t face = code & 0xFFFF;
  if ((code & kAxisOfEdges) != 0) {
    const std::size_t edge_a = code >> kEdgeBits & ((1u << kEdgeBits) - 1);
    const std::size_t edge_b = code & ((1u << kEdgeBits) - 1);
    if (edge_a >= pair.a.hull->edges.size() || edge_b >= pair.b.hull->edges.size()) return;
    const WorldEdge p = world_edge(pair.a, edge_a);
    const WorldEdge q = world_edge(pair.b, edge_b);
    const Vec3 unit = normalize(cross(p.along, q.along));
    const Vec3 n = dot(unit, p.start - middle_of(pair.a)) < Real(0) ? -unit : unit;
    const Real separation = dot(n, farthest_vertex(pair.b, -n) - farthest_vertex(pair.a, n));
    const bool tells = separation > margin || arcs_cross(p, q);
    if (tells && !(unit == Vec3{})) pair.offer({n, separation, code}, pair.prefer_faces);
  } else if ((code & kAxisOfA) != 0 && face < pair.a.hull->faces.size()) {
    pair.offer(face_axis(pair.a, pair.b, face, kAxisOfA), Real(0));
  } else if ((code & kAxisOfB) != 0 && face < pair.b.hull->faces.size()) {
    pair.offer(face_axis(pair.b, pair.a, face, kAxisOfB), Real(0));
  }
}

Feature edge_feature(const Convex& c, std::size_t index) {
  const ConvexHull::Edge& e = c.hull->edges[index];
  Feature f;
  f.kind = Feature::Kind::kSegment;
  f.add(vertex_of(c, e.vertex_a), e.vertex_a, 0);
  f.add(vertex_of(c, e.vertex_b), e.vertex_b, 0);
  return f;
}

/// Sets the result of the best axis, and the points of its features.
void add_points(const HullPair& pair, ContactResult& result) {
  const std::uint32_t code = pair.best.code;
  result.normal = pair.best.n;
  result.separation = pair.best.separation;
  result.axis = code;
  result.count = 0;
  if ((code & kAxisOfEdges) != 0) {
    const std::uint32_t mask = (1u << kEdgeBits) - 1;
    overlap_features(edge_feature(pair.a, code >> kEdgeBits & mask), edge_feature(pair.b, code & mask),
                     Real(0), Real(0), result);
    if (result.count > 0) result.point[0].key = kCrossing | (code & (kAxisOfEdges - 1));
    return;
  }
  const std::size_t face = code & 0xFFFF;
  const bool of_a = (code & kAxisOfA) != 0;
  const Feature a =
      of_a ? face_of_hull(pair.a, face) : feature_of_hull(pair.a, result.normal, kSteepFaceCosine);
  const Feature b =
      of_a ? feature_of_hull(pair.b, -result.normal, kSteepFaceCosine) : face_of_hull(pair.b, face);
  overlap_features(a, b, Real(0), Real(0), result);
}

/// Whether the hulls are apart, or a point is as deep as the axis says, within `tolerance`.
bool is_complete(const ContactResult& result, Real tolerance) {
  return result.separation > Real(0) || deepest_of(result) <= result.separation + tolerance;
}

/// Adds a corner that is inside, where no feature shows it.
void add_corner(const HullPair& pair, ContactResult& result) {
  const bool of_a = (pair.best.code & kAxisOfB) == 0;
  const Vec3 corner = of_a ? farthest_vertex(pair.b, -result.normal) : farthest_vertex(pair.a, result.normal);
  complete_points({corner, corner, true}, pair.prefer_faces, result);
}

}  // namespace

void collide_hulls(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result) {
  HullPair pair = {a, b, query.last_axis, preference(kKeepAxis, a, b), preference(kPreferFaces, a, b)};
  offer_last(query.margin, pair);
  const auto apart = [&] {
    result.separation = pair.best.separation;
    result.axis = pair.best.code;
    return pair.best.separation > query.margin;
  };
  if (apart()) return;
  offer_faces(a, b, kAxisOfA, pair);
  offer_faces(b, a, kAxisOfB, pair);
  if (apart()) return;
  offer_edges(pair);
  if (apart()) return;
  add_points(pair, result);
  const Real tolerance = pair.prefer_faces;
  if (is_complete(result, tolerance)) return;
  // The features of an axis that was kept or preferred need not lie over each other where the hulls are
  // deepest; those of the best axis do.
  HullPair best = {a, b, 0, Real(0), Real(0)};
  offer_faces(a, b, kAxisOfA, best);
  offer_faces(b, a, kAxisOfB, best);
  offer_edges(best);
  add_points(best, result);
  if (!is_complete(result, tolerance)) add_corner(best, result);
}

}  // namespace hooke::collision
