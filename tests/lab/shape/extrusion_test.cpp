#include "lab/shape/extrusion.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <random>

namespace hooke {

using geometry::ConvexSolid;
using geometry::extruded;
using geometry::gap_between;

TEST_SUITE("geometry/extrusion") {
  TEST_CASE("a cube pushed along a face is a longer box, along a diagonal it has twelve faces") {
    const ConvexSolid cube = geometry::solid_hull(geometry::make_box_hull({Real(0.5), Real(0.5), Real(0.5)}));
    const ConvexSolid ball = geometry::solid_sphere(0.25);
    const auto at = [&](DVec3 place) { return geometry::placed(ball, {}, place); };
    const ConvexSolid longer = extruded(cube, {3, 0, 0});
    CHECK(gap_between(longer, at({4, 0, 0})).distance == doctest::Approx(0.25));
    CHECK(gap_between(longer, at({1.5, 1, 0})).distance == doctest::Approx(0.25));
    CHECK(gap_between(longer, at({-1, 0, 0})).distance == doctest::Approx(0.25));
    const ConvexSolid oblique = extruded(cube, {2, 2, 2});
    CHECK(oblique.faces.size() == 12);
    // The middle of a side: the plane through two edges of the silhouette, (1, -1, 0) / sqrt 2.
    CHECK(gap_between(oblique, at({2, 0, 1})).distance == doctest::Approx((2 - 1) / std::sqrt(2.0) - 0.25));
  }

  TEST_CASE("an extrusion is as far from anything as the nearest of its copies on the way") {
    std::mt19937_64 bits(7);
    const auto random = [&](double size) {
      return std::uniform_real_distribution<double>(-size, size)(bits);
    };
    const auto vector = [&](double size) { return DVec3{random(size), random(size), random(size)}; };
    const auto rotation = [&] {
      return normalize(Quaternion<double>{random(1), random(1), random(1), random(1)});
    };
    const ConvexSolid solids[] = {
        geometry::solid_sphere(0.2), geometry::solid_capsule(0.1, 0.5),
        geometry::solid_hull(geometry::make_box_hull({Real(0.5), Real(0.25), Real(0.125)})),
        geometry::solid_triangle({0, 0, 0}, {1, 0, 0.2}, {0.3, 0.9, 0.1})};
    int apart = 0;
    for (int i = 0; i < 400; ++i) {
      CAPTURE(i);
      const DVec3 at_a = vector(1);  // one after the other: compilers differ in the order of arguments
      const ConvexSolid a = geometry::placed(solids[i % 4], rotation(), at_a);
      const DVec3 at_b = vector(2);
      const ConvexSolid b = geometry::placed(solids[i / 4 % 4], rotation(), at_b);
      const DVec3 way = vector(2);
      const double swept = gap_between(extruded(a, way), b).distance;
      double nearest = 1e9;
      for (int k = 0; k <= 400; ++k)
        nearest = std::min(nearest, gap_between(geometry::placed(a, {}, (k / 400.0) * way), b).distance);
      // Distance is convex in the place: between samples it falls by no more than half a sample's way.
      if (nearest > 0) CHECK(swept <= nearest + 1e-12);
      if (swept > 0) {
        CHECK(nearest <= swept + length(way) / 800);
        ++apart;
      }
      if (swept < -0.02) CHECK(nearest < 0);
    }
    CHECK(apart > 100);
    CHECK(apart < 380);
  }

  TEST_CASE("no way leaves a solid as it is, a way along a segment makes it longer") {
    const ConvexSolid rod = geometry::solid_capsule(0.1, 1);
    CHECK(extruded(rod, {}).vertices.size() == 2);
    const ConvexSolid longer = extruded(rod, {0, 2, 0});
    CHECK(longer.vertices.size() == 2);
    CHECK(gap_between(longer, geometry::placed(geometry::solid_sphere(0.1), {}, {0, 3.5, 0})).distance ==
          doctest::Approx(0.3));
  }
}

}  // namespace hooke
