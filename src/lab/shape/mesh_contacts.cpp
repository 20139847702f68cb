#include "lab/shape/mesh_contacts.h"

#include "base/sort_unique.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace hooke::collision {

namespace {

using geometry::closest_on_face;
using geometry::closest_on_solid;
using geometry::ContactMesh;
using geometry::DTriangle;
using geometry::RigidPose;
using geometry::Search;
using geometry::SolidPoint;
using geometry::SurfaceFeature;
using geometry::TrianglePair;

using Pairs = std::vector<TrianglePair>;

constexpr double kRounding = 1e-12;  ///< Share of the sizes involved.
constexpr double kParallel = 1e-9;   ///< Sine of the angle below which directions are parallel.
constexpr double kCoplanar = 1e-9;   ///< Clearances this close count as equal.

/// This is a mesh with its vertices in the frame of the search, which is that of b.
struct PlacedContactMesh {
  const ContactMesh& mesh;
  std::vector<DVec3> positions;
  RigidPose pose;  ///< Pose of the mesh's own frame in that of the search.

  PlacedContactMesh(const ContactMesh& solid, const RigidPose& place) : mesh(solid), pose(place) {
    positions.reserve(solid.positions.size());
    for (const DVec3& p : solid.positions) positions.push_back(to_world(place, p));
  }
  [[nodiscard]] DVec3 normal(std::uint32_t triangle) const {
    return rotate(pose.rotation, mesh.face_normals[triangle]);
  }
  [[nodiscard]] geometry::MeshView view() const { return {positions, mesh.triangles}; }
  [[nodiscard]] geometry::Segment<double> edge(std::uint32_t e) const {
    return {positions[mesh.topology.edges[e][0]], positions[mesh.topology.edges[e][1]]};
  }
  /// Returns the point of its surface nearest to p, in the frame of the search, with the face's normal.
  [[nodiscard]] SolidPoint closest(DVec3 p, Search search) const {
    SolidPoint place = closest_on_solid(mesh, to_local(pose, p), search);
    place.point = to_world(pose, place.point);
    return place;
  }
};

/// TwoMeshes holds all of one search except its pairs.
struct TwoMeshes {
  PlacedContactMesh a, b;
  double margin = 0;
  Search search = Search::kAll;
  double rounding = 0;  ///< Lengths below this count as zero [m].
};

// --- Vertices ---

/// Returns the least sine of the angles of the edges at the vertex with a plane of this normal. Positive
/// means that all edges rise above the plane.
double clearance(const PlacedContactMesh& own, std::uint32_t vertex, DVec3 normal) {
  double least = 1;
  const DVec3 from = own.positions[vertex];
  for (const std::uint32_t t : own.mesh.topology.triangles_at(vertex)) {
    for (const std::uint32_t corner : own.mesh.triangles[t]) {
      if (corner == vertex) continue;
      least = std::min(least, dot(normal, normalize(own.positions[corner] - from)));
    }
  }
  return least;
}

/// Returns the face through which a vertex near the surface is pushed out.
SolidPoint face_for(const PlacedContactMesh& own, std::uint32_t vertex, const PlacedContactMesh& other,
                    const SolidPoint& nearest, const TwoMeshes& scene) {
  const DVec3 p = to_local(other.pose, own.positions[vertex]);
  std::vector<std::uint32_t> faces;
  const double reach = std::fabs(nearest.signed_distance) + scene.margin + scene.rounding;
  find_near_faces(other.mesh, p, reach, scene.search, faces);
  SolidPoint best = nearest;
  double best_clearance = -2;
  for (const std::uint32_t face : faces) {
    const SolidPoint place = closest_on_face(other.mesh, face, p);
    const double clear = clearance(own, vertex, other.normal(face));
    const bool is_clearer = clear > best_clearance + kCoplanar;
    const bool is_nearer = clear > best_clearance - kCoplanar &&
                           std::fabs(place.signed_distance) < std::fabs(best.signed_distance);
    if (best_clearance > -2 && !is_clearer && !is_nearer) continue;
    best = place;
    best_clearance = clear;
  }
  best.point = to_world(other.pose, best.point);
  return best;
}

/// Finds contacts of the vertices of `own` with `other`; normals point out of `other`.
void find_vertex_contacts(const PlacedContactMesh& own, const PlacedContactMesh& other, bool own_is_a,
                          const TwoMeshes& scene, std::vector<MeshContact>& found) {
  const geometry::OrientedBox& bounds = other.mesh.tree.nodes[0].volume;
  for (std::uint32_t v = 0; v < own.positions.size(); ++v) {
    const DVec3 p = own.positions[v];
    const double reach = scene.margin + scene.rounding;
    if (distance_squared(bounds, to_local(other.pose, p)) > reach * reach) continue;
    if (own.mesh.topology.triangles_at(v).empty()) continue;
    const SolidPoint nearest = other.closest(p, scene.search);
    const double distance = nearest.signed_distance;
    if (distance > scene.margin) continue;
    DVec3 out = distance < 0 ? nearest.point - p : p - nearest.point;
    double depth = -distance;
    SolidPoint place = nearest;
    if (distance >= -std::max(scene.margin, scene.rounding)) {
      place = face_for(own, v, other, nearest, scene);
      out = other.normal(place.triangle);
      const double height = dot(out, p - place.point);
      // A vertex outside has no depth, and one inside is at least as deep as it is far from the surface.
      depth = distance > scene.rounding ? -std::max(height, 0.0) : std::max(-height, -distance);
    }
    out = normalize(out);
    const DVec3 middle = p + 0.5 * depth * out;
    if (own_is_a) {
      found.push_back({MeshContactKind::kVertexFace, v, place.triangle, middle, -out, depth});
    } else {
      found.push_back({MeshContactKind::kFaceVertex, place.triangle, v, middle, out, depth});
    }
  }
}

// --- Edges that go through faces ---

/// A Pierce is where an edge goes through a triangle, at `fraction` of the edge.
struct Pierce {
  std::uint32_t edge = 0;
  double fraction = 0;
  std::uint32_t face = 0;

