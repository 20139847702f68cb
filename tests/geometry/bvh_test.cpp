#include "geometry/mesh/bvh.h"

#include "base/hash.h"
#include "geometry/closest.h"
#include "geometry/meshes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <set>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Real;
using hooke::Vec3;
using hooke::geometry::Box;
using hooke::geometry::Bvh;
using hooke::geometry::BvhNode;

namespace {

Real signed_unit(std::mt19937& random) {
  return static_cast<Real>(static_cast<double>(random()) / 2147483648.0 - 1.0);
}
Vec3 random_vector(std::mt19937& random) {
  const Real x = signed_unit(random);
  const Real y = signed_unit(random);
  return {x, y, signed_unit(random)};
}

/// Loose triangles of all sizes, some on top of each other.
MeshDesc make_soup(std::uint32_t count) {
  std::mt19937 random(1);
  MeshDesc mesh;
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vec3 center = t % 17 == 0 ? Vec3{} : random_vector(random);
    const Real size = Real(0.3) * std::fabs(signed_unit(random) * signed_unit(random));
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + size * random_vector(random));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

/// A sheet about the origin, in the plane z = 0.
MeshDesc make_sheet() {
  MeshDesc mesh = hooke::test::make_grid(17, 17, Real(1.0 / 8.0));
  for (Vec3& p : mesh.positions) p -= {Real(1), Real(1), Real(0)};
  return mesh;
}

Bvh bvh_of(const MeshDesc& mesh) {
  return hooke::geometry::build_bvh(mesh.positions, mesh.triangles);
}

std::array<Vec3, 3> corners_of(const MeshDesc& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
}

/// Fraction where the ray meets the triangle by the textbook: the plane, then three sides. Infinity if it
/// does not.
double textbook_hit(DVec3 origin, DVec3 direction, const std::array<Vec3, 3>& corners) {
  const DVec3 a = hooke::vector_cast<double>(corners[0]);
  const DVec3 b = hooke::vector_cast<double>(corners[1]);
  const DVec3 c = hooke::vector_cast<double>(corners[2]);
  const DVec3 normal = hooke::cross(b - a, c - a);
  const double fraction = hooke::dot(a - origin, normal) / hooke::dot(direction, normal);
  const DVec3 hit = origin + fraction * direction;
  const auto is_left = [&](DVec3 from, DVec3 to) {
    return hooke::dot(hooke::cross(to - from, hit - from), normal) >= 0.0;
  };
  const bool is_hit = fraction >= 0.0 && is_left(a, b) && is_left(b, c) && is_left(c, a);
  return is_hit ? fraction : std::numeric_limits<double>::infinity();
}

void check_box_queries(const MeshDesc& mesh, int queries) {
  const Bvh bvh = bvh_of(mesh);
  std::mt19937 random(2);
  std::vector<std::uint32_t> found = {7};
  std::size_t total = 0;
  for (int i = 0; i < queries; ++i) {
    const Vec3 center = Real(1.2) * random_vector(random);
    const Real size = Real(0.5) * std::fabs(signed_unit(random) * signed_unit(random));
    const Box box = {center - Vec3{size, size, size}, center + Vec3{size, size, size}};
    std::vector<std::uint32_t> expected;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [a, b, c] = corners_of(mesh, t);
      if (overlap(hooke::geometry::box_of(a, b, c), box)) expected.push_back(t);
    }
    hooke::geometry::find_triangles(bvh, box, found);
    total += found.size();
    CHECK(found == expected);
  }
  CHECK(total > 0);
}

void check_closest_queries(const MeshDesc& mesh, int queries) {
  const Bvh bvh = bvh_of(mesh);
  std::mt19937 random(3);
  for (int i = 0; i < queries; ++i) {
    const Vec3 p = Real(2) * random_vector(random);
    Real nearest = std::numeric_limits<Real>::infinity();
    std::uint32_t expected = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [a, b, c] = corners_of(mesh, t);
      const Real candidate = hooke::geometry::closest_on_triangle(p, a, b, c).distance_squared;
      if (candidate < nearest) expected = t;
      nearest = std::min(nearest, candidate);
    }
    const auto found = hooke::geometry::find_closest(bvh, p);
    REQUIRE(found);
    CHECK(found->distance_squared == nearest);
    CHECK(found->triangle == expected);
    CHECK(hooke::length_squared(p - found->point) == nearest);
    const Real distance = std::sqrt(nearest);
    CHECK_FALSE(hooke::geometry::find_closest(bvh, p, distance * Real(0.999)));
    CHECK(hooke::geometry::find_closest(bvh, p, distance * Real(1.001))->triangle == expected);
  }
}

