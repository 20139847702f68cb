#include "hooke/geometry.h"

#include "constants.h"
#include "geometry/convex/convex_hull.h"
#include "geometry/convex/mass_properties.h"
#include "geometry/meshes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <utility>
#include <vector>

using hooke::decompose_convex;
using hooke::MeshDesc;
using hooke::Real;
using hooke::Vec3;

namespace {

std::vector<MeshDesc> parts_of(const MeshDesc& mesh, double concavity_max, int parts_max = 64) {
  auto parts = decompose_convex(mesh, Real(concavity_max), parts_max);
  REQUIRE(parts.has_value());
  return std::move(parts).value();
}

double volume_of(const MeshDesc& mesh) {
  return hooke::geometry::mass_of(mesh.positions, mesh.triangles).volume;
}

double volume_of(const std::vector<MeshDesc>& parts) {
  double sum = 0;
  for (const MeshDesc& part : parts) sum += volume_of(part);
  return sum;
}

/// A polygon in the plane of x and y, counter-clockwise, drawn out from z = 0 to z = depth. `caps`: its
/// triangles.
MeshDesc make_extruded(const std::vector<std::array<Real, 2>>& outline,
                       const std::vector<std::array<std::uint32_t, 3>>& caps, Real depth) {
  MeshDesc mesh;
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (const Real z : {Real(0), depth}) {
    for (const auto& [x, y] : outline) mesh.positions.push_back({x, y, z});
  }
  for (const auto& [a, b, c] : caps) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + count, b + count, c + count});
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    mesh.triangles.push_back({i, next, next + count});
    mesh.triangles.push_back({i, next + count, i + count});
  }
  return mesh;
}

MeshDesc make_torus(double major, double minor, std::uint32_t around, std::uint32_t across) {
  MeshDesc mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t k = 0; k < across; ++k) {
      const double u = 2 * hooke::test::kPi * i / around;
      const double v = 2 * hooke::test::kPi * k / across;
      const double r = major + minor * std::cos(v);
      mesh.positions.push_back({Real(r * std::cos(u)), Real(minor * std::sin(v)), Real(r * std::sin(u))});
      const std::uint32_t next_i = (i + 1) % around * across;
      const std::uint32_t next_k = (k + 1) % across;
      const std::uint32_t a = i * across + k;
      const std::uint32_t b = next_i + k;
      const std::uint32_t c = next_i + next_k;
      const std::uint32_t d = i * across + next_k;
      mesh.triangles.push_back({a, d, c});
      mesh.triangles.push_back({a, c, b});
    }
  }
  return mesh;
}

const MeshDesc kL = make_extruded({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}},
                                  {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, 1);

}  // namespace

TEST_SUITE("geometry/convex_parts") {
  TEST_CASE("a convex solid is its only part") {
    const std::vector<MeshDesc> parts = parts_of(hooke::test::make_cube(1), 0.01);
    REQUIRE(parts.size() == 1);
    CHECK(parts[0].positions.size() == 8);
    CHECK(volume_of(parts) == 8.0);
  }

  TEST_CASE("an L is two boxes of exactly its volume") {
    CHECK(volume_of(kL) == 4.0);
    const std::vector<MeshDesc> parts = parts_of(kL, 0.01);
    REQUIRE(parts.size() == 2);
    for (const MeshDesc& part : parts) CHECK(part.positions.size() == 8);
    CHECK(volume_of(parts) == doctest::Approx(4.0).epsilon(1e-12));
  }

  TEST_CASE("a turned L is two boxes of its volume") {
    MeshDesc turned = kL;
    for (Vec3& p : turned.positions) p = rotate(hooke::quaternion_about(Vec3{1, 2, 3}, Real(0.8)), p);
    const std::vector<MeshDesc> parts = parts_of(turned, 0.01);
    REQUIRE(parts.size() == 2);
    for (const MeshDesc& part : parts) CHECK(part.positions.size() == 8);
    CHECK(volume_of(parts) == doctest::Approx(4.0).epsilon(1e-5));
  }

  TEST_CASE("a U, whose notch has corners only on the outside, is three boxes") {
    const MeshDesc u = make_extruded({{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                                     {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}}, 4);
    CHECK(volume_of(u) == 20.0);
    const std::vector<MeshDesc> parts = parts_of(u, 0.01);
    CHECK(parts.size() == 3);
    CHECK(volume_of(parts) == doctest::Approx(20.0).epsilon(1e-12));
  }

  TEST_CASE("a torus is about a dozen parts of its volume to a few percent") {
    const MeshDesc torus = make_torus(1, 0.3, 32, 12);
    const double volume = volume_of(torus);
    CHECK(volume == doctest::Approx(2 * hooke::test::kPi * hooke::test::kPi * 0.09).epsilon(0.06));
    const std::vector<MeshDesc> parts = parts_of(torus, 0.05);
    CAPTURE(volume_of(parts) / volume);
    CHECK(parts.size() >= 8);
    CHECK(parts.size() <= 16);
    CHECK(volume_of(parts) > 0.999 * volume);
    CHECK(volume_of(parts) < 1.05 * volume);
  }

  TEST_CASE("there are no more parts than allowed, and no less of the solid") {
    const MeshDesc torus = make_torus(1, 0.3, 16, 8);
    for (const int parts_max : {1, 2, 3, 5}) {
      const std::vector<MeshDesc> parts = parts_of(torus, 0.001, parts_max);
      CHECK(parts.size() <= std::size_t(parts_max));
      std::vector<hooke::geometry::ConvexHull> hulls;
      for (const MeshDesc& part : parts) {
        auto hull = hooke::geometry::make_convex_hull(part.positions);
        REQUIRE(hull.has_value());
        hulls.push_back(std::move(hull).value());
      }
      for (const Vec3 p : torus.positions) {
        Real nearest = std::numeric_limits<Real>::infinity();
        for (const auto& hull : hulls) {
          Real outside = -std::numeric_limits<Real>::infinity();
          for (const auto& face : hull.faces) {
            outside = std::max(outside, dot(face.normal, p) - face.offset);
          }
          nearest = std::min(nearest, outside);
        }
        CHECK(nearest < Real(3e-4));
      }
    }
  }

  TEST_CASE("what is no solid, or no sensible wish, is an error") {
    const auto where_of = [](const MeshDesc& mesh, double concavity_max, int parts_max) {
      const auto parts = decompose_convex(mesh, Real(concavity_max), parts_max);
      REQUIRE_FALSE(parts.has_value());
      return parts.error().where;
    };
    const MeshDesc cube = hooke::test::make_cube(1);
    CHECK(where_of(cube, 0, 4) == "concavity_max");
    CHECK(where_of(cube, std::nan(""), 4) == "concavity_max");
    CHECK(where_of(cube, std::numeric_limits<double>::infinity(), 4) == "concavity_max");
    CHECK(where_of(cube, 0.1, 0) == "parts_max");
    CHECK(where_of(cube, 0.1, 257) == "parts_max");
    CHECK(where_of(hooke::test::make_grid(3, 3, 1), 0.1, 4) == "mesh.triangles[0]");
    MeshDesc foil = cube;
    for (Vec3& p : foil.positions) p.y *= Real(1e-6);
    CHECK(where_of(foil, 0.1, 4) == "points");
  }
}