  friend bool operator<(const Pierce& a, const Pierce& b) {
    return std::tie(a.edge, a.fraction, a.face) < std::tie(b.edge, b.fraction, b.face);
  }
};

/// Returns pairs (edge of `own`, triangle of `other`) that may intersect.
Pairs edge_face_pairs(const PlacedContactMesh& own, const PlacedContactMesh& other, bool own_is_a,
                      const Pairs& near, Search search) {
  Pairs pairs;
  if (search == Search::kAll) {
    for (std::uint32_t e = 0; e < own.mesh.topology.edges.size(); ++e) {
      for (std::uint32_t t = 0; t < other.mesh.triangles.size(); ++t) pairs.emplace_back(e, t);
    }
    return pairs;
  }
  for (const auto& [in_a, in_b] : near) {
    const std::uint32_t triangle = own_is_a ? in_a : in_b;
    for (const std::uint32_t e : own.mesh.topology.triangle_edges[triangle]) {
      pairs.emplace_back(e, own_is_a ? in_b : in_a);
    }
  }
  base::sort_unique(pairs);
  return pairs;
}

/// Finds where edges go through faces; an edge in a face's plane does not. Flat and concave edges are left
/// out: where solids overlap, the deepest feature is a vertex of either or a convex edge of one in a face of
/// the other.
std::vector<Pierce> find_pierces(const PlacedContactMesh& own, const PlacedContactMesh& other,
                                 const Pairs& pairs) {
  std::vector<Pierce> pierces;
  for (const auto& [edge, face] : pairs) {
    if (own.mesh.is_convex_edge[edge] == 0) continue;
    const auto [start, end] = own.edge(edge);
    const DTriangle triangle = other.view().corners(face);
    if (!geometry::segment_meets_triangle(start, end, triangle)) continue;
    const double from = dot(other.normal(face), start - triangle[0]);
    const double to = dot(other.normal(face), end - triangle[0]);
    if (from == to) continue;
    pierces.push_back({edge, std::clamp(from / (from - to), 0.0, 1.0), face});
  }
  std::sort(pierces.begin(), pierces.end());
  return pierces;
}

/// Returns the edge that two triangles share, or kNone.
std::uint32_t shared_edge(const ContactMesh& mesh, std::uint32_t face, std::uint32_t other) {
  for (const std::uint32_t e : mesh.topology.triangle_edges[face]) {
    const auto& sides = mesh.topology.edge_sides[e].triangles;
    if (sides[0] == other || sides[1] == other) return e;
  }
  return geometry::kNone;
}

/// Returns the contact of an edge of one solid with an edge of the other; `out` points out of the other.
MeshContact edge_contact(std::uint32_t own_edge, std::uint32_t other_edge, bool own_is_a, DVec3 point,
                         DVec3 out, double depth) {
  if (own_is_a) return {MeshContactKind::kEdgeEdge, own_edge, other_edge, point, -out, depth};
  return {MeshContactKind::kEdgeEdge, other_edge, own_edge, point, out, depth};
}

/// Adds the contacts of the part of an edge inside the other solid, from `in` to `out`.
class InnerPart {
 public:
  InnerPart(const PlacedContactMesh& own, const PlacedContactMesh& other, bool own_is_a,
            const TwoMeshes& scene)
      : own_(own), other_(other), own_is_a_(own_is_a), scene_(scene) {}

