#include "geometry/bsp/bsp_solid.h"

#include "geometry/bsp/bsp_slivers.h"
#include "geometry/mesh/mesh_clean.h"
#include "geometry/solids.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <map>
#include <random>
#include <string>

using hooke::DVec3;
using hooke::SolidOperation;
using hooke::geometry::combine_solids;
using hooke::geometry::SolidMesh;
using hooke::test::is_manifold;
using hooke::test::make_box;
using hooke::test::volume_of;

namespace {

struct Combined {
  SolidMesh both, common, rest;
};

Combined combine(const SolidMesh& a, const SolidMesh& b) {
  const auto both = combine_solids(a, b, SolidOperation::kUnion);
  const auto common = combine_solids(a, b, SolidOperation::kIntersection);
  const auto rest = combine_solids(a, b, SolidOperation::kDifference);
  if (!both) FAIL(both.error().where << " " << both.error().message);
  REQUIRE(common);
  REQUIRE(rest);
  return {both.value(), common.value(), rest.value()};
}

/// Closed manifolds, and the volumes of what is common and what is not add up.
void check_pair(const SolidMesh& a, const SolidMesh& b) {
  const Combined c = combine(a, b);
  CHECK(is_manifold(c.both));
  CHECK(is_manifold(c.common));
  CHECK(is_manifold(c.rest));
  const double sum = volume_of(a) + volume_of(b);
  CHECK(std::fabs(volume_of(c.both) + volume_of(c.common) - sum) < 1e-9 * sum);
  CHECK(std::fabs(volume_of(c.rest) + volume_of(c.common) - volume_of(a)) < 1e-9 * sum);
}

SolidMesh random_solid(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto kind = random() % 6;
  if (kind == 0) {
    // On a coarse grid: faces, edges and corners of two such fall together.
    const auto at = [&] { return 0.5 * static_cast<double>(static_cast<int>(random() % 5) - 2); };
    const DVec3 p = {at(), at(), at()};
    return make_box(p, p + DVec3{0.5, 1, 0.5 + 0.5 * static_cast<double>(random() % 2)});
  }
  if (kind == 1) {
    const auto at = [&] { return static_cast<double>(static_cast<int>(random() % 3) - 1); };
    return hooke::test::moved(hooke::test::make_corner(), {}, 0.5 + 0.5 * static_cast<double>(random() % 2),
                              {at(), at(), at()});
  }
  const hooke::Quaternion<double> turn =
      normalize(hooke::Quaternion<double>{unit(random), unit(random), unit(random), unit(random)});
  const DVec3 shift = {unit(random), unit(random), unit(random)};
  if (kind == 2) return hooke::test::moved(make_box({-1, -0.6, -0.8}, {1, 0.6, 0.8}), turn, 1, shift);
  if (kind == 3) return hooke::test::moved(hooke::test::make_ring(12, 0.6, 1.2, 0.3), turn, 1, shift);
  if (kind == 4) return hooke::test::moved(hooke::test::make_star(2, 0.9999, random), turn, 1, shift);
  return hooke::test::moved(hooke::test::make_star(2, 0.4, random), turn, 1.3, shift);
}

hooke::MeshDesc in_float(const SolidMesh& solid) {
  hooke::MeshDesc mesh = {.triangles = solid.triangles};
  for (const DVec3& p : solid.positions) mesh.positions.push_back(hooke::vector_cast<hooke::Real>(p));
  return mesh;
}

/// What is left of the triangles when a reader has welded points at 1e-6 of the diagonal and dropped what has
/// no height.
std::vector<hooke::geometry::Triangle> as_read(const hooke::MeshDesc& mesh) {
  const SolidMesh solid = hooke::geometry::solid_mesh_of(mesh);
  const double distance = hooke::geometry::weld_distance(solid.positions);
  const auto welds = hooke::geometry::weld(solid.positions, distance);
  std::vector<DVec3> points;
  for (const std::uint32_t i : welds.first) points.push_back(solid.positions[i]);
  std::vector<hooke::geometry::Triangle> triangles;
  for (auto t : solid.triangles) {
    for (std::uint32_t& vertex : t) vertex = welds.welded_of[vertex];
    if (!hooke::geometry::is_degenerate(points, t, distance)) triangles.push_back(t);
  }
  return triangles;
}

/// Each edge is gone along as often one way as the other.
bool is_closed(const std::vector<hooke::geometry::Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> excess;
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1) % 3];
      excess[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(excess.begin(), excess.end(), [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

TEST_SUITE("geometry/bsp_solid") {
  TEST_CASE("two boxes that overlap by an eighth") {
    const Combined c = combine(make_box({0, 0, 0}, {2, 2, 2}), make_box({1, 1, 1}, {3, 3, 3}));
    CHECK(volume_of(c.both) == doctest::Approx(15).epsilon(1e-14));
    CHECK(volume_of(c.common) == doctest::Approx(1).epsilon(1e-14));
    CHECK(volume_of(c.rest) == doctest::Approx(7).epsilon(1e-14));
    CHECK(c.common.positions.size() == 8);
    CHECK(c.common.triangles.size() <= 24);
    CHECK(is_manifold(c.both));
    CHECK(is_manifold(c.rest));
  }

  TEST_CASE("boxes that share a face, part of one, an edge, a corner, everything, or nothing") {
    const SolidMesh box = make_box({0, 0, 0}, {1, 1, 1});
    const struct {
      DVec3 lower, upper;
      double common;
      std::size_t shells;
    } cases[] = {{{1, 0, 0}, {2, 1, 1}, 0, 1},     {{1, 0.25, 0.25}, {2, 0.75, 0.75}, 0, 1},
                 {{1, 1, 0}, {2, 2, 1}, 0, 2},     {{1, 1, 0.25}, {2, 2, 0.75}, 0, 2},
                 {{1, 1, 1}, {2, 2, 2}, 0, 2},     {{0, 0, 0}, {1, 1, 1}, 1, 1},
                 {{0, 0, 0}, {1, 1, 0.5}, 0.5, 1}, {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}, 0.125, 1},
                 {{5, 5, 5}, {6, 6, 6}, 0, 2}};
    for (const auto& other : cases) {
      const SolidMesh b = make_box(other.lower, other.upper);
      check_pair(box, b);
      const Combined c = combine(box, b);
      CHECK(volume_of(c.common) == doctest::Approx(other.common).epsilon(1e-14));
      // Euler: each shell without holes has two vertices and triangles' halves more than edges.
      const auto& both = c.both;
      CHECK(both.positions.size() - both.triangles.size() / 2 == 2 * other.shells);
    }
  }

  TEST_CASE("a solid and itself: all, all, nothing") {
    std::mt19937 random(3);
    const SolidMesh star = hooke::test::make_star(2, 0.5, random);
    const Combined c = combine(star, star);
    CHECK(c.both.triangles.size() == star.triangles.size());
    CHECK(c.common.triangles.size() == star.triangles.size());
    CHECK(c.rest.triangles.empty());
  }

  TEST_CASE("a solid taken out of one around it leaves a cavity, which can be filled again") {
    const SolidMesh box = make_box({-2, -2, -2}, {2, 2, 2});
    const SolidMesh ball = hooke::geometry::solid_mesh_of(hooke::test::make_sphere(2));
    const Combined c = combine(box, ball);
    CHECK(c.rest.triangles.size() == box.triangles.size() + ball.triangles.size());
    CHECK(volume_of(c.rest) == doctest::Approx(64 - volume_of(ball)).epsilon(1e-9));
    const auto filled = combine_solids(c.rest, ball, SolidOperation::kUnion);
    REQUIRE(filled);
    CHECK(filled.value().triangles.size() == 12);
  }

  TEST_CASE("200 random pairs: closed manifolds whose volumes add up to 1e-9") {
    std::mt19937 random(20050901);
    for (int pair = 0; pair < 200; ++pair) {
      CAPTURE(pair);
      const SolidMesh a = random_solid(random);
      check_pair(a, random_solid(random));
    }
  }

  TEST_CASE("the results go in again: a block drilled three ways") {
    SolidMesh block = make_box({-1, -1, -1}, {1, 1, 1});
    const SolidMesh drills[] = {make_box({-2, -0.5, -0.5}, {2, 0.5, 0.5}),
                                make_box({-0.5, -2, -0.5}, {0.5, 2, 0.5}),
                                make_box({-0.5, -0.5, -2}, {0.5, 0.5, 2})};
    for (const SolidMesh& drill : drills) {
      auto drilled = combine_solids(block, drill, SolidOperation::kDifference);
      REQUIRE(drilled);
      block = drilled.value();
      CHECK(is_manifold(block));
    }
    CHECK(volume_of(block) == doctest::Approx(8 - 3 * 2 + 2).epsilon(1e-13));
  }

  TEST_CASE("for files: no triangle thinner than 2e-6 of the diagonal, and still a manifold") {
    // A step of 1e-7 m on one side: all of its triangles are slivers.
    const SolidMesh box = make_box({0, 0, 0}, {1, 1, 1});
    const SolidMesh other = make_box({0.25, 0.25, 0.5}, {0.75, 0.75, 1.0000001});
    CHECK(combine(box, other).both.triangles.size() > 20);
    const SolidMesh clean = hooke::geometry::without_slivers(combine(box, other).both, 1e-6);
    CHECK(is_manifold(clean));
    CHECK(volume_of(clean) == doctest::Approx(1).epsilon(1e-6));

    std::mt19937 random(41);
    std::size_t slivers = 0;
    std::size_t slivers_before = 0;
    const auto count_slivers = [](const SolidMesh& mesh) {
      return std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
        const DVec3 a = mesh.positions[t[0]];
        const DVec3 b = mesh.positions[t[1]];
        const DVec3 c = mesh.positions[t[2]];
        const double longest = std::max({length(b - a), length(c - b), length(a - c)});
        return length(cross(b - a, c - a)) <= 1e-5 * longest;
      });
    };
    for (int pair = 0; pair < 40; ++pair) {
      CAPTURE(pair);
      const SolidMesh a = random_solid(random);
      const auto both = combine_solids(a, random_solid(random), SolidOperation::kUnion);
      REQUIRE(both);
      const SolidMesh cleaned = hooke::geometry::without_slivers(both.value(), 1e-5);
      CHECK(is_manifold(cleaned));
      CHECK(volume_of(cleaned) == doctest::Approx(volume_of(both.value())).epsilon(1e-4));
      slivers_before += static_cast<std::size_t>(count_slivers(both.value()));
      slivers += static_cast<std::size_t>(count_slivers(cleaned));
    }
    CHECK(slivers_before > 100);
    CHECK(50 * slivers <= slivers_before);
  }

  TEST_CASE("results are still closed when they were in a file of floats and welded by its reader") {
    std::mt19937 random(20050901);
    int results = 0;
    for (int pair = 0; pair < 125; ++pair) {
      CAPTURE(pair);
      const hooke::MeshDesc a = in_float(random_solid(random));
      const hooke::MeshDesc b = in_float(random_solid(random));
      for (const auto operation :
           {SolidOperation::kUnion, SolidOperation::kIntersection, SolidOperation::kDifference}) {
        const auto combined = hooke::combine_solids(a, b, operation);
        REQUIRE(combined);
        results += combined.value().triangles.empty() ? 0 : 1;
        CHECK(is_closed(as_read(combined.value())));
      }
    }
    CHECK(results > 250);
  }

  TEST_CASE("a hole too narrow for a file stays a hole rather than a pinch") {
    // A hole of three sides, one of them short: without it the other two would lie on each other.
    SolidMesh ring = hooke::test::make_ring(3, 0.3, 1, 0.5);
    for (const std::size_t k : {0u, 3u}) ring.positions[4 + k] = ring.positions[k] + DVec3{0, 1e-7, 0};
    const SolidMesh clean = hooke::geometry::without_slivers(ring, 1e-6);
    CHECK(is_manifold(clean));
    CHECK(volume_of(clean) == doctest::Approx(volume_of(ring)).epsilon(1e-6));
  }

  TEST_CASE("the public form is the same in float, and says whose triangle is wrong") {
    const hooke::MeshDesc cube = hooke::test::make_cube(1);
    hooke::MeshDesc other = cube;
    for (auto& p : other.positions) p.x += 1;
    const auto both = hooke::combine_solids(cube, other, SolidOperation::kUnion);
    REQUIRE(both);
    const SolidMesh mesh = hooke::geometry::solid_mesh_of(both.value());
    CHECK(is_manifold(mesh));
    CHECK(volume_of(mesh) == doctest::Approx(12).epsilon(1e-7));
    other.triangles.pop_back();
    const auto open = hooke::combine_solids(cube, other, SolidOperation::kUnion);
    REQUIRE_FALSE(open);
    CHECK(open.error().where.find("b.mesh.triangles[") == 0);
    const auto none = hooke::combine_solids({}, cube, SolidOperation::kUnion);
    REQUIRE_FALSE(none);
    CHECK(none.error().where == "a.mesh.triangles");
  }
}
