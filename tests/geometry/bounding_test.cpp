#include "geometry/mesh/bounding.h"

#include "geometry/mesh/preselection.h"
#include "geometry/mesh/volume_tree.h"
#include "geometry/meshes.h"
#include "math/random.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <map>
#include <string>
#include <vector>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Quaternion;
using hooke::Real;
using hooke::geometry::BoundingSphere;
using hooke::geometry::box_along;
using hooke::geometry::build_volume_tree;
using hooke::geometry::DBox;
using hooke::geometry::find_candidates;
using hooke::geometry::MeshView;
using hooke::geometry::minimum_sphere;
using hooke::geometry::OrientedBox;
using hooke::geometry::RigidPose;
using hooke::geometry::tight_box;
using hooke::geometry::TrianglePair;
using hooke::geometry::triangles_overlap;
using hooke::geometry::vertex_sphere;
using hooke::geometry::VolumeTree;
using hooke::test::random_vector;

namespace {

using Points = std::vector<DVec3>;

Points points_of(const MeshDesc& mesh) {
  Points points;
  for (const auto& p : mesh.positions) points.push_back(hooke::vector_cast<double>(p));
  return points;
}

Points moved(const Points& points, const RigidPose& pose) {
  Points result;
  for (const DVec3& p : points) result.push_back(to_world(pose, p));
  return result;
}

RigidPose random_pose(std::mt19937_64& random, double reach) {
  const DVec3 q = random_vector(random);
  const double w = hooke::test::signed_unit(random);
  return {reach * random_vector(random), normalize(Quaternion<double>{q.x, q.y, q.z, w})};
}

double reach_of(const BoundingSphere& sphere, const Points& points) {
  double farthest = 0;
  for (const DVec3& p : points) farthest = std::max(farthest, length(p - sphere.center));
  return farthest;
}

bool holds_all(const BoundingSphere& sphere, const Points& points) {
  return reach_of(sphere, points) <= sphere.radius * (1 + 1e-12);
}
bool holds_all(const OrientedBox& box, const Points& points) {
  return std::all_of(points.begin(), points.end(), [&](DVec3 p) {
    return distance_squared(box, p) <= 1e-20 * length_squared(box.half_extents);
  });
}

/// Pairs of triangles that overlap, by all pairs.
std::vector<TrianglePair> true_pairs(const MeshView& a, const MeshView& b, const RigidPose& b_in_a) {
  const Points in_a = moved({b.positions.begin(), b.positions.end()}, b_in_a);
  const MeshView placed = {in_a, b.triangles};
  std::vector<TrianglePair> pairs;
  for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
    for (std::uint32_t k = 0; k < b.triangles.size(); ++k) {
      if (triangles_overlap(a.corners(i), placed.corners(k))) pairs.emplace_back(i, k);
    }
  }
  return pairs;
}

template <class Volume>
std::size_t check_candidates(const MeshView& a, const MeshView& b, const RigidPose& b_in_a) {
  std::vector<TrianglePair> found;
  const auto tree_a = build_volume_tree<Volume>(a);
  const auto tree_b = build_volume_tree<Volume>(b);
  CHECK(find_candidates(tree_a, tree_b, b_in_a, 0, found) > 0);
  std::sort(found.begin(), found.end());
  CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
  const std::vector<TrianglePair> expected = true_pairs(a, b, b_in_a);
  CHECK(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
  return found.size();
}

template <class Volume>
void check_tree(const VolumeTree<Volume>& tree, const MeshView& mesh) {
  std::vector<std::uint32_t> order = tree.order;
  std::sort(order.begin(), order.end());
  for (std::uint32_t t = 0; t < order.size(); ++t) REQUIRE(order[t] == t);
  REQUIRE(tree.nodes[0].count == mesh.triangles.size());
  REQUIRE(tree.nodes[0].next == tree.nodes.size());
  for (const auto& node : tree.nodes) {
    for (std::uint32_t i = 0; i < node.count; ++i) {
      for (const DVec3& p : mesh.corners(tree.order[node.first + i])) {
        if constexpr (std::is_same_v<Volume, DBox>) {
          REQUIRE(contains(node.volume, DBox{p, p}));
        } else {
          REQUIRE(distance_squared(node.volume, p) < 1e-20);
        }
      }
    }
  }
}

}  // namespace

