#include "geometry/mesh/geodesic.h"

#include "base/hash.h"
#include "geometry/meshes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using hooke::MeshDesc;
using hooke::Real;
using hooke::Vec3;
using hooke::geometry::GeodesicField;

namespace {

GeodesicField field_of(const MeshDesc& mesh, const std::vector<std::uint32_t>& sources) {
  const auto topology = hooke::geometry::compute_topology(mesh.positions.size(), mesh.triangles);
  return hooke::geometry::compute_geodesic_field(mesh.positions, mesh.triangles, topology, sources);
}

double straight_distance(const MeshDesc& mesh, std::uint32_t a, std::uint32_t b) {
  return hooke::length(hooke::vector_cast<double>(mesh.positions[a] - mesh.positions[b]));
}

double offset_of_one(std::mt19937& random) {
  return static_cast<double>(random()) / 2147483648.0 - 1.0;
}

/// A flat sheet whose inner points have been moved by up to `amount` cells; triangles may get obtuse.
MeshDesc make_uneven_grid(std::uint32_t size, double amount) {
  MeshDesc mesh = hooke::test::make_grid(size, size, Real(1));
  std::mt19937 random(1);
  for (std::uint32_t row = 1; row + 1 < size; ++row) {
    for (std::uint32_t column = 1; column + 1 < size; ++column) {
      const Real x = static_cast<Real>(amount * offset_of_one(random));
      const Real y = static_cast<Real>(amount * offset_of_one(random));
      mesh.positions[row * size + column] += Vec3{x, y, Real(0)};
    }
  }
  return mesh;
}

}  // namespace