  void add(const Pierce& in, const Pierce& out, std::vector<MeshContact>& found) const {
    const auto [start, end] = own_.edge(in.edge);
    const DVec3 from = start + in.fraction * (end - start);
    const DVec3 to = start + out.fraction * (end - start);
    const DVec3 middle = 0.5 * (from + to);
    if (!(length(to - from) > scene_.rounding)) return;
    const SolidPoint place = other_.closest(middle, scene_.search);
    if (!(place.signed_distance < -scene_.rounding)) return;
    const DVec3 through = normalize(place.point - middle);
    const double exit_depth = std::max(dot(through, place.point - from), dot(through, place.point - to));
    if (add_edges(in, out, middle, exit_depth, found)) return;
    add_through(in.edge, from, to, place, found);
  }

 private:
  /// Adds a contact of two edges if the faces that the edge goes through meet in an edge right over it, and
  /// the displacement out over that edge is no longer than `exit_depth`. \return Whether it did.
  bool add_edges(const Pierce& in, const Pierce& out, DVec3 middle, double exit_depth,
                 std::vector<MeshContact>& found) const {
    const DVec3 n_in = other_.normal(in.face);
    const DVec3 n_out = other_.normal(out.face);
    const DVec3 along_other = cross(n_in, n_out);
    const auto [start, end] = own_.edge(in.edge);
    const DVec3 along_own = normalize(end - start);
    DVec3 normal = normalize(cross(along_own, normalize(along_other)));
    if (!(length(along_other) > kParallel) || normal == DVec3{}) return false;
    if (dot(normal, n_in + n_out) < 0) normal = -normal;
    // Both planes meet over the edge at middle + depth normal + shift along_own.
    const double h_in = dot(n_in, other_.positions[other_.mesh.triangles[in.face][0]] - middle);
    const double h_out = dot(n_out, other_.positions[other_.mesh.triangles[out.face][0]] - middle);
    const double a11 = dot(n_in, normal);
    const double a12 = dot(n_in, along_own);
    const double a21 = dot(n_out, normal);
    const double a22 = dot(n_out, along_own);
    const double determinant = a11 * a22 - a12 * a21;
    if (!(std::fabs(determinant) > kParallel)) return false;
    const double depth = (h_in * a22 - a12 * h_out) / determinant;
    const double shift = (a11 * h_out - h_in * a21) / determinant;
    if (!(depth > 0) || depth > exit_depth) return false;
    const DVec3 below = middle + shift * along_own;
    const DVec3 above = below + depth * normal;
    const SolidPoint corner = other_.closest(above, scene_.search);
    if (std::fabs(corner.signed_distance) > scene_.margin + 1e3 * scene_.rounding) return false;
    const std::uint32_t edge = shared_edge(other_.mesh, in.face, out.face);
    found.push_back(edge_contact(in.edge, edge, own_is_a_, 0.5 * (below + above), normal, depth));
    return true;
  }

