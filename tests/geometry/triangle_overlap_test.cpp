#include "geometry/mesh/triangle_overlap.h"

#include "geometry/orientation.h"
#include "math/random.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <utility>
#include <vector>

using hooke::DVec3;
using hooke::geometry::DTriangle;
using hooke::geometry::orientation;
using hooke::geometry::segment_meets_triangle;
using hooke::geometry::segments_overlap;
using hooke::geometry::triangles_overlap;

namespace {

__extension__ using Whole = __int128;
using WholeVector = hooke::Vector3<Whole>;
using WholeTriangle = std::array<WholeVector, 3>;

WholeVector whole(DVec3 p) {
  return {static_cast<std::int64_t>(p.x), static_cast<std::int64_t>(p.y), static_cast<std::int64_t>(p.z)};
}

/// Whether a plane across `axis` is strictly between the two.
bool separates(WholeVector axis, const WholeTriangle& a, const WholeTriangle& b) {
  const auto range = [&](const WholeTriangle& t) {
    const Whole h[3] = {dot(axis, t[0]), dot(axis, t[1]), dot(axis, t[2])};
    return std::pair{*std::min_element(h, h + 3), *std::max_element(h, h + 3)};
  };
  const auto [a_low, a_high] = range(a);
  const auto [b_low, b_high] = range(b);
  return a_high < b_low || b_high < a_low;
}

/// In whole numbers: two convex sets are apart if and only if a plane across the shortest way between them
/// separates them, and that way joins two vertices, a vertex and an edge, a vertex and a face or two edges.
bool overlap_by_axes(const DTriangle& triangle_a, const DTriangle& triangle_b) {
  const WholeTriangle a = {whole(triangle_a[0]), whole(triangle_a[1]), whole(triangle_a[2])};
  const WholeTriangle b = {whole(triangle_b[0]), whole(triangle_b[1]), whole(triangle_b[2])};
  std::vector<WholeVector> edges;
  for (const WholeTriangle& t : {a, b}) {
    for (std::size_t i = 0; i < 3; ++i) edges.push_back(t[(i + 1) % 3] - t[i]);
  }
  std::vector<WholeVector> axes;
  for (const WholeVector& e : edges) {
    for (const WholeVector& f : edges) axes.push_back(cross(e, f));
  }
  for (const WholeVector& p : a) {
    for (const WholeVector& q : b) {
      const WholeVector way = p - q;
      axes.push_back(way);
      for (const WholeVector& e : edges) axes.push_back(cross(e, cross(way, e)));
    }
  }
  return std::none_of(axes.begin(), axes.end(), [&](WholeVector axis) { return separates(axis, a, b); });
}

int sign_of(Whole value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

DVec3 grid_point(std::mt19937_64& random, double size) {
  const auto one = [&] { return std::floor(size * hooke::test::signed_unit(random) + 0.5); };
  const double x = one();
  const double y = one();
  return {x, y, one()};
}

DTriangle grid_triangle(std::mt19937_64& random, double size) {
  const DVec3 a = grid_point(random, size);
  const DVec3 b = grid_point(random, size);
  return {a, b, grid_point(random, size)};
}

}  // namespace

TEST_SUITE("geometry/triangle_overlap") {
  TEST_CASE("the side of a plane is exact where rounding would turn it") {
    std::mt19937_64 random(1);
    int in_plane = 0;
    for (int i = 0; i < 20000; ++i) {
      // A point of the plane of three others, moved by one unit of 2^20 or not at all.
      const double size = i % 2 == 0 ? 3 : 1000;
      const DTriangle t = grid_triangle(random, size);
      const double p = std::floor(3 * hooke::test::signed_unit(random));
      const double q = std::floor(3 * hooke::test::signed_unit(random));
      DVec3 d = t[0] + p * (t[1] - t[0]) + q * (t[2] - t[0]);
      if (i % 3 == 0) d.x += 1;
      const WholeVector a = whole(t[0]);
      const Whole exact = dot(cross(whole(t[1]) - a, whole(t[2]) - a), whole(d) - a);
      // The same picture, tiny and far away: coordinates of 53 bits.
      const auto far = [](DVec3 v) { return 0x1p-31 * v + DVec3{0x1p10, -0x1p10, 0x1p11}; };
      REQUIRE(orientation(far(t[0]), far(t[1]), far(t[2]), far(d)) == sign_of(exact));
      in_plane += exact == 0 ? 1 : 0;
    }
    CHECK(in_plane > 5000);
    // Here the plain determinant says something else.
    const DVec3 a = {0.1, 0.1, 0.1};
    const DVec3 b = {0.3, 0.3, 0.7};
    const DVec3 c = {0.7, 0.7, 0.2};
    CHECK(orientation(a, b, c, {0.5, 0.5, 0.9}) == 0);
    CHECK(orientation(a, b, c, {0.5, std::nextafter(0.5, 1), 0.9}) ==
          -orientation(a, b, c, {0.5, std::nextafter(0.5, 0), 0.9}));
    CHECK(orientation(a, b, c, {0.5, std::nextafter(0.5, 1), 0.9}) != 0);
  }

  TEST_CASE("the side of a line is exact, and seen along an axis it keeps its turn") {
    using hooke::geometry::Point2;
    CHECK(orientation(Point2{0, 0}, Point2{1, 0}, Point2{0, 1}) == 1);
    CHECK(orientation(Point2{0, 0}, Point2{0, 1}, Point2{1, 0}) == -1);
    for (int i = -50; i <= 50; ++i) {
      const Point2 p = {0.5 + i * 0x1p-53, 0.5};
      REQUIRE(orientation(Point2{12, 12}, Point2{24, 24}, p) == (i > 0 ? -1 : i < 0 ? 1 : 0));
    }
    for (int axis = 0; axis < 3; ++axis) {
      const DVec3 e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      using hooke::geometry::seen_along;
      const DVec3 next = e[(axis + 1) % 3];
      CHECK(orientation(seen_along(axis, {}), seen_along(axis, next), seen_along(axis, e[(axis + 2) % 3])) ==
            1);
    }
  }

  TEST_CASE("sides of what is not finite are zero") {
    const double nan = std::nan("");
    const double infinite = INFINITY;
    CHECK(orientation({nan, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}) == 0);
    CHECK(orientation({infinite, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}) == 0);
    CHECK(orientation({nan, 0}, {1, 0}, {0, 1}) == 0);
    const DTriangle t = {DVec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const double bad : {nan, infinite, -infinite}) {
      CHECK_FALSE(triangles_overlap({DVec3{bad, 0, 0}, {1, 0, 0}, {0, 1, 0}}, t));
      CHECK_FALSE(triangles_overlap(t, {DVec3{0, 0, 0}, {1, 0, 0}, {0, 1, bad}}));
      CHECK_FALSE(segment_meets_triangle({0, bad, 0}, {0, 0, 0}, t));
      CHECK_FALSE(segments_overlap({0, 0, 0}, {1, 0, 0}, {0, 0, bad}, {0, 0, 0}));
    }
  }

  TEST_CASE("triangles that touch, share, lie in one plane or are no triangles") {
    const DTriangle t = {DVec3{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    struct Case {
      const char* name;
      DTriangle other;
      bool overlaps;
    };
    const Case cases[] = {
        {"through the middle", {DVec3{1, 1, -1}, {1, 1, 1}, {2, 2, 1}}, true},
        {"over it", {DVec3{1, 1, 1}, {2, 1, 1}, {1, 2, 1}}, false},
        {"through its plane beside it", {DVec3{5, 5, -1}, {5, 5, 1}, {6, 6, 1}}, false},
        {"a corner on the face", {DVec3{1, 1, 0}, {1, 2, 3}, {2, 1, 3}}, true},
        {"a corner on an edge", {DVec3{2, 2, 0}, {3, 3, 3}, {4, 3, 3}}, true},
        {"a corner on a corner", {DVec3{4, 0, 0}, {5, 1, 3}, {5, -1, 3}}, true},
        {"a shared edge", {DVec3{0, 0, 0}, {4, 0, 0}, {0, 0, 4}}, true},
        {"edges that cross in a point", {DVec3{2, -1, -1}, {2, 1, 1}, {2, -1, 1}}, true},
        {"the same", t, true},
        {"turned over", {t[2], t[1], t[0]}, true},
        {"inside, in the plane", {DVec3{1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}}, true},
        {"around, in the plane", {DVec3{-9, -9, 0}, {30, -9, 0}, {-9, 30, 0}}, true},
        {"across, in the plane", {DVec3{-1, 1, 0}, {6, 1, 0}, {6, 1.5, 0}}, true},
        {"beside, in the plane", {DVec3{3, 3, 0}, {4, 3, 0}, {3, 4, 0}}, false},
        {"an edge on an edge, in the plane", {DVec3{1, 0, 0}, {2, 0, 0}, {1, -3, 0}}, true},
        {"a corner on a corner, in the plane", {DVec3{4, 0, 0}, {5, 0, 0}, {5, -3, 0}}, true},
        {"a segment through it", {DVec3{1, 1, -1}, {1, 1, 1}, {1, 1, 0.5}}, true},
        {"a segment beside it", {DVec3{3, 3, -1}, {3, 3, 1}, {3, 3, 0.5}}, false},
        {"a segment in it", {DVec3{1, 1, 0}, {2, 1, 0}, {1.5, 1, 0}}, true},
        {"a point in it", {DVec3{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}, true},
        {"a point over it", {DVec3{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, false},
        {"a point in its plane", {DVec3{3, 3, 0}, {3, 3, 0}, {3, 3, 0}}, false},
    };
    for (const Case& c : cases) {
      CAPTURE(c.name);
      CHECK(triangles_overlap(t, c.other) == c.overlaps);
      CHECK(triangles_overlap(c.other, t) == c.overlaps);
    }
    const DTriangle point = {DVec3{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    CHECK(triangles_overlap(point, point));
  }

  TEST_CASE("segments meet in a point, along a stretch, at an end, or not") {
    const DVec3 a = {0, 0, 0};
    const DVec3 b = {4, 4, 4};
    CHECK(segments_overlap(a, b, {0, 4, 2}, {4, 0, 2}));
    CHECK_FALSE(segments_overlap(a, b, {0, 4, 2}, {4, 0, 2.0000001}));
    CHECK(segments_overlap(a, b, {3, 3, 3}, {9, 9, 9}));
    CHECK_FALSE(segments_overlap(a, b, {5, 5, 5}, {9, 9, 9}));
    CHECK(segments_overlap(a, b, b, {9, 0, 1}));
    CHECK(segments_overlap(a, b, {2, 2, 2}, {2, 2, 2}));
    CHECK_FALSE(segments_overlap(a, b, {2, 2, 3}, {2, 2, 3}));
    CHECK(segment_meets_triangle({1, 1, -1}, {1, 1, 0}, {DVec3{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}));
    CHECK_FALSE(segment_meets_triangle({1, 1, -1}, {1, 1, -1e-300}, {DVec3{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}));
  }

  TEST_CASE("exactly as by all axes in whole numbers") {
    std::mt19937_64 random(2);
    // A coarse grid has every kind of touching and of triangles that are none; on a fine one nothing touches
    // but what is made to.
    for (const double size : {1.0, 2.0, 4.0, 500000.0}) {
      int overlapping = 0;
      for (int i = 0; i < 8000; ++i) {
        const DTriangle a = grid_triangle(random, size);
        DTriangle b = grid_triangle(random, size);
        // A corner of the second one at a whole combination of the first: in its plane.
        if (i % 4 == 0) b[0] = a[0] + (a[1] - a[0]) + (a[2] - a[0]);
        if (i % 8 == 1) b[0] = a[1];
        if (i % 16 == 2) b[0] = a[2], b[1] = a[0];
        const bool expected = overlap_by_axes(a, b);
        REQUIRE(triangles_overlap(a, b) == expected);
        overlapping += expected ? 1 : 0;
      }
      CHECK(overlapping > 500);
      CHECK(overlapping < 7500);
    }
  }
}
