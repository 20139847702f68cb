#include "lab/shape/opposing_faces.h"

#include "geometry/meshes.h"
#include "math/random.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

using hooke::DVec3;
using hooke::Real;
using hooke::collision::find_opposing_faces;
using hooke::collision::OpposingFaces;
using hooke::geometry::ContactMesh;
using hooke::geometry::RigidPose;
using hooke::geometry::TrianglePair;

namespace {

ContactMesh solid(const hooke::MeshDesc& mesh) {
  return hooke::geometry::make_contact_mesh(mesh).value();
}

OpposingFaces faces_of(const ContactMesh& a, const ContactMesh& b, const RigidPose& pose_b, int k) {
  OpposingFaces result;
  find_opposing_faces(a, {}, b, pose_b, k, result);
  return result;
}

/// Pairs that overlap, by all pairs, in order.
std::vector<TrianglePair> all_pairs(const ContactMesh& a, const ContactMesh& b, const RigidPose& pose_b) {
  std::vector<DVec3> moved;
  for (const DVec3& p : a.positions) moved.push_back(to_local(pose_b, p));
  const hooke::geometry::MeshView view = {moved, a.triangles};
  std::vector<TrianglePair> pairs;
  for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
    for (std::uint32_t n = 0; n < b.triangles.size(); ++n) {
      if (hooke::geometry::triangles_overlap(view.corners(i), b.view().corners(n))) pairs.emplace_back(i, n);
    }
  }
  return pairs;
}

}  // namespace

TEST_SUITE("collision/opposing_faces") {
  TEST_CASE("with all faces it is brute force") {
    std::mt19937_64 random(1);
    const ContactMesh torus = solid(hooke::test::make_torus(1, Real(0.3), 10, 6));
    const ContactMesh ball = solid(hooke::test::make_sphere(1));
    int overlapping = 0;
    for (int i = 0; i < 20; ++i) {
      const double x = hooke::test::signed_unit(random);
      const RigidPose pose = {{1.2 * x, hooke::test::signed_unit(random), 0.3}, {}};
      OpposingFaces found = faces_of(torus, ball, pose, 1000);
      std::sort(found.overlapping.begin(), found.overlapping.end());
      CHECK(found.overlapping == all_pairs(torus, ball, pose));
      CHECK(found.pairs_tested == torus.triangles.size() * ball.triangles.size());
      overlapping += found.overlapping.empty() ? 0 : 1;
    }
    CHECK(overlapping > 5);
  }

  TEST_CASE("the steps one by one, on two balls that touch along x") {
    const ContactMesh ball = solid(hooke::test::make_sphere(3));  // has a vertex at +x and at -x
    // 0: apart by their spheres.
    CHECK(faces_of(ball, ball, {{2.1, 0, 0}, {}}, 4).last_step == 0);
    // 1 and 3: the faces around both vertices, four each.
    const OpposingFaces found = faces_of(ball, ball, {{1.999, 0, 0}, {}}, 4);
    REQUIRE(found.faces_a.size() == 4);
    for (const std::uint32_t t : found.faces_a) {
      const auto corners = ball.view().corners(t);
      CHECK(std::any_of(corners.begin(), corners.end(), [](DVec3 p) { return p.x == 1; }));
    }
    for (const std::uint32_t t : found.faces_b) {
      const auto corners = ball.view().corners(t);
      CHECK(std::any_of(corners.begin(), corners.end(), [](DVec3 p) { return p.x == -1; }));
    }
    // 7: of the 16 pairs those that overlap, as by all pairs.
    CHECK(found.last_step == 7);
    CHECK(found.pairs_tested == 16);
    CHECK(found.overlapping.size() == all_pairs(ball, ball, {{1.999, 0, 0}, {}}).size());
    // 5: far faces chosen, since the center of a ring's sphere is in its hole.
    const ContactMesh ring = solid(hooke::test::make_torus(2, Real(0.1), 40, 6));
    const OpposingFaces missed = faces_of(ring, ball, {{1.2, 0, 0}, {}}, 1);
    CHECK(missed.faces_a.size() == 1);
  }

  TEST_CASE("it never says that solids overlap which do not, and misses some on large faces") {
    std::mt19937_64 random(2);
    const ContactMesh plate = solid(hooke::test::make_box({5, Real(0.1), 5}));
    const ContactMesh ball = solid(hooke::test::make_sphere(2));
    int touching = 0;
    int found = 0;
    for (int i = 0; i < 100; ++i) {
      const double x = 4 * hooke::test::signed_unit(random);
      const RigidPose pose = {{x, 1.05, 4 * hooke::test::signed_unit(random)}, {}};
      touching += all_pairs(plate, ball, pose).empty() ? 0 : 1;
      found += faces_of(plate, ball, pose, 4).overlapping.empty() ? 0 : 1;
    }
    CHECK(touching == 100);
    CHECK(found > 0);
    CHECK(found < 50);
    CHECK(faces_of(plate, ball, {{0, 1.2, 0}, {}}, 8).overlapping.empty());
  }

  TEST_CASE("any k and any pose") {
    const ContactMesh cube = solid(hooke::test::make_cube(1));
    CHECK(faces_of(cube, cube, {{1.5, 0, 0}, {}}, -3).faces_a.size() == 1);
    CHECK(faces_of(cube, cube, {{1.5, 0, 0}, {}}, 0).pairs_tested <= 1);
    CHECK(faces_of(cube, cube, {{1.5, 0, 0}, {}}, 1 << 30).faces_b.size() == 12);
    CHECK(faces_of(cube, cube, {{std::nan(""), 0, 0}, {}}, 4).last_step == 0);
    CHECK(faces_of(cube, cube, {{0, 0, 0}, {INFINITY, 0, 0, 1}}, 4).overlapping.empty());
  }
}
