#include "elements/dihedral.h"

#include <doctest/doctest.h>

#include <numbers>

namespace hooke::elements {

TEST_SUITE("elements/dihedral") {
  const DVec3 kPoints[4] = {{0.1, 0.2, 0.0}, {1.2, -0.1, 0.3}, {0.4, 0.9, 0.2}, {0.7, -1.1, 0.5}};

  TEST_CASE("the gradient is that of finite differences") {
    const auto d = dihedral(kPoints[0], kPoints[1], kPoints[2], kPoints[3]);
    REQUIRE(d.valid);
    for (int point = 0; point < 4; ++point) {
      for (int axis = 0; axis < 3; ++axis) {
        const double step = 1e-6;
        const auto angle = [&](double by) {
          DVec3 p[4] = {kPoints[0], kPoints[1], kPoints[2], kPoints[3]};
          (&p[point].x)[axis] += by;
          return dihedral(p[0], p[1], p[2], p[3]).angle;
        };
        const double slope = (angle(step) - angle(-step)) / (2 * step);
        const double expected = (&d.gradient[static_cast<std::size_t>(point)].x)[axis];
        CHECK(slope == doctest::Approx(expected).epsilon(1e-6));
      }
    }
  }

  TEST_CASE("moving or turning all four points changes nothing") {
    const auto d = dihedral(kPoints[0], kPoints[1], kPoints[2], kPoints[3]);
    DVec3 force = {};
    DVec3 torque = {};
    for (std::size_t i = 0; i < 4; ++i) {
      force += d.gradient[i];
      torque += cross(kPoints[i], d.gradient[i]);
    }
    CHECK(length(force) < 1e-14);
    CHECK(length(torque) < 1e-14);
  }

  TEST_CASE("a fold by a known angle has that angle") {
    for (const double angle : {-2.5, -0.3, 0.0, 1.0, 3.0}) {
      // Wing b lies in the plane; wing a is turned up about the edge, away from it by -angle.
      const DVec3 wing = {0.5, std::cos(angle), -std::sin(angle)};
      const auto d = dihedral(DVec3{0, 0, 0}, DVec3{1, 0, 0}, wing, DVec3{0.5, -1, 0});
      CHECK(d.angle == doctest::Approx(angle).epsilon(1e-12));
    }
  }

  TEST_CASE("triangles of no area have no angle") {
    CHECK_FALSE(dihedral(DVec3{0, 0, 0}, DVec3{1, 0, 0}, DVec3{0.5, 0, 0}, DVec3{0.5, -1, 0}).valid);
    CHECK_FALSE(dihedral(DVec3{0, 0, 0}, DVec3{0, 0, 0}, DVec3{0.5, 1, 0}, DVec3{0.5, -1, 0}).valid);
  }
}

}  // namespace hooke::elements
