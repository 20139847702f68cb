#include "hooke/geometry.h"

#include "math/random.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

using hooke::DVec3;
using hooke::is_inside_by_angles;
using hooke::is_inside_by_cross_products;
using hooke::is_inside_by_side_planes;
using hooke::is_inside_by_winding;
using hooke::make_polygon;
using hooke::Plane;
using hooke::plane_across;
using hooke::plane_of_equation;
using hooke::plane_through;
using hooke::Polygon;
using hooke::side_of;
using hooke::signed_distance;
using hooke::winding_number;
using hooke::test::random_vector;

namespace {

using Corners = std::vector<DVec3>;

constexpr double kTolerance = 1e-9;

Polygon polygon(const Corners& corners) {
  auto result = make_polygon(corners, 1e-9);
  REQUIRE(result.has_value());
  return std::move(result).value();
}

double unit(std::mt19937_64& random) {
  return hooke::test::signed_unit(random);
}

/// Points of a plane in any place.
struct Sheet {
  DVec3 origin, u, v;

  [[nodiscard]] DVec3 at(double x, double y) const { return origin + x * u + y * v; }
};

Sheet random_sheet(std::mt19937_64& random) {
  const DVec3 n = normalize(random_vector(random));
  const DVec3 u = normalize(cross(n, random_vector(random)));
  return {random_vector(random), u, cross(n, u)};
}

bool distinct_answers(const Polygon& shape, DVec3 p) {
  const bool by_planes = is_inside_by_side_planes(shape, p, kTolerance);
  return by_planes != is_inside_by_cross_products(shape, p, kTolerance) ||
         by_planes != is_inside_by_angles(shape, p, kTolerance) ||
         by_planes != is_inside_by_winding(shape, p, kTolerance);
}

/// The pentagon's star: its heart is run around twice.
Corners star() {
  Corners corners;
  for (int k = 0; k < 5; ++k) {
    const double angle = 4 * std::acos(-1.0) * k / 5;
    corners.push_back({std::cos(angle), std::sin(angle), 0});
  }
  return corners;
}

const Corners kArrow = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};

}  // namespace

