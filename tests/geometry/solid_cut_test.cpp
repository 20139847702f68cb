#include "geometry/solid/solid_cut.h"

#include "geometry/convex/convex_hull.h"
#include "geometry/convex/mass_properties.h"
#include "geometry/meshes.h"

#include <algorithm>
#include <doctest/doctest.h>

using hooke::DVec3;
using hooke::Real;
using hooke::Vec3;
using hooke::geometry::contains;
using hooke::geometry::Corners;
using hooke::geometry::SolidPiece;

namespace {

constexpr double kOnPlane = 1e-6;

SolidPiece whole(const hooke::MeshDesc& mesh) {
  SolidPiece piece;
  for (const auto& t : mesh.triangles) {
    piece.surface.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  }
  return piece;
}

double hull_volume(const SolidPiece& piece) {
  std::vector<Vec3> points = piece.corners;
  for (const Corners& t : piece.surface) points.insert(points.end(), t.begin(), t.end());
  const auto hull = hooke::geometry::make_convex_hull(points);
  REQUIRE(hull.has_value());
  return hooke::geometry::mass_of(hull.value()).volume;
}

double area_of(const SolidPiece& piece) {
  double area = 0;
  for (const auto& [a, b, c] : piece.surface) area += 0.5 * double(length(cross(b - a, c - a)));
  return area;
}

}  // namespace

TEST_SUITE("geometry/solid_cut") {
  TEST_CASE("a cut cube is two boxes without lids") {
    const SolidPiece cube = whole(hooke::test::make_cube(1));
    const auto halves = cut(cube, cube.surface, {{1, 0, 0}, 0.5}, kOnPlane);
    CHECK(hull_volume(halves.below) == doctest::Approx(6));
    CHECK(hull_volume(halves.above) == doctest::Approx(2));
    CHECK(area_of(halves.below) == doctest::Approx(4 + 4 * 3));
    CHECK(area_of(halves.above) == doctest::Approx(4 + 4 * 1));
    CHECK(halves.cut_length == doctest::Approx(8));
    CHECK(halves.below.corners.empty());
  }

  TEST_CASE("a plane beside the solid leaves everything on one side, a face on it too") {
    const SolidPiece cube = whole(hooke::test::make_cube(1));
    for (const double offset : {1.0, 1.0 + 1e-7, 2.0}) {
      const auto halves = cut(cube, cube.surface, {{1, 0, 0}, offset}, kOnPlane);
      CHECK(halves.below.surface.size() == 12);
      CHECK(halves.above.surface.empty());
      const auto turned = cut(cube, cube.surface, {{-1, 0, 0}, -offset}, kOnPlane);
      CHECK(turned.above.surface.size() == 12);
      CHECK(turned.below.surface.empty());
    }
  }

  TEST_CASE("three cuts leave an eighth, with the corner that lies inside the solid") {
    SolidPiece piece = whole(hooke::test::make_cube(1));
    const std::vector<Corners> solid = piece.surface;
    for (const DVec3 normal : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}}) {
      piece = cut(piece, solid, {normal, 0}, kOnPlane).above;
    }
    REQUIRE(piece.corners.size() == 1);
    CHECK(length(piece.corners[0]) < Real(1e-6));
    CHECK(hull_volume(piece) == doctest::Approx(1));
    // A fourth cut takes the corner away and makes three.
    const auto halves = cut(piece, solid, {{0.6, 0.8, 0}, 0.5}, kOnPlane);
    CHECK(halves.below.corners.size() == 3);
    CHECK(halves.above.corners.size() == 2);
    CHECK(hull_volume(halves.below) + hull_volume(halves.above) == doctest::Approx(1));
  }

  TEST_CASE("where planes meet outside the solid there is no corner") {
    // Two balls; the planes meet between them.
    SolidPiece piece = whole(hooke::test::make_sphere(2));
    const std::size_t count = piece.surface.size();
    for (std::size_t i = 0; i < count; ++i) {
      Corners shifted = piece.surface[i];
      for (Vec3& p : shifted) p.x += 4;
      piece.surface.push_back(shifted);
    }
    const std::vector<Corners> solid = piece.surface;
    for (const hooke::Plane& plane : {hooke::Plane{{1, 0, 0}, 2}, {{0, 1, 0}, 0}, {{0, 0, 1}, 0}}) {
      piece = cut(piece, solid, plane, kOnPlane).below;
    }
    CHECK(piece.corners.empty());
  }

  TEST_CASE("a point is in a solid or not") {
    const auto surface = whole(hooke::test::make_sphere(2)).surface;
    CHECK(contains(surface, {0, 0, 0}));
    CHECK(contains(surface, {0.5, -0.5, 0.5}));
    CHECK(contains(surface, {0.9, 0, 0}));
    CHECK_FALSE(contains(surface, {1.1, 0, 0}));
    CHECK_FALSE(contains(surface, {0.7, 0.7, 0.7}));
    CHECK_FALSE(contains(surface, {100, 0, 0}));
    CHECK_FALSE(contains({}, {0, 0, 0}));
  }
}