void check_rays(const MeshDesc& mesh, int queries) {
  const Bvh bvh = bvh_of(mesh);
  std::mt19937 random(4);
  int hits = 0;
  for (int i = 0; i < queries; ++i) {
    const DVec3 origin = hooke::vector_cast<double>(Real(2) * random_vector(random));
    const DVec3 aim = hooke::vector_cast<double>(Real(0.9) * random_vector(random));
    const DVec3 direction = 0.7 * (aim - origin);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      nearest = std::min(nearest, textbook_hit(origin, direction, corners_of(mesh, t)));
    }
    const auto found = hooke::geometry::cast_ray(bvh, origin, direction);
    CHECK(found.has_value() == std::isfinite(nearest));
    if (!found) continue;
    ++hits;
    CHECK(found->fraction == doctest::Approx(nearest).epsilon(1e-9));
    CHECK(textbook_hit(origin, direction, corners_of(mesh, found->triangle)) ==
          doctest::Approx(nearest).epsilon(1e-9));
    CHECK_FALSE(hooke::geometry::cast_ray(bvh, origin, direction, 0.999 * nearest));
  }
  CHECK(hits > queries / 10);
}

/// Levels below the root.
std::size_t depth_of(const Bvh& bvh) {
  std::vector<std::size_t> ends;  // of the inner nodes around the present one
  std::size_t deepest = 0;
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    while (!ends.empty() && ends.back() <= i) ends.pop_back();
    deepest = std::max(deepest, ends.size());
    if (bvh.nodes[i].count == 0) ends.push_back(bvh.nodes[i].next);
  }
  return deepest;
}

/// Whether every node's box holds what is below it, and leaves list every triangle once.
void check_structure(const MeshDesc& mesh, const Bvh& bvh) {
  const std::set<std::uint32_t> listed(bvh.order.begin(), bvh.order.end());
  CHECK(listed.size() == mesh.triangles.size());
  CHECK(bvh.order.size() == mesh.triangles.size());
  REQUIRE_FALSE(bvh.nodes.empty());
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    const Box box = {node.lower, node.upper};
    if (node.count == 0) {
      REQUIRE(node.next > i + 2);
      REQUIRE(node.next <= bvh.nodes.size());
      for (std::size_t below = i + 1; below < node.next; ++below) {
        const Box inner = {bvh.nodes[below].lower, bvh.nodes[below].upper};
        CHECK(merge(box, inner) == box);
      }
      continue;
    }
    CHECK(node.count <= 4);
    for (std::uint32_t k = node.next; k < node.next + node.count; ++k) {
      const auto [a, b, c] = corners_of(mesh, bvh.order[k]);
      CHECK(bvh.corners[k] == std::array<Vec3, 3>{a, b, c});
      CHECK(merge(box, hooke::geometry::box_of(a, b, c)) == box);
    }
  }
}

}  // namespace

