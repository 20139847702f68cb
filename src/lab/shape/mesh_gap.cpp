#include "lab/shape/mesh_gap.h"

#include "base/sort_unique.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::collision {

namespace {

using geometry::ContactMesh;
using geometry::RigidPose;
using geometry::Search;
using geometry::TrianglePair;

using Pairs = std::vector<TrianglePair>;

constexpr double kFirstMargin = 1e-4;  ///< Share of the sizes.
constexpr double kGrowth = 8;          ///< Growth of the margin from one search to the next.

/// These are the features of two meshes to compare, in ascending order.
struct Features {
  Pairs vertex_face;  ///< A vertex of a, a triangle of b.
  Pairs face_vertex;
  Pairs edges;
};

void add_all(std::size_t of_a, std::size_t of_b, Pairs& pairs) {
  for (std::uint32_t i = 0; i < of_a; ++i) {
    for (std::uint32_t k = 0; k < of_b; ++k) pairs.emplace_back(i, k);
  }
}

Features all_features(const ContactMesh& a, const ContactMesh& b) {
  Features features;
  add_all(a.positions.size(), b.triangles.size(), features.vertex_face);
  add_all(a.triangles.size(), b.positions.size(), features.face_vertex);
  add_all(a.topology.edges.size(), b.topology.edges.size(), features.edges);
  return features;
}

Features features_of(const ContactMesh& a, const ContactMesh& b, const Pairs& triangles) {
  Features features;
  for (const auto& [in_a, in_b] : triangles) {
    for (const std::uint32_t v : a.triangles[in_a]) features.vertex_face.emplace_back(v, in_b);
    for (const std::uint32_t v : b.triangles[in_b]) features.face_vertex.emplace_back(in_a, v);
    for (const std::uint32_t e : a.topology.triangle_edges[in_a]) {
      for (const std::uint32_t f : b.topology.triangle_edges[in_b]) features.edges.emplace_back(e, f);
    }
  }
  base::sort_unique(features.vertex_face);
  base::sort_unique(features.face_vertex);
  base::sort_unique(features.edges);
  return features;
}

/// These are the nearest two points so far, in the frame of b; of equally near ones the first.
struct NearestPoints {
  double distance_squared = std::numeric_limits<double>::infinity();
  DVec3 offset = {};  ///< Offset from a to b.

  void take(double squared, DVec3 from_a_to_b) {
    if (!(squared < distance_squared)) return;
    distance_squared = squared;
    offset = from_a_to_b;
  }
};

NearestPoints nearest_of(const ContactMesh& a, std::span<const DVec3> a_positions, const ContactMesh& b,
                         const Features& features) {
  NearestPoints nearest;
  const geometry::MeshView view_a = {a_positions, a.triangles};
  for (const auto& [v, t] : features.vertex_face) {
    const auto [p, q, r] = b.view().corners(t);
    const auto place = geometry::closest_on_triangle(a_positions[v], p, q, r);
    nearest.take(place.distance_squared, place.point - a_positions[v]);
  }
  for (const auto& [t, v] : features.face_vertex) {
    const auto [p, q, r] = view_a.corners(t);
    const auto place = geometry::closest_on_triangle(b.positions[v], p, q, r);
    nearest.take(place.distance_squared, b.positions[v] - place.point);
  }
  for (const auto& [e, f] : features.edges) {
    const auto& of_a = a.topology.edges[e];
    const auto& of_b = b.topology.edges[f];
    const auto pair = geometry::closest_between_segments<double>(
        {a_positions[of_a[0]], a_positions[of_a[1]]}, {b.positions[of_b[0]], b.positions[of_b[1]]});
    nearest.take(pair.distance_squared, pair.point_b - pair.point_a);
  }
  return nearest;
}

NearestPoints nearest_by_tree(const ContactMesh& a, std::span<const DVec3> a_positions,
                              const RigidPose& a_in_b, const ContactMesh& b, double reach) {
  const RigidPose b_in_a = relative_pose({}, a_in_b);
  Pairs triangles;
  for (double margin = kFirstMargin * (a.size + b.size);; margin *= kGrowth) {
    const double held = std::min(margin, reach);
    triangles.clear();
    geometry::find_candidates(a.tree, b.tree, b_in_a, held, triangles);
    const NearestPoints nearest = nearest_of(a, a_positions, b, features_of(a, b, triangles));
    const bool holds_it = nearest.distance_squared <= held * held;
    if (holds_it || !(margin < reach)) return nearest;
  }
}

}  // namespace

MeshGap find_mesh_gap(const ContactMesh& a, const RigidPose& pose_a, const ContactMesh& b,
                      const RigidPose& pose_b, double reach, Search search) {
  std::vector<MeshContact> contacts;
  find_mesh_contacts(a, pose_a, b, pose_b, {0, search}, contacts);
  if (!contacts.empty()) {
    const auto deepest =
        std::max_element(contacts.begin(), contacts.end(),
                         [](const MeshContact& x, const MeshContact& y) { return x.depth < y.depth; });
    return {-deepest->depth, deepest->normal};
  }
  const MeshGap nothing = {.distance = reach};
  const RigidPose a_in_b = relative_pose(pose_a, pose_b);
  const DVec3 apart = a_in_b.position;
  if (a.triangles.empty() || b.triangles.empty() || !(length(apart) < reach + 2 * (a.size + b.size)))
    return nothing;
  std::vector<DVec3> a_positions;
  a_positions.reserve(a.positions.size());
  for (const DVec3& p : a.positions) a_positions.push_back(to_world(a_in_b, p));
  const NearestPoints nearest = search == Search::kAll ? nearest_of(a, a_positions, b, all_features(a, b))
                                                       : nearest_by_tree(a, a_positions, a_in_b, b, reach);
  const double distance = std::sqrt(nearest.distance_squared);
  if (!(distance < reach)) return nothing;
  return {distance, normalize(rotate(pose_b.rotation, nearest.offset))};
}

}  // namespace hooke::collision