TEST_SUITE("geometry/geodesic") {
  TEST_CASE("on a flat sheet the way along the surface is the straight line") {
    const MeshDesc mesh = hooke::test::make_grid(41, 41, Real(0.1));
    for (const std::uint32_t source : {0u, 20u * 41u + 20u, 40u}) {
      const auto field = field_of(mesh, {source});
      for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const double exact = straight_distance(mesh, source, v);
        CHECK(field.distance[v] >= exact * (1.0 - 1e-6));
        CHECK(field.distance[v] <= exact * (1.0 + 1e-5));
        CHECK(field.source[v] == source);
      }
    }
  }

  TEST_CASE("uneven and obtuse triangles change a flat sheet's distances by less than two percent") {
    const MeshDesc mesh = make_uneven_grid(41, 0.45);
    const std::uint32_t source = 20 * 41 + 20;
    const auto field = field_of(mesh, {source});
    double worst = 0.0;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const double exact = straight_distance(mesh, source, v);
      CHECK(field.distance[v] >= exact * (1.0 - 1e-6));
      if (exact > 5.0) worst = std::max(worst, field.distance[v] / exact - 1.0);
    }
    CHECK(worst < 0.02);
  }

  TEST_CASE("on a sphere the distance is the radius times the angle") {
    const MeshDesc mesh = hooke::test::make_sphere(5);
    const std::uint32_t source = 17;
    const auto field = field_of(mesh, {source});
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const double chord = std::min(1.0, 0.5 * straight_distance(mesh, source, v));
      const double exact = 2.0 * std::asin(chord);
      CHECK(field.distance[v] >= 2.0 * chord * (1.0 - 1e-6));
      // 1.1 % too short at the farthest with 8192 triangles; halves with about four times as many.
      if (exact > 0.2) CHECK(std::fabs(field.distance[v] / exact - 1.0) < 0.013);
    }
  }

  TEST_CASE("with a whole row as source every point measures to the nearest point of the row") {
    const MeshDesc mesh = make_uneven_grid(31, 0.3);
    std::vector<std::uint32_t> row(31);
    for (std::uint32_t column = 0; column < 31; ++column) row[column] = column;
    const auto field = field_of(mesh, row);
    for (std::uint32_t v = 31; v < mesh.positions.size(); ++v) {
      double exact = std::numeric_limits<double>::infinity();
      for (const std::uint32_t source : row) exact = std::min(exact, straight_distance(mesh, source, v));
      CHECK(field.distance[v] >= exact * (1.0 - 1e-6));
      CHECK(field.distance[v] <= exact * 1.03 + 0.05);
      REQUIRE(field.source[v] < 31);
      CHECK(field.distance[v] >= straight_distance(mesh, field.source[v], v) * (1.0 - 1e-6));
    }
  }

  TEST_CASE("a sheet rolled to half a tube keeps the distances from its straight edge") {
    MeshDesc mesh = make_uneven_grid(31, 0.3);
    const MeshDesc flat = mesh;
    const double radius = 30.0 / 3.14159265;
    for (Vec3& p : mesh.positions) {
      const double angle = p.y / radius;
      p.y = static_cast<Real>(radius * std::sin(angle));
      p.z = static_cast<Real>(radius * (1.0 - std::cos(angle)));
    }
    std::vector<std::uint32_t> row(31);
    for (std::uint32_t column = 0; column < 31; ++column) row[column] = column;
    const auto field = field_of(mesh, row);
    for (std::uint32_t v = 5 * 31; v < mesh.positions.size(); ++v) {
      // Between two sources the front runs ahead by what a straight line is nearer than its points: below
      // 0.02.
      CHECK(field.distance[v] >= flat.positions[v].y * 0.997 - 0.02);
      CHECK(field.distance[v] <= flat.positions[v].y * 1.015 + 0.02);
    }
  }

  TEST_CASE("a slit is walked around, not across") {
    // The sheet is cut along row 10 from the left border to column 15: the lower copy of each point there
    // belongs to the triangles below.
    MeshDesc mesh = hooke::test::make_grid(21, 21, Real(1));
    const auto copies_begin = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t column = 0; column < 15; ++column) {
      mesh.positions.push_back(mesh.positions[10 * 21 + column]);
    }
    for (std::size_t t = 0; t < 400; ++t) {
      for (std::uint32_t& vertex : mesh.triangles[t]) {
        if (vertex >= 210 && vertex < 225) vertex = copies_begin + (vertex - 210);
      }
    }
    const std::uint32_t source = 5 * 21;  // at (0, 5); the tip is at (15, 10)
    const auto field = field_of(mesh, {source});
    const double to_tip = std::sqrt(15.0 * 15.0 + 5.0 * 5.0);
    CHECK(field.distance[225] == doctest::Approx(to_tip).epsilon(1e-4));
    CHECK(field.distance[210] == doctest::Approx(to_tip + 15.0).epsilon(1e-4));
    const std::uint32_t behind = 15 * 21;  // (0, 15)
    // The march remembers how far the source is, not where the way last bent: 1.2 % too long here.
    CHECK(field.distance[behind] == doctest::Approx(2.0 * to_tip).epsilon(0.02));
  }

  TEST_CASE("a folded sheet keeps the distances it had when flat") {
    MeshDesc mesh = hooke::test::make_grid(21, 21, Real(1));
    const auto flat = field_of(mesh, {0});
    for (Vec3& p : mesh.positions) {
      if (p.x > Real(10)) p = {Real(10), p.y, p.x - Real(10)};
    }
    const auto folded = field_of(mesh, {0});
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      CHECK(folded.distance[v] == doctest::Approx(flat.distance[v]).epsilon(1e-5));
    }
  }

  TEST_CASE("the distances have the recorded bits on every compiler" *
            doctest::skip(sizeof(Real) != sizeof(float))) {
    const auto field = field_of(hooke::test::make_sphere(4), {3, 17, 400});
    hooke::base::StateHash hash;
    hash.add(field.distance);
    hash.add(field.source);
    CHECK(hash.value() == 14480922335634353566ULL);
  }

  TEST_CASE("what no source can reach is infinitely far") {
    MeshDesc mesh = hooke::test::make_grid(3, 3, Real(1));
    mesh.positions.insert(mesh.positions.end(), {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
    mesh.triangles.push_back({9, 10, 11});
    const auto field = field_of(mesh, {4, 4, 1000});
    CHECK(field.distance[4] == Real(0));
    CHECK(std::isfinite(field.distance[8]));
    for (std::uint32_t v = 9; v < 12; ++v) {
      CHECK(std::isinf(field.distance[v]));
      CHECK(field.source[v] == hooke::geometry::kNone);
    }
    CHECK(std::isinf(field_of(mesh, {}).distance[0]));
  }

  TEST_CASE("points in one place and triangles without area are passed through") {
    MeshDesc mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {2, 4, 3}};
    const auto field = field_of(mesh, {0});
    const std::vector<Real> expected = {0, 0, 1, 3, 2};
    CHECK(field.distance == expected);
  }
}
