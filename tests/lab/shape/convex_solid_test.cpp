#include "lab/shape/convex_solid.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

namespace hooke {

using geometry::ConvexSolid;
using geometry::gap_between;
using geometry::SolidGap;

namespace {

ConvexSolid box(DVec3 half) {
  return geometry::solid_hull(geometry::make_box_hull(vector_cast<Real>(half)));
}

ConvexSolid at(const ConvexSolid& solid, DVec3 place) {
  return geometry::placed(solid, {}, place);
}

class Random {
 public:
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(bits_);
  }
  DVec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
  Quaternion<double> rotation() {
    return normalize(Quaternion<double>{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)});
  }

 private:
  std::mt19937_64 bits_{20};
};

}  // namespace

TEST_SUITE("geometry/convex_solid") {
  TEST_CASE("spheres, boxes and capsules are as far apart as their formulas say") {
    const ConvexSolid ball = geometry::solid_sphere(0.5);
    const ConvexSolid cube = box({1, 1, 1});
    CHECK(gap_between(ball, at(ball, {3, 4, 0})).distance == doctest::Approx(4));
    CHECK(length(gap_between(ball, at(ball, {3, 4, 0})).normal - DVec3{0.6, 0.8, 0}) < 1e-15);
    // Face, edge, corner, inside.
    CHECK(gap_between(cube, at(ball, {0.3, 2, 0.1})).distance == doctest::Approx(0.5));
    CHECK(gap_between(cube, at(ball, {1.3, 1.4, 0})).distance == doctest::Approx(0).epsilon(1e-12));
    CHECK(gap_between(cube, at(ball, {2, 2, 2})).distance == doctest::Approx(std::sqrt(3.0) - 0.5));
    CHECK(gap_between(cube, at(ball, {0, 0.9, 0})).distance == doctest::Approx(-0.6));
    // Faces that overlap; an edge over an edge, by the rotation of one by 45 degrees about x and z.
    CHECK(gap_between(cube, at(cube, {0.2, 1.9, 0.1})).distance == doctest::Approx(-0.1));
    CHECK(length(gap_between(cube, at(cube, {0.2, 1.9, 0.1})).normal - DVec3{0, 1, 0}) < 1e-15);
    const double c = std::sqrt(0.5);
    const double s45 = std::sin(std::atan(1.0) / 2), c45 = std::cos(std::atan(1.0) / 2);
    const ConvexSolid roof = geometry::placed(cube, {s45, 0, 0, c45}, {});
    const ConvexSolid keel = geometry::placed(cube, {0, 0, s45, c45}, {0, 2 / c - 0.01, 0});
    CHECK(gap_between(roof, keel).distance == doctest::Approx(-0.01));
    // A rod across a rod.
    const ConvexSolid rod = geometry::solid_capsule(0.1, 1);
    const ConvexSolid across = geometry::placed(rod, {0, 0, c, c}, {0.3, 0.2, 0.5});
    CHECK(gap_between(rod, across).distance == doctest::Approx(0.3));
    CHECK(length(gap_between(rod, across).normal - DVec3{0, 0, 1}) < 1e-15);
  }

  TEST_CASE("cores that coincide part upward, or across their line") {
    const ConvexSolid ball = geometry::solid_sphere(0.5);
    CHECK(gap_between(ball, ball).distance == -1);
    CHECK(gap_between(ball, ball).normal == DVec3{0, 1, 0});
    const ConvexSolid rod = geometry::solid_capsule(0.1, 1);
    const SolidGap gap = gap_between(rod, rod);
    CHECK(gap.distance == doctest::Approx(-0.2));
    CHECK(std::abs(gap.normal.y) < 1e-15);
    CHECK(length(gap.normal) == doctest::Approx(1));
  }

  TEST_CASE("a triangle without area is a segment or a point") {
    const ConvexSolid ball = geometry::solid_sphere(0.5);
    const ConvexSolid needle = geometry::solid_triangle({-1, 2, 0}, {1, 2, 0}, {0.5, 2, 0});
    CHECK(needle.vertices.size() == 2);
    CHECK(gap_between(ball, needle).distance == doctest::Approx(1.5));
    const ConvexSolid dot = geometry::solid_triangle({0, 2, 0}, {0, 2, 0}, {0, 2, 0});
    CHECK(dot.vertices.size() == 1);
    CHECK(gap_between(ball, dot).distance == doctest::Approx(1.5));
  }

  TEST_CASE("two solids moved by their gap touch, whether they were apart or overlapped") {
    Random random;
    const ConvexSolid solids[] = {geometry::solid_sphere(0.4), geometry::solid_capsule(0.2, 0.7),
                                  box({0.5, 0.3, 0.8}), box({1, 0.05, 0.4}),
                                  geometry::solid_triangle({0, 0, 0}, {1, 0, 0.2}, {0.3, 0.9, 0.1})};
    int overlaps = 0;
    for (int i = 0; i < 4000; ++i) {
      const ConvexSolid a = geometry::placed(solids[i % 5], random.rotation(), random.vector(1));
      const ConvexSolid b = geometry::placed(solids[(i / 5) % 5], random.rotation(), random.vector(1));
      const SolidGap gap = gap_between(a, b);
      CAPTURE(i);
      overlaps += gap.distance < 0 ? 1 : 0;
      CHECK(length(gap.normal) == doctest::Approx(1));
      const ConvexSolid moved = at(b, -gap.distance * gap.normal);
      CHECK(std::abs(gap_between(a, moved).distance) < 1e-9);
      CHECK(geometry::separation_along(a, b, gap.normal) == doctest::Approx(gap.distance).epsilon(1e-9));
      const SolidGap back = gap_between(b, a);
      CHECK(back.distance == doctest::Approx(gap.distance).epsilon(1e-9));
    }
    CHECK(overlaps > 800);
    CHECK(overlaps < 3200);
  }

  TEST_CASE("boxes touch at the corners of what their faces share") {
    const ConvexSolid cube = box({1, 1, 1});
    const auto points_of = [&](const ConvexSolid& a, const ConvexSolid& b) {
      return geometry::contact_points(a, b, gap_between(a, b), 1e-6);
    };
    // A cube on a cube, aside by (0.5, 0.25): corners of both, none twice.
    std::vector<DVec3> points = points_of(cube, at(cube, {0.5, 2, 0.25}));
    REQUIRE(points.size() == 4);
    for (const DVec3 p : points) {
      CHECK(p.y == doctest::Approx(1));
      CHECK((std::abs(p.x + 0.5) < 1e-12 || std::abs(p.x - 1) < 1e-12));
      CHECK((std::abs(p.z + 0.75) < 1e-12 || std::abs(p.z - 1) < 1e-12));
    }
    CHECK(points_of(cube, at(cube, {0, 2, 0})).size() == 4);
    // Turned by 45 degrees about y: eight crossings.
    const double half = std::atan(1.0) / 2;
    const ConvexSolid turned = geometry::placed(cube, {0, std::sin(half), 0, std::cos(half)}, {0, 2, 0});
    CHECK(points_of(cube, turned).size() == 8);
    // On a corner, on an edge, a ball.
    CHECK(points_of(cube, at(geometry::placed(cube, normalize(Quaternion<double>{0.3, 0.1, 0.2, 1}), {}),
                             {0, 3, 0}))
              .size() == 1);
    const ConvexSolid keel =
        geometry::placed(cube, {std::sin(half), 0, 0, std::cos(half)}, {0, 1 + std::sqrt(2.0), 0});
    CHECK(points_of(cube, keel).size() == 2);
    points = points_of(cube, at(geometry::solid_sphere(0.5), {0.2, 1.5, 0.3}));
    REQUIRE(points.size() == 1);
    CHECK(length(points[0] - DVec3{0.2, 1, 0.3}) < 1e-12);
  }
}

}  // namespace hooke