TEST_SUITE("geometry/bvh") {
  TEST_CASE("every box holds what lies below it and every triangle lies in one leaf") {
    for (const std::uint32_t count : {1u, 4u, 5u, 6u, 1000u}) {
      const MeshDesc mesh = make_soup(count);
      check_structure(mesh, bvh_of(mesh));
    }
  }

  TEST_CASE("a box finds exactly the triangles whose boxes it touches, in order") {
    check_box_queries(make_soup(400), 2000);
    check_box_queries(make_sheet(), 2000);
  }

  TEST_CASE("the nearest triangle is that of a search through all of them") {
    check_closest_queries(make_soup(400), 2000);
    check_closest_queries(make_sheet(), 2000);
  }

  TEST_CASE("a ray hits what a search through all triangles hits first") {
    check_rays(make_soup(400), 2000);
    check_rays(make_sheet(), 2000);
  }

  TEST_CASE("no ray slips through the seams of a sheet") {
    const MeshDesc mesh = make_sheet();
    const Bvh bvh = bvh_of(mesh);
    std::mt19937 random(5);
    for (int i = 0; i < 2000; ++i) {
      // At inner vertices and at the middles of edges, from slanted directions.
      const std::uint32_t row = 1 + random() % 15;
      const std::uint32_t column = 1 + random() % 15;
      const DVec3 a = hooke::vector_cast<double>(mesh.positions[row * 17 + column]);
      const DVec3 b = hooke::vector_cast<double>(mesh.positions[row * 17 + column + (i % 3 == 0 ? 18 : 1)]);
      const DVec3 target = i % 2 == 0 ? a : 0.5 * (a + b);
      const DVec3 offset = hooke::vector_cast<double>(random_vector(random)) + DVec3{0, 0, 1.5};
      const auto hit = hooke::geometry::cast_ray(bvh, target + offset, -offset);
      REQUIRE(hit);
      CHECK(hit->fraction == doctest::Approx(1.0).epsilon(1e-12));
    }
  }

  TEST_CASE("rays along the axes meet the sheet from both sides, and not from its plane") {
    const Bvh bvh = bvh_of(make_sheet());
    CHECK(hooke::geometry::cast_ray(bvh, {0.01, 0.02, 3}, {0, 0, -2})->fraction == doctest::Approx(1.5));
    CHECK(hooke::geometry::cast_ray(bvh, {0.01, 0.02, -3}, {0, 0, 2})->fraction == doctest::Approx(1.5));
    CHECK(hooke::geometry::cast_ray(bvh, {0.01, 0.02, 0}, {0, 0, 1})->fraction == 0.0);
    CHECK_FALSE(hooke::geometry::cast_ray(bvh, {0.01, 0.02, 3}, {0, 0, 2}));
    CHECK_FALSE(hooke::geometry::cast_ray(bvh, {-3, 0.02, 0}, {1, 0, 0}));
    CHECK_FALSE(hooke::geometry::cast_ray(bvh, {0.01, 0.02, 3}, {0, 0, 0}));
    CHECK_FALSE(hooke::geometry::cast_ray(bvh, {1.01, 0.02, 3}, {0, 0, -1}));
    CHECK(hooke::geometry::cast_ray(bvh, {1, 1, 3}, {0, 0, -1}));  // the very corner
  }

  TEST_CASE("of triangles in one place the one with the smallest index answers") {
    MeshDesc mesh = hooke::test::make_grid(2, 2, Real(1));
    for (int i = 0; i < 300; ++i) mesh.triangles.push_back(mesh.triangles[0]);
    const Bvh bvh = bvh_of(mesh);
    check_structure(mesh, bvh);
    CHECK(hooke::geometry::find_closest(bvh, {Real(0.6), Real(0.3), Real(1)})->triangle == 0);
    CHECK(hooke::geometry::cast_ray(bvh, {0.6, 0.3, 1}, {0, 0, -1})->triangle == 0);
  }

  TEST_CASE("above a vertex the smallest of the triangles around it answers") {
    MeshDesc mesh = make_sheet();
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());  // not the order in which the tree meets them
    const auto topology = hooke::geometry::compute_topology(mesh.positions.size(), mesh.triangles);
    const Bvh bvh = bvh_of(mesh);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 above = mesh.positions[v] + Vec3{0, 0, Real(0.5)};
      CHECK(hooke::geometry::find_closest(bvh, above)->triangle == topology.triangles_at(v)[0]);
      const DVec3 from = hooke::vector_cast<double>(above);
      CHECK(hooke::geometry::cast_ray(bvh, from, {0, 0, -1})->triangle == topology.triangles_at(v)[0]);
    }
  }

  TEST_CASE("the tree has the recorded bits on every compiler" *
            doctest::skip(sizeof(Real) != sizeof(float))) {
    const Bvh bvh = bvh_of(hooke::test::make_sphere(4));
    hooke::base::StateHash hash;
    hash.add(bvh.nodes);
    hash.add(bvh.order);
    CHECK(hash.value() == 7842095063405104180ULL);
  }

  TEST_CASE("triangles of exponentially growing distance do not make the tree too deep") {
    // Each is sixteen times as far as the one before: splits by surface take one or two off at a time.
    MeshDesc mesh;
    for (std::uint32_t i = 0; i < 60; ++i) {
      const Real x = static_cast<Real>(std::ldexp(1.0, 4 * static_cast<int>(i) - 120));
      mesh.positions.insert(mesh.positions.end(), {{x, 0, 0}, {x, x, 0}, {x, 0, x}});
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Bvh bvh = bvh_of(mesh);
    check_structure(mesh, bvh);
    CHECK(depth_of(bvh) > 36);
    CHECK(depth_of(bvh) <=
          36 + 5);  // then halves: 24 triangles are in leaves of four after three levels or four
    const auto hit = hooke::geometry::cast_ray(bvh, {0.5, 0.25, 0.25}, {1, 0, 0});
    REQUIRE(hit);
    CHECK(hit->triangle == 30);
    CHECK(hit->fraction == doctest::Approx(0.5));
  }

  TEST_CASE("a tree of nothing answers with nothing") {
    const Bvh bvh = hooke::geometry::build_bvh({}, {});
    std::vector<std::uint32_t> found = {1};
    hooke::geometry::find_triangles(bvh, {{-1, -1, -1}, {1, 1, 1}}, found);
    CHECK(found.empty());
    CHECK_FALSE(hooke::geometry::find_closest(bvh, {}));
    CHECK_FALSE(hooke::geometry::cast_ray(bvh, {}, {0, 1, 0}));
    // Nor does the empty box find anything in a tree of something.
    hooke::geometry::find_triangles(bvh_of(make_sheet()), {}, found);
    CHECK(found.empty());
  }
}
