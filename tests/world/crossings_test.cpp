#include "validation/crossings.h"

#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>

/// The checker itself: what it must find, and what is no crossing.

namespace hooke {
namespace {

/// A triangle in the plane y = 0 and a line of two points.
Surfaces triangle_and_line(DVec3 from, DVec3 to) {
  Surfaces s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, from, to};
  s.triangles = {{0, 1, 2}};
  s.lines = {{3, 4}};
  return s;
}

Surfaces sheets(double height, double slope) {
  Surfaces s;
  constexpr std::uint32_t kSide = 20;
  for (std::uint32_t layer = 0; layer < 2; ++layer) {
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const double x = 0.05 * (i % kSide);
      const double z = 0.05 * static_cast<double>(i / kSide) + 0.01 * layer;
      s.points.push_back({x, layer * (height + slope * x), z});
    }
    for (std::uint32_t i = 0; i + kSide < kSide * kSide; ++i) {
      if (i % kSide + 1 == kSide) continue;
      const std::uint32_t p = layer * kSide * kSide + i;
      s.triangles.push_back({p, p + 1, p + kSide});
      s.triangles.push_back({p + 1, p + kSide + 1, p + kSide});
    }
  }
  return s;
}

}  // namespace

TEST_SUITE("world/crossings") {
  TEST_CASE("intersect: a line through a triangle crosses it, and one beside or above it does not") {
    CHECK(count_crossings(triangle_and_line({0.2, 1, 0.2}, {0.2, -1, 0.2})).crossing == 1);
    CHECK(count_crossings(triangle_and_line({0.9, 1, 0.9}, {0.9, -1, 0.9})).crossing == 0);
    CHECK(count_crossings(triangle_and_line({0.2, 1, 0.2}, {0.2, 0.1, 0.2})).crossing == 0);
  }

  TEST_CASE("intersect: the sign is right where doubles cannot say it") {
    const double tiny = std::ldexp(1.0, -52);
    // The end of the line is one unit in the last place beyond the plane, then exactly on it.
    const DVec3 a = {0.1, 0.1, 0.1};
    CHECK(exact_orientation(a, {1.1, 0.1, 0.1}, {0.1, 0.1, 1.1}, {0.3, 0.1 + 0.125 * tiny, 0.3}) == 1);
    CHECK(exact_orientation(a, {1.1, 0.1, 0.1}, {0.1, 0.1, 1.1}, {0.3, 0.1 - 0.125 * tiny, 0.3}) == -1);
    CHECK(exact_orientation(a, {1.1, 0.1, 0.1}, {0.1, 0.1, 1.1}, {0.3, 0.1, 0.3}) == 0);
    // x + y + z = 3 holds exactly for these, though none of the products is exact.
    const double third = 1.0 / 3.0;
    CHECK(exact_orientation({3 * third, 1, 1}, {1, third, 3 - 1 - third}, {1, 1, 1}, {2, 0.5, 0.5}) == 0);
  }

  TEST_CASE("intersect: lines in the plane of a triangle are counted apart") {
    const Crossings flat = count_crossings(triangle_and_line({-1, 0, 0.2}, {2, 0, 0.2}));
    CHECK(flat.crossing == 0);
    CHECK(flat.coplanar == 1);
    CHECK(count_crossings(triangle_and_line({0.2, 0, 0.2}, {0.2, 1, 0.2})).touching == 1);
  }

  TEST_CASE("intersect: a planted crossing of two sheets is found, and sheets a hair apart do not cross") {
    CHECK(count_crossings(sheets(1e-9, 0)).crossing == 0);
    CHECK(count_crossings(sheets(-1e-9, 0)).crossing == 0);
    // The upper sheet goes through the lower one along a line between two columns, through 19 rows of cells.
    const std::size_t through = count_crossings(sheets(-0.475, 1)).crossing;
    CHECK(through >= 38);
    CHECK(through <= 200);
  }

  TEST_CASE(
      "intersect: a line that passes another one is found, and one that turns back or goes round is not") {
    const auto lines = [](DVec3 from, DVec3 to) {
      Surfaces s;
      s.points = {{-1, 0, 0}, {1, 0, 0}, from, to};
      s.lines = {{0, 1}, {2, 3}};
      return s;
    };
    const Surfaces above = lines({0.3, 1e-6, -1}, {0.1, 1e-6, 1});
    CHECK(count_passes(above, lines({0.3, -1e-6, -1}, {0.1, -1e-6, 1})) == 1);
    CHECK(count_passes(above, lines({0.3, 1e-7, -1}, {0.1, 1e-7, 1})) == 0);
    CHECK(count_passes(above, lines({2.3, -1, -1}, {2.1, -1, 1})) == 1);  // It meets at once, then leaves.
    CHECK(count_passes(lines({1.1, 1, -1}, {1.1, 1, 1}), lines({1.1, -1, -1}, {1.1, -1, 1})) == 0);
    // Both ends of the way lie on the same side: one end goes under, and the other comes after it.
    Surfaces triangle = lines({0.5, 0.1, -1}, {0.5, 0.1, 1});
    triangle.points.push_back({0, 0, -0.5});
    triangle.triangles = {{0, 1, 4}};
    triangle.lines = {{2, 3}};
    Surfaces below = triangle;
    below.points[2].y = below.points[3].y = -0.1;
    CHECK(count_passes(triangle, below) == 2);  // It passes two edges of the triangle.
  }
}

}  // namespace hooke