  void add_through(std::uint32_t edge, DVec3 from, DVec3 to, const SolidPoint& place,
                   std::vector<MeshContact>& found) const {
    const DVec3 middle = 0.5 * (from + to);
    const DVec3 out = normalize(place.point - middle);
    const double deep = -place.signed_distance;
    const auto push = [&](DVec3 p, double depth) {
      const DVec3 point = p + 0.5 * depth * out;
      if (own_is_a_) {
        found.push_back({MeshContactKind::kEdgeFace, edge, place.triangle, point, -out, depth});
      } else {
        found.push_back({MeshContactKind::kFaceEdge, place.triangle, edge, point, out, depth});
      }
    };
    const double at_from = dot(out, place.point - from);
    const double at_to = dot(out, place.point - to);
    if (std::min(at_from, at_to) > 0.5 * deep && std::max(at_from, at_to) < 1.5 * deep) {
      push(from, at_from);
      push(to, at_to);
    } else {
      push(middle, deep);
    }
  }

  const PlacedContactMesh& own_;
  const PlacedContactMesh& other_;
  bool own_is_a_;
  const TwoMeshes& scene_;
};

void find_through_contacts(const PlacedContactMesh& own, const PlacedContactMesh& other, bool own_is_a,
                           const TwoMeshes& scene, const Pairs& near, std::vector<MeshContact>& found) {
  const Pairs pairs = edge_face_pairs(own, other, own_is_a, near, scene.search);
  const std::vector<Pierce> pierces = find_pierces(own, other, pairs);
  const InnerPart part(own, other, own_is_a, scene);
  for (std::size_t i = 1; i < pierces.size(); ++i) {
    if (pierces[i - 1].edge == pierces[i].edge) part.add(pierces[i - 1], pierces[i], found);
  }
}

// --- Edges that cross within the margin ---

Pairs edge_pairs(const TwoMeshes& scene, const Pairs& near) {
  Pairs pairs;
  if (scene.search == Search::kAll) {
    for (std::uint32_t e = 0; e < scene.a.mesh.topology.edges.size(); ++e) {
      for (std::uint32_t f = 0; f < scene.b.mesh.topology.edges.size(); ++f) pairs.emplace_back(e, f);
    }
    return pairs;
  }
  for (const auto& [in_a, in_b] : near) {
    for (const std::uint32_t e : scene.a.mesh.topology.triangle_edges[in_a]) {
      for (const std::uint32_t f : scene.b.mesh.topology.triangle_edges[in_b]) pairs.emplace_back(e, f);
    }
  }
  base::sort_unique(pairs);
  return pairs;
}

/// Tells whether the solid at the edge is all behind the plane through it with the normal `out`.
bool is_behind(const PlacedContactMesh& placed, std::uint32_t edge, DVec3 out) {
  const geometry::EdgeSides& sides = placed.mesh.topology.edge_sides[edge];
  const auto [start, end] = placed.edge(edge);
  const DVec3 along = normalize(end - start);
  for (const std::uint32_t opposite : sides.opposite) {
    const DVec3 into = placed.positions[opposite] - start;
    const DVec3 across = normalize(into - dot(into, along) * along);
    if (dot(out, across) > kParallel) return false;
  }
  return true;
}

void find_near_edges(const TwoMeshes& scene, const Pairs& near, std::vector<MeshContact>& found) {
  const double reach = scene.margin + scene.rounding;
  for (const auto& [edge_a, edge_b] : edge_pairs(scene, near)) {
    if (scene.a.mesh.is_convex_edge[edge_a] == 0 || scene.b.mesh.is_convex_edge[edge_b] == 0) continue;
    const auto a = scene.a.edge(edge_a);
    const auto b = scene.b.edge(edge_b);
    const geometry::SegmentPair<double> pair = closest_between_segments(a, b);
    if (pair.distance_squared > reach * reach) continue;
    const auto is_inner = [](double fraction) { return fraction > kParallel && fraction < 1 - kParallel; };
    if (!is_inner(pair.fraction_a) || !is_inner(pair.fraction_b)) continue;
    const DVec3 across = cross(normalize(a.end - a.start), normalize(b.end - b.start));
    if (!(length(across) > kParallel)) continue;
    DVec3 normal = normalize(across);  // Points from a to b.
    const auto& faces = scene.a.mesh.topology.edge_sides[edge_a].triangles;
    if (dot(normal, scene.a.normal(faces[0]) + scene.a.normal(faces[1])) < 0) normal = -normal;
    const double gap = dot(normal, pair.point_b - pair.point_a);
    if (gap < -scene.rounding) continue;
    if (!is_behind(scene.a, edge_a, normal) || !is_behind(scene.b, edge_b, -normal)) continue;
    found.push_back(
        {MeshContactKind::kEdgeEdge, edge_a, edge_b, 0.5 * (pair.point_a + pair.point_b), normal, -gap});
  }
}

// --- All of them ---

/// Sorts the contacts; of two with the same features the deeper one stays.
void tidy(std::vector<MeshContact>& found) {
  std::stable_sort(found.begin(), found.end(), [](const MeshContact& x, const MeshContact& y) {
    if (x.kind != y.kind || x.feature_a != y.feature_a || x.feature_b != y.feature_b) {
      return std::tie(x.kind, x.feature_a, x.feature_b) < std::tie(y.kind, y.feature_a, y.feature_b);
    }
    return x.depth > y.depth;
  });
  const auto is_same = [](const MeshContact& x, const MeshContact& y) {
    return x.kind == MeshContactKind::kEdgeEdge && y.kind == x.kind && x.feature_a == y.feature_a &&
           x.feature_b == y.feature_b && x.feature_a != geometry::kNone && x.feature_b != geometry::kNone;
  };
  found.erase(std::unique(found.begin(), found.end(), is_same), found.end());
}

/// Tells whether p is outside at a point of the surface, and no triangle with that point comes nearer to p
/// elsewhere.
bool is_nearest_around(const ContactMesh& mesh, DVec3 p, const SolidPoint& place, double rounding) {
  if (!(place.signed_distance > 0)) return false;
  const auto is_nearest_on = [&](std::uint32_t t) {
    return closest_on_face(mesh, t, p).signed_distance >= place.signed_distance - rounding;
  };
  if (place.feature == SurfaceFeature::kEdge) {
    const auto& sides = mesh.topology.edge_sides[place.index].triangles;
    return is_nearest_on(sides[0]) && is_nearest_on(sides[1]);
  }
  if (place.feature != SurfaceFeature::kVertex) return true;
  const auto& around = mesh.topology.triangles_at(place.index);
  return std::all_of(around.begin(), around.end(), is_nearest_on);
}

bool is_finite(const RigidPose& pose) {
  const Quaternion<double>& q = pose.rotation;
  return hooke::is_finite(pose.position) && hooke::is_finite(DVec3{q.x, q.y, q.z}) && std::isfinite(q.w);
}

void to_world(const RigidPose& pose, std::vector<MeshContact>& contacts) {
  for (MeshContact& contact : contacts) {
    contact.point = geometry::to_world(pose, contact.point);
    contact.normal = normalize(rotate(pose.rotation, contact.normal));
  }
}

}  // namespace

