#include "geometry/bsp/bsp_space.h"

#include <cmath>
#include <doctest/doctest.h>

using hooke::DVec3;
using hooke::geometry::BspPiece;
using hooke::geometry::BspSpace;
using hooke::geometry::BspSplit;
using hooke::geometry::kLatticeHalf;
using hooke::geometry::LatticePoint;

namespace {

constexpr std::int64_t kFar = kLatticeHalf;

BspPiece make_right_triangle(BspSpace& space) {
  return space.add_triangle({LatticePoint{0, 0, 0}, {6, 0, 0}, {0, 6, 0}}, 7);
}

}  // namespace

TEST_SUITE("geometry/bsp_space") {
  TEST_CASE("planes that are the same have one number, whatever points they come from") {
    BspSpace space;
    const auto up = space.add_plane({0, 0, 5}, {0, 0, 12});
    const auto down = space.add_plane({100, -3, 5}, {0, 0, -2});
    CHECK(up.plane == down.plane);
    CHECK_FALSE(up.is_flipped);
    CHECK(down.is_flipped);
    CHECK(space.add_plane({0, 0, 6}, {0, 0, 1}).plane != up.plane);
    CHECK(space.plane(up.plane).normal == DVec3{0, 0, 1});
    CHECK(space.plane(up.plane).offset == -5);
  }

  TEST_CASE("three planes meet in the point that elimination gives") {
    BspSpace space;
    // x + y + z = 6, x - y = 0, y - 2 z = -1: x = y = 2.2, z = 1.6.
    const auto a = space.add_plane({6, 0, 0}, {1, 1, 1}).plane;
    const auto b = space.add_plane({0, 0, 0}, {1, -1, 0}).plane;
    const auto c = space.add_plane({0, -1, 0}, {0, 1, -2}).plane;
    const DVec3 p = space.point(space.add_intersection(a, b, c)).place;
    CHECK(p.x == doctest::Approx(2.2).epsilon(1e-15));
    CHECK(p.y == doctest::Approx(2.2).epsilon(1e-15));
    CHECK(p.z == doctest::Approx(1.6).epsilon(1e-15));
  }

  TEST_CASE("signs that doubles cannot tell are exact") {
    BspSpace space;
    // Two planes through far corners whose normals differ in the last bit, and a point of both.
    const auto a = space.add_plane({0, 0, 0}, {kFar, kFar - 1, 0}).plane;
    const auto b = space.add_plane({0, 0, 0}, {kFar - 1, kFar - 2, 0}).plane;
    const auto z = space.add_plane({0, 0, 0}, {0, 0, 1}).plane;
    const auto x = space.add_plane({kFar - 1, 0, 0}, {1, 0, 0}).plane;
    const auto on_a = space.add_intersection(a, z, x);  // y = -kFar: exactly a lattice point
    CHECK(space.point(on_a).place.y == static_cast<double>(-kFar));
    CHECK(space.side_of(a, on_a) == 0);
    // b there: (kFar - 1)^2 - (kFar - 2) kFar = 1, over a normal of 6e9.
    CHECK(space.side_of(b, on_a) == 1);
    const auto beyond = space.add_plane({0, -kFar, 0}, {0, 1, 0}).plane;
    CHECK(space.side_of(beyond, on_a) == 0);

    // x = 0 and y = -1 / (kFar - 1) is above a plane through (0, -1, 0) and below one through the origin.
    const auto tilted = space.add_plane({0, 0, 1}, {0, kFar - 1, 1}).plane;  // y (kFar - 1) + z = 1
    const auto zero = space.add_plane({0, 0, 0}, {1, 0, 0}).plane;
    const auto two = space.add_plane({0, 0, 2}, {0, 0, 1}).plane;
    const auto near = space.add_intersection(tilted, zero, two);
    const auto ground = space.add_plane({0, 0, 0}, {0, 1, 0}).plane;
    CHECK(std::fabs(space.point(near).place.y) < 1e-9);
    CHECK(space.side_of(ground, near) == -1);
  }

  TEST_CASE("the order of points is exact, and equal places are equal however they came about") {
    BspSpace space;
    const auto x = space.add_plane({1, 0, 0}, {3, 0, 0}).plane;
    const auto y = space.add_plane({0, 1, 0}, {0, 1, 0}).plane;
    const auto z = space.add_plane({0, 0, 1}, {0, 0, 1}).plane;
    const auto diagonal = space.add_plane({0, 0, 0}, {1, -1, 0}).plane;
    const auto other = space.add_plane({0, 0, 0}, {1, 0, -1}).plane;
    const auto p = space.add_intersection(x, y, z);
    const auto q = space.add_intersection(diagonal, other, y);
    CHECK(space.compare(p, q) == 0);
    // kFar (x - 1) + z = 0 at z = -1 is 1 / kFar beyond x = 1: 2^-32 steps, less than doubles are sure of.
    const auto almost = space.add_plane({1, 0, 0}, {kFar, 0, 1}).plane;
    const auto bottom = space.add_plane({0, 0, -1}, {0, 0, 1}).plane;
    const auto r = space.add_intersection(almost, y, bottom);
    const auto s = space.add_intersection(x, y, bottom);
    CHECK(space.compare(r, s) == 1);
    CHECK(space.compare(s, r) == -1);
    CHECK(space.compare(s, p) == -1);
  }

  TEST_CASE("a triangle is cut where the plane goes through it") {
    BspSpace space;
    const BspPiece piece = make_right_triangle(space);
    BspPiece above;
    BspPiece below;
    const auto cut = space.add_plane({2, 0, 0}, {1, 0, 0}).plane;
    REQUIRE(split(space, piece, cut, above, below) == BspSplit::kCut);
    CHECK(above.corners.size() == 3);
    CHECK(below.corners.size() == 4);
    CHECK(above.triangle == 7);
    double highest = 0;
    for (const auto& corner : above.corners) {
      const DVec3 p = space.point(corner.point).place;
      CHECK(p.x >= 2);
      highest = std::fmax(highest, p.y);
      // The edge from here lies in its plane: so does the next corner.
      CHECK(space.side_of(corner.edge_plane, corner.point) == 0);
    }
    CHECK(highest == doctest::Approx(4).epsilon(1e-15));
    for (std::size_t k = 0; k < below.corners.size(); ++k) {
      const auto& next = below.corners[(k + 1) % below.corners.size()];
      CHECK(space.side_of(below.corners[k].edge_plane, next.point) == 0);
    }
  }

  TEST_CASE("a plane through a corner cuts in two triangles, one along an edge not at all") {
    BspSpace space;
    const BspPiece piece = make_right_triangle(space);
    BspPiece above;
    BspPiece below;
    REQUIRE(split(space, piece, space.add_plane({0, 0, 0}, {1, -1, 0}).plane, above, below) ==
            BspSplit::kCut);
    CHECK(above.corners.size() == 3);
    CHECK(below.corners.size() == 3);
    CHECK(classify(space, piece, space.add_plane({0, 0, 0}, {1, 0, 0}).plane) == BspSplit::kAbove);
    CHECK(classify(space, piece, space.add_plane({6, 0, 0}, {1, 1, 0}).plane) == BspSplit::kBelow);
    CHECK(classify(space, piece, space.add_plane({9, 9, 0}, {0, 0, -1}).plane) == BspSplit::kOn);
    CHECK(classify(space, piece, space.add_plane({0, 0, 1}, {0, 0, 1}).plane) == BspSplit::kBelow);
  }

  TEST_CASE("a triangle without area is no piece") {
    BspSpace space;
    CHECK(space.add_triangle({LatticePoint{0, 0, 0}, {kFar, kFar, kFar}, {-kFar, -kFar, -kFar}}, 0)
              .corners.empty());
    // One step off is enough, over the whole lattice.
    CHECK(space.add_triangle({LatticePoint{0, 0, 1}, {kFar, kFar, kFar}, {-kFar, -kFar, -kFar}}, 0)
              .corners.size() == 3);
  }
}
