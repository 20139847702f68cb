#include "collision/distance/protrusion_gap.h"

#include "geometry/meshes.h"

#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

namespace hooke {

using collision::find_protrusion_gap;
using collision::ProtrusionGap;

namespace {

/// A cube from -1 to 1.
state::Mesh cube() {
  state::Mesh mesh;
  mesh.desc = test::make_cube(1);
  mesh.protrusions = geometry::find_protrusions(mesh.desc);
  return mesh;
}

/// All places where the element faces a protrusion, or has gone into it; the far sides of the cube lie
/// deeper.
std::vector<ProtrusionGap> gaps_of(const state::Mesh& mesh, std::vector<Vec3> corners) {
  std::vector<ProtrusionGap> gaps;
  for (std::uint32_t i = 0; i < mesh.protrusions.ends.size(); ++i) {
    const auto found = find_protrusion_gap(mesh, i, corners);
    if (!found.gap || found.gap->distance < Real(-0.5)) continue;
    CHECK(static_cast<double>(found.clearance) <=
          doctest::Approx(std::abs(static_cast<double>(found.gap->distance))));
    gaps.push_back(*found.gap);
  }
  return gaps;
}

}  // namespace

TEST_SUITE("collision/protrusion_gap") {
  TEST_CASE("a point beside an edge or a corner of a cube faces it; one over a face faces nothing") {
    const state::Mesh mesh = cube();
    const auto at_edge = gaps_of(mesh, {{Real(1.3), Real(1.4), Real(0.2)}});
    REQUIRE(at_edge.size() == 1);
    CHECK(static_cast<double>(at_edge[0].distance) == doctest::Approx(0.5));
    CHECK(static_cast<double>(at_edge[0].normal.x) == doctest::Approx(0.6));
    const auto at_corner = gaps_of(mesh, {{2, 3, 3}});
    REQUIRE(at_corner.size() == 1);
    CHECK(static_cast<double>(at_corner[0].distance) == doctest::Approx(3));
    CHECK(gaps_of(mesh, {{Real(0.3), Real(1.4), Real(0.2)}}).empty());
  }

  TEST_CASE("a segment across an edge faces it before, and is behind it after it went in") {
    const state::Mesh mesh = cube();
    for (const double depth : {-0.2, -0.001, 0.001, 0.2}) {
      const auto far = static_cast<Real>(2 - depth * std::sqrt(2.0));  // x + y there
      const auto gaps = gaps_of(mesh, {{far - 2, 2, Real(0.1)}, {2, far - 2, Real(0.1)}});
      REQUIRE(gaps.size() == 1);
      CHECK(static_cast<double>(gaps[0].distance) == doctest::Approx(-depth).epsilon(1e-3));
      CHECK(static_cast<double>(gaps[0].normal.x) == doctest::Approx(std::sqrt(0.5)));
      CHECK(static_cast<double>(gaps[0].normal.y) == doctest::Approx(std::sqrt(0.5)));
      CHECK(static_cast<double>(gaps[0].weight[0] + gaps[0].weight[1]) == doctest::Approx(1));
    }
  }

  TEST_CASE("the inside of a triangle faces a corner, and nothing else") {
    const state::Mesh mesh = cube();
    const std::array<Vec3, 3> corner = {Vec3{3, 0, 0}, Vec3{0, 3, 0}, Vec3{0, 0, 3}};
    const auto lifted = [&](double height) {
      const Vec3 up = static_cast<Real>(height / std::sqrt(3.0)) * Vec3{1, 1, 1};
      return std::vector<Vec3>{corner[0] + up, corner[1] + up, corner[2] + up};
    };
    for (const double height : {0.1, -0.1}) {
      const auto gaps = gaps_of(mesh, lifted(height));
      REQUIRE(gaps.size() == 1);
      CHECK(static_cast<double>(gaps[0].distance) == doctest::Approx(height).epsilon(1e-3));
      CHECK(static_cast<double>(gaps[0].weight[0]) == doctest::Approx(1.0 / 3));
    }
  }

  TEST_CASE("a segment hardly off a corner faces it along a direction of unit length") {
    const state::Mesh mesh = cube();
    const Vec3 middle = static_cast<Real>(1 + 1e-4) * Vec3{1, 1, 1};
    const Vec3 half = {Real(0.5), Real(-0.5), 0};
    const auto gaps = gaps_of(mesh, {middle - half, middle + half});
    REQUIRE(gaps.size() == 1);
    CHECK(static_cast<double>(length(gaps[0].normal)) == doctest::Approx(1).epsilon(1e-5));
    CHECK(static_cast<double>(gaps[0].distance) == doctest::Approx(1e-4 * std::sqrt(3.0)).epsilon(1e-2));
  }
}

}  // namespace hooke