void find_mesh_contacts(const ContactMesh& a, const RigidPose& pose_a, const ContactMesh& b,
                        const RigidPose& pose_b, const MeshContactSearch& search,
                        std::vector<MeshContact>& found) {
  found.clear();
  if (!is_finite(pose_a) || !is_finite(pose_b)) return;
  if (a.triangles.empty() || b.triangles.empty()) return;
  const RigidPose a_in_b = relative_pose(pose_a, pose_b);
  const double rounding = kRounding * (a.size + b.size);
  const TwoMeshes scene = {{a, a_in_b}, {b, {}}, std::max(search.margin, 0.0), search.search, rounding};
  if (!may_overlap(a.tree.nodes[0].volume, b.tree.nodes[0].volume, relative_pose(pose_b, pose_a),
                   scene.margin + rounding)) {
    return;
  }
  Pairs near;
  if (scene.search == Search::kTree) {
    const RigidPose b_in_a = relative_pose({}, a_in_b);
    geometry::find_candidates(a.tree, b.tree, b_in_a, scene.margin + rounding, near);
  }
  find_vertex_contacts(scene.a, scene.b, true, scene, found);
  find_vertex_contacts(scene.b, scene.a, false, scene, found);
  find_through_contacts(scene.a, scene.b, true, scene, near, found);
  find_through_contacts(scene.b, scene.a, false, scene, near, found);
  find_near_edges(scene, near, found);
  tidy(found);
  to_world(pose_b, found);
}

