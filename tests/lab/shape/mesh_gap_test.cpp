#include "lab/shape/mesh_gap.h"

#include "geometry/meshes.h"
#include "math/random.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <numbers>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Real;
using hooke::collision::find_mesh_gap;
using hooke::collision::MeshGap;
using hooke::geometry::ContactMesh;
using hooke::geometry::RigidPose;
using hooke::geometry::Search;
using hooke::test::random_vector;

namespace {

constexpr double kReach = 10;

ContactMesh solid(const MeshDesc& mesh) {
  auto result = hooke::geometry::make_contact_mesh(mesh);
  REQUIRE(result.has_value());
  return std::move(result).value();
}

ContactMesh cube() {
  return solid(hooke::test::make_box({Real(0.5), Real(0.5), Real(0.5)}));
}

hooke::Quaternion<double> turn(DVec3 axis, double angle) {
  const DVec3 v = std::sin(angle / 2) * normalize(axis);
  return {v.x, v.y, v.z, std::cos(angle / 2)};
}

/// By the tree, after comparing with all pairs.
MeshGap gap_of(const ContactMesh& a, const RigidPose& pose_a, const ContactMesh& b, const RigidPose& pose_b,
               double reach = kReach) {
  const MeshGap by_tree = find_mesh_gap(a, pose_a, b, pose_b, reach, Search::kTree);
  const MeshGap by_all = find_mesh_gap(a, pose_a, b, pose_b, reach, Search::kAll);
  REQUIRE(by_tree.distance == by_all.distance);
  REQUIRE(by_tree.normal == by_all.normal);
  return by_tree;
}

}  // namespace

TEST_SUITE("collision/mesh_gap") {
  TEST_CASE("cubes are apart by the way between their faces, edges and corners") {
    const ContactMesh a = cube();
    const ContactMesh b = cube();
    const RigidPose still;
    MeshGap gap = gap_of(a, still, b, {{0.25, 1.75, 0}, {}});
    CHECK(gap.distance == doctest::Approx(0.75).epsilon(1e-15));
    CHECK(length(gap.normal - DVec3{0, 1, 0}) < 1e-14);
    gap = gap_of(a, still, b, {{2, 3, 0}, {}});  // an edge over an edge
    CHECK(gap.distance == doctest::Approx(std::hypot(1, 2)).epsilon(1e-14));
    gap = gap_of(a, still, b, {{2, 3, 4}, {}});  // corners
    CHECK(gap.distance == doctest::Approx(std::sqrt(1 + 4 + 9)).epsilon(1e-14));
    CHECK(length(gap.normal - normalize(DVec3{1, 2, 3})) < 1e-14);
    // Two crossed edges, each half of the diagonal of a face from its middle.
    const double quarter = std::numbers::pi / 4;
    gap = gap_of(a, {{}, turn({1, 0, 0}, quarter)}, b, {{0, 2, 0}, turn({0, 0, 1}, quarter)});
    CHECK(gap.distance == doctest::Approx(2 - std::sqrt(2.0)).epsilon(1e-14));
  }

  TEST_CASE("where solids overlap it is minus their depth, beyond its reach it is the reach") {
    const ContactMesh a = cube();
    const ContactMesh b = cube();
    CHECK(gap_of(a, {}, b, {{0.125, 0.96875, 0.0625}, {}}).distance == doctest::Approx(-0.03125));
    CHECK(gap_of(a, {}, b, {{0.125, 1, 0.0625}, {}}).distance == doctest::Approx(0));
    CHECK(gap_of(a, {}, b, {{0, 3, 0}, {}}, 1.5).distance == 1.5);
    CHECK(gap_of(a, {}, b, {{0, 3, 0}, {}}, 2.5).distance == doctest::Approx(2));
    CHECK(gap_of(a, {}, b, {{0, 1e9, 0}, {}}).distance == kReach);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(gap_of(a, {}, b, {{0, nan, 0}, {}}).distance == kReach);
    CHECK(gap_of(a, {}, b, {{0, 3, 0}, {nan, 0, 0, 1}}).distance == kReach);
    const ContactMesh nothing;
    CHECK(gap_of(a, {}, nothing, {}).distance == kReach);
  }

  TEST_CASE("a bar through the hole of a ring is as far from it as the hole is wide") {
    // The wall of the hole is 64 flat pieces; a corner of the bar is nearest to the one across its direction.
    const double kPiece = 2 * std::numbers::pi / 64;
    const ContactMesh ring = solid(hooke::test::make_torus(1, Real(0.25), 64, 16));
    const ContactMesh bar = solid(hooke::test::make_box({Real(0.125), Real(2), Real(0.125)}));
    const MeshGap gap = gap_of(ring, {}, bar, {{0.25, 0, 0}, {}});
    const double middle = 3.5 * kPiece;
    const double expected =
        0.75 * std::cos(kPiece / 2) - std::hypot(0.375, 0.125) * std::cos(middle - std::atan(1.0 / 3));
    CHECK(gap.distance == doctest::Approx(expected).epsilon(1e-6));  // the ring is in float
    CHECK(gap.normal.x == doctest::Approx(-std::cos(middle)).epsilon(1e-6));
  }

  TEST_CASE("both searches give the same bits in any poses, and seen from either side") {
    std::mt19937_64 random(5);
    const ContactMesh ring = solid(hooke::test::make_torus(1, Real(0.25), 12, 6));
    const ContactMesh ell = solid(hooke::test::make_ell(Real(0.5)));
    int apart = 0;
    int into = 0;
    for (int i = 0; i < 200; ++i) {
      const auto pose = [&]() -> RigidPose {
        const DVec3 q = random_vector(random);
        const double w = hooke::test::signed_unit(random);
        return {2.0 * random_vector(random), normalize(hooke::Quaternion<double>{q.x, q.y, q.z, w})};
      };
      const RigidPose p = pose();
      const RigidPose q = pose();
      const MeshGap gap = gap_of(ring, p, ell, q);
      const MeshGap other = gap_of(ell, q, ring, p);
      (gap.distance > 0 ? apart : into) += 1;
      if (!(gap.distance > 0)) continue;
      CHECK(other.distance == doctest::Approx(gap.distance).epsilon(1e-12));
      // Moved together by all of it they touch.
      const RigidPose nearer = {q.position - gap.distance * gap.normal, q.rotation};
      CHECK(std::fabs(gap_of(ring, p, ell, nearer).distance) < 1e-9);
    }
    CHECK(apart > 50);
    CHECK(into > 20);
  }
}