TEST_SUITE("geometry/bounding") {
  TEST_CASE("the smallest spheres of known shapes") {
    const auto sphere_of = [](const Points& points) { return minimum_sphere(points); };
    CHECK(sphere_of(points_of(hooke::test::make_cube(1))).radius == doctest::Approx(std::sqrt(3.0)));
    CHECK(sphere_of({{1, 2, 3}}).radius == 0);
    CHECK(sphere_of({{1, 2, 3}, {1, 2, 3}}).center == DVec3{1, 2, 3});
    CHECK(sphere_of({{-1, 0, 0}, {3, 0, 0}}).center == DVec3{1, 0, 0});
    CHECK(sphere_of({}).radius < 0);
    // A regular triangle of side 1: 1 / sqrt(3). An obtuse one: half the longest side.
    CHECK(sphere_of({{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}}).radius ==
          doctest::Approx(1 / std::sqrt(3.0)));
    CHECK(sphere_of({{-2, 0, 0}, {2, 0, 0}, {0, 0.5, 0}}).radius == doctest::Approx(2));
    // A regular tetrahedron of side sqrt(8): sqrt(3).
    CHECK(sphere_of({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}).radius ==
          doctest::Approx(std::sqrt(3.0)));
    CHECK(sphere_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}}).radius == doctest::Approx(2.5));
  }

  TEST_CASE("no sphere through two, three or four points is smaller and holds all") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 60; ++i) {
      Points points;
      for (int k = 0; k < 12; ++k) {
        DVec3 p = random_vector(random);
        if (i % 3 == 1) p = {std::round(2 * p.x), std::round(2 * p.y), std::round(2 * p.z)};
        if (i % 3 == 2) p.z = 0;
        points.push_back(p);
      }
      const BoundingSphere sphere = minimum_sphere(points);
      REQUIRE(holds_all(sphere, points));
      // It is the smallest if its center is in the hull of the points on it: no direction leads away from
      // all.
      for (int k = 0; k < 200; ++k) {
        const DVec3 aside = 1e-4 * random_vector(random);
        REQUIRE(reach_of({sphere.center + aside, 0}, points) >= sphere.radius * (1 - 1e-9));
      }
    }
  }

  TEST_CASE("the paper's sphere holds all and may be larger, never by more than twice") {
    std::mt19937_64 random(2);
    Points points = points_of(hooke::test::make_cube(1));
    CHECK(vertex_sphere(points).radius == doctest::Approx(std::sqrt(3.0)));
    for (int i = 0; i < 100; ++i) points.push_back({3 + 0.01 * hooke::test::signed_unit(random), 0, 0});
    const BoundingSphere paper = vertex_sphere(points);
    const BoundingSphere least = minimum_sphere(points);
    CHECK(holds_all(paper, points));
    CHECK(paper.radius > 1.5 * least.radius);
    CHECK(paper.radius <= 2 * least.radius);
    CHECK(vertex_sphere({}).radius < 0);
  }

  TEST_CASE("a turned box is found again") {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20; ++i) {
      const Points corners = points_of(hooke::test::make_box({1, 2, Real(0.25)}));
      const Points points = moved(corners, random_pose(random, 3));
      const OrientedBox box = tight_box(points);
      CHECK(holds_all(box, points));
      CHECK(volume_of(box) == doctest::Approx(4).epsilon(1e-4));
    }
  }

  TEST_CASE("tight boxes hold all, are no larger than along any axes tried, and total") {
    std::mt19937_64 random(4);
    const Points ring = points_of(hooke::test::make_torus(1, Real(0.3), 16, 8));
    for (int i = 0; i < 5; ++i) {
      const Points points = moved(ring, random_pose(random, 2));
      const OrientedBox box = tight_box(points);
      CHECK(holds_all(box, points));
      CHECK(volume_of(box) < 2.6 * 2.6 * 0.6 * 1.0001);
      for (int k = 0; k < 300; ++k) {
        const auto axes = matrix_of(random_pose(random, 1).rotation);
        REQUIRE(volume_of(box_along(axes, points)) > volume_of(box) * (1 - 1e-6));
      }
    }
    CHECK(volume_of(tight_box({})) == 0);
    CHECK(volume_of(tight_box(Points{{1, 2, 3}})) == 0);
    CHECK(volume_of(tight_box(Points{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}})) < 1e-12);
    CHECK(volume_of(tight_box(Points{{0, 0, 0}, {1, 0, 1}, {0, 1, 0}})) < 1e-12);
  }

  TEST_CASE("volumes") {
    CHECK(volume_of(BoundingSphere{{}, 3}) == doctest::Approx(36 * std::acos(-1.0)));
    CHECK(volume_of(BoundingSphere{}) == 0);
    CHECK(volume_of(DBox{{0, 0, 0}, {1, 2, 3}}) == 6);
    CHECK(volume_of(DBox{}) == 0);
    CHECK(volume_of(OrientedBox{.half_extents = {1, 2, 3}}) == 48);
  }

  TEST_CASE("boxes that touch, cross at edges, or are apart by any of the kinds of axes") {
    const OrientedBox unit = {.half_extents = {1, 1, 1}};
    const double turn = std::acos(-1.0) / 4;
    const auto about = [&](DVec3 axis) { return hooke::quaternion_about(axis, turn); };
    CHECK(may_overlap(unit, unit, {{2, 0, 0}, {}}, 0));
    CHECK_FALSE(may_overlap(unit, unit, {{2.001, 0, 0}, {}}, 0));
    CHECK(may_overlap(unit, unit, {{2.001, 0, 0}, {}}, 0.002));
    // On its edge it reaches sqrt(2).
    CHECK(may_overlap(unit, unit, {{2.41, 0, 0}, about({0, 0, 1})}, 0));
    CHECK_FALSE(may_overlap(unit, unit, {{2.42, 0, 0}, about({0, 0, 1})}, 0));
    // Edge against edge: no face separates them, the axis across both edges does.
    OrientedBox on_edge = unit;
    on_edge.axes = matrix_of(about({0, 1, 0}));
    CHECK(may_overlap(on_edge, unit, {{2.82, 0, 0}, about({0, 0, 1})}, 0));
    CHECK_FALSE(may_overlap(on_edge, unit, {{2.84, 0, 0}, about({0, 0, 1})}, 0));
    CHECK_FALSE(may_overlap(unit, OrientedBox{}, {}, 0));
    CHECK_FALSE(may_overlap(DBox{}, DBox{{0, 0, 0}, {1, 1, 1}}, {}, 0));
    CHECK_FALSE(may_overlap(BoundingSphere{}, BoundingSphere{{}, 1}, {}, 0));
    CHECK(may_overlap(BoundingSphere{{}, 1}, BoundingSphere{{}, 1}, {{0, 2, 0}, {}}, 0));
    CHECK_FALSE(may_overlap(BoundingSphere{{}, 1}, BoundingSphere{{}, 1}, {{0, 2.001, 0}, {}}, 0));
    const DBox box = {{-1, -1, -1}, {1, 1, 1}};
    CHECK(may_overlap(box, box, {{2.41, 0, 0}, about({0, 0, 1})}, 0));
    CHECK_FALSE(may_overlap(box, box, {{2.42, 0, 0}, about({0, 0, 1})}, 0));
  }

  TEST_CASE("every node of every tree holds its triangles, also after the vertices moved") {
    const MeshDesc torus = hooke::test::make_torus(1, Real(0.3), 12, 7);
    Points points = points_of(torus);
    const MeshView mesh = {points, torus.triangles};
    auto spheres = build_volume_tree<BoundingSphere>(mesh);
    auto boxes = build_volume_tree<DBox>(mesh);
    auto oriented = build_volume_tree<OrientedBox>(mesh);
    check_tree(spheres, mesh);
    check_tree(boxes, mesh);
    check_tree(oriented, mesh);
    for (DVec3& p : points) p = {2 * p.x + 0.3 * p.y, p.y - 0.5 * p.x * p.x, 0.5 * p.z};
    refit(spheres, mesh);
    refit(boxes, mesh);
    refit(oriented, mesh);
    check_tree(spheres, mesh);
    check_tree(boxes, mesh);
    check_tree(oriented, mesh);
    CHECK(build_volume_tree<DBox>(MeshView{}).nodes.empty());
  }

  TEST_CASE("no tree loses a pair of triangles that overlap; tighter volumes leave fewer candidates") {
    std::mt19937_64 random(6);
    const MeshDesc torus = hooke::test::make_torus(1, Real(0.25), 20, 10);
    const MeshDesc ball = hooke::test::make_sphere(3);
    const Points torus_points = points_of(torus);
    const Points ball_points = points_of(ball);
    const MeshView a = {torus_points, torus.triangles};
    const MeshView b = {ball_points, ball.triangles};
    std::size_t by_spheres = 0;
    std::size_t by_boxes = 0;
    std::size_t by_oriented = 0;
    for (int i = 0; i < 6; ++i) {
      const RigidPose pose = random_pose(random, 1);
      by_spheres += check_candidates<BoundingSphere>(a, b, pose);
      by_boxes += check_candidates<DBox>(a, b, pose);
      by_oriented += check_candidates<OrientedBox>(a, b, pose);
    }
    CHECK(by_oriented < by_boxes);
    CHECK(by_oriented < by_spheres);
  }

  TEST_CASE("every preselection leaves all pairs that overlap; the paper's sphere more than any other") {
    std::mt19937_64 random(7);
    using hooke::Preselection;
    for (const MeshDesc& mesh :
         {hooke::test::make_torus(1, Real(0.2), 12, 8), hooke::test::make_box({4, Real(0.1), Real(0.1)})}) {
      const Points points = points_of(mesh);
      const MeshView view = {points, mesh.triangles};
      const auto volumes = make_bounding_volumes(view);
      std::map<Preselection, std::uint64_t> left;
      for (int i = 0; i < 40; ++i) {
        const RigidPose pose_a = random_pose(random, 1);
        const RigidPose pose_b = random_pose(random, 3);
        const std::size_t overlapping = true_pairs(view, view, relative_pose(pose_b, pose_a)).size();
        for (const Preselection p : hooke::kPreselections) {
          const auto count = count_candidates(p, volumes, pose_a, volumes, pose_b);
          REQUIRE(count.pairs_left >= overlapping);
          left[p] += count.pairs_left;
        }
        const hooke::geometry::DBox box = world_box(volumes, pose_b);
        REQUIRE(distance_squared(box, to_world(pose_b, points[0])) == 0);
      }
      CHECK(left[Preselection::kAllPairs] == 40 * mesh.triangles.size() * mesh.triangles.size());
      CHECK(left[Preselection::kVertexSphere] >= left[Preselection::kSphere]);
      CHECK(left[Preselection::kSphere] > left[Preselection::kOrientedBox]);
      CHECK(left[Preselection::kOrientedBox] > left[Preselection::kOrientedBoxTree]);
      CHECK(left[Preselection::kBox] > left[Preselection::kBoxTree]);
      CHECK(left[Preselection::kBoxTree] >= left[Preselection::kOrientedBoxTree]);
    }
    CHECK(std::string(name_of(Preselection::kOrientedBoxTree)) == "oriented_box_tree");
  }
}