double largest_depth(const std::vector<MeshContact>& contacts) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const MeshContact& contact : contacts) largest = std::max(largest, contact.depth);
  return largest;
}

void find_sphere_contacts(DVec3 center, double radius, const ContactMesh& b, const RigidPose& pose_b,
                          const MeshContactSearch& search, std::vector<MeshContact>& found) {
  found.clear();
  if (!hooke::is_finite(center) || !is_finite(pose_b) || b.triangles.empty()) return;
  const DVec3 p = to_local(pose_b, center);
  const auto add = [&](const SolidPoint& place, DVec3 out) {
    const auto kind = place.feature == SurfaceFeature::kFace   ? MeshContactKind::kVertexFace
                      : place.feature == SurfaceFeature::kEdge ? MeshContactKind::kEdgeEdge
                                                               : MeshContactKind::kFaceVertex;
    const double depth = radius - place.signed_distance;
    found.push_back({kind, 0, place.index, place.point - 0.5 * depth * out, -out, depth});
  };
  const SolidPoint nearest = closest_on_solid(b, p, search.search);
  if (nearest.signed_distance > radius + search.margin) return;
  const double on_surface = kRounding * (b.size + length(p));
  if (nearest.signed_distance <= on_surface) {
    const DVec3 offset = nearest.signed_distance < 0 ? nearest.point - p : p - nearest.point;
    const bool has_offset = std::fabs(nearest.signed_distance) > on_surface;
    add(nearest, has_offset ? normalize(offset) : b.face_normals[nearest.triangle]);
  } else {
    std::vector<std::uint32_t> faces;
    find_near_faces(b, p, radius + search.margin, search.search, faces);
    for (const std::uint32_t face : faces) {
      const SolidPoint place = closest_on_face(b, face, p);
      if (is_nearest_around(b, p, place, on_surface)) add(place, normalize(p - place.point));
    }
  }
  tidy(found);
  const auto is_same = [](const MeshContact& x, const MeshContact& y) {
    return x.kind == y.kind && x.feature_b == y.feature_b;
  };
  found.erase(std::unique(found.begin(), found.end(), is_same), found.end());
  to_world(pose_b, found);
}

}  // namespace hooke::collision