TEST_SUITE("geometry/polygon") {
  TEST_CASE("planes from points, from a normal, from an equation") {
    const Plane plane = plane_through({0, 3, 0}, {0, 3, 5}, {7, 3, 0}).value();
    CHECK(plane.normal == DVec3{0, 1, 0});
    CHECK(signed_distance(plane, {0, 5, 0}) == 2);  // the paper loses D and says 5
    CHECK(signed_distance(plane_across({0, 9, 0}, {1, 3, 1}).value(), {0, 5, 0}) == 2);
    CHECK(signed_distance(plane_of_equation(0, 2, 0, -6).value(), {0, 5, 0}) == 2);
    CHECK(signed_distance(plane_of_equation(0, -2, 0, 6).value(), {0, 5, 0}) == -2);
    CHECK(side_of(plane, {0, 5, 0}, 1) == 1);
    CHECK(side_of(plane, {0, 5, 0}, 2) == 0);
    CHECK(side_of(plane, {0, 0, 0}, 2) == -1);
    CHECK(side_of(plane, {0, std::nan(""), 0}, 2) == 0);
  }

  TEST_CASE("a plane through three points has them on it, at any size") {
    std::mt19937_64 random(1);
    for (const double size : {1e-150, 1e-6, 1.0, 1e6, 1e150}) {
      for (int i = 0; i < 50; ++i) {
        const DVec3 a = size * random_vector(random);
        const DVec3 b = size * random_vector(random);
        const DVec3 c = size * random_vector(random);
        const Plane plane = plane_through(a, b, c).value();
        REQUIRE(length(plane.normal) == doctest::Approx(1));
        for (const DVec3& p : {a, b, c}) REQUIRE(std::fabs(signed_distance(plane, p)) < 1e-9 * size);
        REQUIRE(signed_distance(plane, a + size * plane.normal) > 0);
      }
    }
  }

  TEST_CASE("what is no plane is refused") {
    const double nan = std::nan("");
    CHECK_FALSE(plane_through({0, 0, 0}, {1, 1, 1}, {3, 3, 3}).has_value());
    CHECK_FALSE(plane_through({1, 1, 1}, {1, 1, 1}, {1, 1, 1}).has_value());
    CHECK_FALSE(plane_through({nan, 0, 0}, {1, 1, 1}, {3, 0, 3}).has_value());
    CHECK_FALSE(plane_across({0, 0, 0}, {1, 1, 1}).has_value());
    CHECK_FALSE(plane_across({0, INFINITY, 0}, {1, 1, 1}).has_value());
    CHECK_FALSE(plane_of_equation(0, 0, 0, 1).has_value());
    CHECK_FALSE(plane_of_equation(0, nan, 0, 1).has_value());
    CHECK_FALSE(plane_of_equation(0, 1, 0, INFINITY).has_value());
  }

  TEST_CASE("inside, outside, on sides, on corners, off the plane, by all four") {
    const Polygon square = polygon({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
    CHECK(square.is_convex);
    struct Case {
      DVec3 p;
      bool is_inside;
    };
    const Case cases[] = {{{1, 1, 0}, true},     {{3, 1, 0}, false},        {{2, 1, 0}, true},
                          {{2, 2, 0}, true},     {{0, 0, 0}, true},         {{1, 1, 1e-6}, false},
                          {{1, 1, 1e-10}, true}, {{1, 2 + 1e-10, 0}, true}, {{1, 2 + 1e-8, 0}, false},
                          {{-1, 0, 0}, false},   {{4, 2, 0}, false}};
    for (const Case& c : cases) {
      CAPTURE(c.p.x);
      CAPTURE(c.p.y);
      CHECK(is_inside_by_side_planes(square, c.p, kTolerance) == c.is_inside);
      CHECK_FALSE(distinct_answers(square, c.p));
    }
    CHECK_FALSE(is_inside_by_winding(square, {std::nan(""), 1, 0}, kTolerance));
    CHECK_FALSE(is_inside_by_angles(square, {1, INFINITY, 0}, kTolerance));
    CHECK_FALSE(is_inside_by_cross_products(square, {1, std::nan(""), 0}, kTolerance));
  }

  TEST_CASE("all four agree on triangles and convex polygons of any place, with either face up") {
    std::mt19937_64 random(2);
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
      const Sheet sheet = random_sheet(random);
      const int count = 3 + static_cast<int>(random() % 6);
      // Corners of a circle in order are convex.
      std::vector<double> angles;
      for (int k = 0; k < count; ++k) angles.push_back(std::acos(-1.0) * unit(random));
      std::sort(angles.begin(), angles.end());
      Corners corners;
      for (const double angle : angles) corners.push_back(sheet.at(std::cos(angle), std::sin(angle)));
      if (i % 2 == 1) std::reverse(corners.begin(), corners.end());
      const auto made = make_polygon(corners, kTolerance);
      if (!made) continue;  // corners by chance at one place
      REQUIRE(made.value().is_convex);
      for (int k = 0; k < 5; ++k) {
        const double x = unit(random);
        const DVec3 p = sheet.at(x, unit(random));
        REQUIRE_FALSE(distinct_answers(made.value(), p));
        inside += is_inside_by_winding(made.value(), p, kTolerance) ? 1 : 0;
      }
    }
    CHECK(inside > 2000);
    CHECK(inside < 12000);
  }

  TEST_CASE("a dot product with the sides themselves is wrong for one point in three") {
    std::mt19937_64 random(3);
    int wrong = 0;
    constexpr int kTriangles = 20000;
    for (int i = 0; i < kTriangles; ++i) {
      const Sheet sheet = random_sheet(random);
      Corners corners;
      for (int k = 0; k < 3; ++k) {
        const double x = unit(random);
        corners.push_back(sheet.at(x, unit(random)));
      }
      const auto made = make_polygon(corners, kTolerance);
      if (!made) continue;
      const double x = unit(random);
      const DVec3 p = sheet.at(x, unit(random));
      bool by_dot = true;
      for (std::size_t k = 0; k < 3; ++k) {
        by_dot = by_dot && dot(corners[(k + 1) % 3] - corners[k], p - corners[k]) >= 0;
      }
      wrong += by_dot != is_inside_by_side_planes(made.value(), p, kTolerance) ? 1 : 0;
    }
    CHECK(wrong > 0.30 * kTriangles);
    CHECK(wrong < 0.36 * kTriangles);
  }

  TEST_CASE("concave polygons by angles and by winding number") {
    const Polygon arrow = polygon(kArrow);
    CHECK_FALSE(arrow.is_convex);
    const auto both = [&](DVec3 p) {
      const bool by_winding = is_inside_by_winding(arrow, p, kTolerance);
      CHECK(is_inside_by_angles(arrow, p, kTolerance) == by_winding);
      return by_winding;
    };
    CHECK(both({1, 1, 0}));
    CHECK(both({3.9, 3, 0}));
    CHECK_FALSE(both({2, 2, 0}));
    CHECK(both({2, 1, 0}));
    // Side planes see only the part from which the whole polygon is seen.
    CHECK_FALSE(is_inside_by_side_planes(arrow, {3.9, 3, 0}, kTolerance));
    std::mt19937_64 random(4);
    for (int i = 0; i < 2000; ++i) {
      const double x = 2 + 3 * unit(random);
      both({x, 2 + 3 * unit(random), 0});
    }
  }

  TEST_CASE("winding numbers: one, two in a star's heart, negative never for its own normal") {
    const Polygon pentagram = polygon(star());
    CHECK_FALSE(pentagram.is_convex);
    CHECK(winding_number(pentagram, {0, 0, 0}) == 2);
    CHECK(winding_number(pentagram, {0.9, 0, 0}) == 1);
    CHECK(winding_number(pentagram, {2, 0, 0}) == 0);
    Corners back = star();
    std::reverse(back.begin(), back.end());
    CHECK(winding_number(polygon(back), {0, 0, 0}) == 2);
    for (const DVec3& n : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, -1}}) {
      const DVec3 u = normalize(cross(n, DVec3{0.3, 0.4, 0.5}));
      const DVec3 v = cross(n, u);
      const Polygon turned = polygon({DVec3{}, u, u + v, v});
      CHECK(turned.plane.normal == DVec3{n});
      CHECK(winding_number(turned, 0.5 * (u + v)) == 1);
    }
  }

  TEST_CASE("what is no polygon is refused") {
    const auto is_refused = [](const Corners& corners) { return !make_polygon(corners, 1e-6).has_value(); };
    CHECK(is_refused({}));
    CHECK(is_refused({{0, 0, 0}, {1, 0, 0}}));
    CHECK(is_refused({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
    CHECK(is_refused({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    CHECK(is_refused({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}));
    CHECK(is_refused({{0, 0, 0}, {1, 0, std::nan("")}, {1, 1, 0}}));
    CHECK(is_refused({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}));  // a bow: its areas cancel
    CHECK_FALSE(is_refused({{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-7}, {0, 1, 0}}));
  }
}
