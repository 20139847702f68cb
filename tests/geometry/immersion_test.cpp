#include "geometry/convex/immersion.h"

#include "geometry/convex/mass_properties.h"
#include "math/rotation.h"

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using namespace hooke;
using namespace hooke::geometry;
using doctest::Approx;

namespace {

constexpr double kPi = std::numbers::pi;

Quaternion<double> turn(DVec3 axis, double angle) {
  return math::quaternion_of(angle * normalize(axis));
}

Immersion under(const Shape& shape, double level, Quaternion<double> rotation = {}, DVec3 position = {}) {
  return immersion({.shape = shape, .rotation = rotation, .position = position}, level);
}

/// Of a box.
Immersion box_under(Vec3 half_extents, double level, Quaternion<double> rotation = {}, DVec3 position = {}) {
  const ConvexHull hull = make_box_hull(half_extents);
  return immersion({Shape::box(half_extents), &hull, rotation, position}, level);
}

DVec3 center(const Immersion& part) {
  return (1 / part.volume) * part.moment;
}

void check_near(DVec3 a, DVec3 b, double tolerance = 1e-9) {
  CAPTURE(a.x);
  CAPTURE(a.y);
  CAPTURE(a.z);
  CHECK(length(a - b) < tolerance);
}

}  // namespace

TEST_SUITE("geometry/immersion") {
  TEST_CASE("an upright box is immersed by its depth, centered half way") {
    const Immersion part = box_under({Real(1), Real(2), Real(0.5)}, 4, {}, {3, 5, -7});
    CHECK(part.volume == Approx(2 * 1 * 1.0).epsilon(1e-12));
    check_near(center(part), {3, 3.5, -7});
  }

  TEST_CASE("the corner of a cube that stands on it is a tetrahedron, sqrt(3)/2 d^3") {
    // The diagonal is turned upright: the lowest corner is sqrt(3) below the center.
    const Quaternion<double> upright = turn({1, 0, -1}, -std::acos(1 / std::sqrt(3.0)));
    check_near(rotate(upright, DVec3{1, 1, 1}), {0, std::sqrt(3.0), 0});
    const double d = 0.4;
    const Immersion part = box_under({Real(1), Real(1), Real(1)}, d - std::sqrt(3.0), upright);
    CHECK(part.volume == Approx(std::sqrt(3.0) / 2 * d * d * d).epsilon(1e-9));
    check_near(center(part), {0, 0.75 * d - std::sqrt(3.0), 0}, 1e-7);
  }

  TEST_CASE("half a ball has its center 3/8 r off, a cap pi c^2 (3 r - c) / 3") {
    const Immersion half = under(Shape::sphere(Real(2)), 1, {}, {4, 1, 0});
    CHECK(half.volume == Approx(2.0 / 3 * kPi * 8).epsilon(1e-12));
    check_near(center(half), {4, 1 - 0.75, 0});
    CHECK(under(Shape::sphere(Real(2)), -1.5).volume == Approx(kPi * 0.25 * 5.5 / 3).epsilon(1e-12));
  }

  TEST_CASE("what is wholly below is the whole shape, what is above is nothing") {
    const Quaternion<double> any = turn({0.3, 0.2, 0.9}, 1.1);
    for (const Shape& shape : {Shape::sphere(Real(0.75)), Shape::capsule(Real(0.5), Real(1.25)),
                               Shape::cylinder(Real(0.5), Real(1.25)), Shape::cone(Real(0.5), Real(1.25))}) {
      const MassProperties whole =
          moved(mass_of(shape), {Real(any.x), Real(any.y), Real(any.z), Real(any.w)}, DVec3{1, 2, 3});
      const Immersion part = under(shape, 10, any, {1, 2, 3});
      CHECK(part.volume == Approx(whole.volume).epsilon(1e-12));
      check_near(center(part), whole.center, 1e-6);
      CHECK(under(shape, -10, any, {1, 2, 3}).volume == 0);
      CHECK(under(shape, -10, any, {1, 2, 3}).moment == DVec3{});
    }
    CHECK(box_under({Real(1), Real(2), Real(3)}, 10, any).volume == Approx(48).epsilon(1e-7));
    CHECK(box_under({Real(1), Real(2), Real(3)}, -10, any).volume == 0);
  }

  TEST_CASE("round shapes have the sections of circles, and halves lying down") {
    const Immersion standing = under(Shape::cylinder(Real(0.5), Real(1)), -0.25);
    CHECK(standing.volume == Approx(kPi * 0.25 * 0.75).epsilon(1e-12));
    check_near(center(standing), {0, -0.625, 0});
    const Shape capsule = Shape::capsule(Real(0.5), Real(1));
    const Immersion lying = under(capsule, 0, turn({0, 0, 1}, kPi / 2));
    CHECK(lying.volume == Approx(0.5 * mass_of(capsule).volume).epsilon(1e-9));
    // Half a cylinder of length 2 has its center 4 r / 3 pi below, half a ball 3 r / 8.
    const double tube = kPi * 0.25 / 2 * 2;
    const double ball = 2.0 / 3 * kPi * 0.125;
    const double below = (tube * 4 * 0.5 / (3 * kPi) + ball * 3 * 0.5 / 8) / (tube + ball);
    CHECK(-center(lying).y == Approx(below).epsilon(5e-3));
  }

  TEST_CASE("half-spaces and meshes have no volume") {
    CHECK(under(Shape::half_space(), 1).volume == 0);
    CHECK(under(Shape::of_mesh({}), 1).volume == 0);
  }

  TEST_CASE("a shadow is the area across the direction") {
    const ConvexHull hull = make_box_hull({Real(1), Real(2), Real(3)});
    const Shape shape = Shape::box({Real(1), Real(2), Real(3)});
    const PlacedShape box = {.shape = shape, .hull = &hull};
    CHECK(shadow_area(box, {0, 1, 0}) == Approx(2 * 6.0).epsilon(1e-12));
    CHECK(shadow_area(box, (1 / std::sqrt(3.0)) * DVec3{1, -1, 1}) ==
          Approx((24.0 + 12 + 8) / std::sqrt(3.0)).epsilon(1e-12));
    CHECK(shadow_area({.shape = Shape::sphere(Real(0.5))}, {0, 0, 1}) == Approx(kPi / 4).epsilon(1e-12));
    const Shape can = Shape::cylinder(Real(0.5), Real(2));
    CHECK(shadow_area({.shape = can}, {0, 1, 0}) == Approx(kPi / 4).epsilon(1e-12));
    CHECK(shadow_area({.shape = can}, {1, 0, 0}) == Approx(4.0).epsilon(6e-3));
  }
}
