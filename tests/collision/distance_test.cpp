#include "collision/distance/distance.h"

#include "collision/pairs.h"
#include "geometry/closest.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using hooke::Real;
using hooke::Shape;
using hooke::ShapeKind;
using hooke::Vec3;
using hooke::collision::Convex;
using hooke::collision::Distance;
using hooke::collision::distance_between;
using hooke::test::placed;
using hooke::test::random_shape;
using hooke::test::random_turn;
using hooke::test::random_unit;
using hooke::test::uniform;

namespace {

constexpr ShapeKind kRoundedKinds[] = {ShapeKind::kSphere, ShapeKind::kCapsule, ShapeKind::kBox,
                                       ShapeKind::kCylinder, ShapeKind::kCone};

}  // namespace

TEST_SUITE("collision/distance") {
  TEST_CASE("a sphere is as far from a box as the nearest point of the box says") {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
      const Shape box = random_shape(ShapeKind::kBox, random);
      const Shape sphere = random_shape(ShapeKind::kSphere, random);
      const Vec3 place = uniform(random, 0, 4) * random_unit(random);
      const auto known = hooke::geometry::closest_on_box(place, box.half_extents);
      const Distance d = distance_between(placed(box, {}, {}), placed(sphere, place, {}));
      CHECK(d.cores_overlap == (known.signed_distance <= Real(0)));
      if (d.cores_overlap) continue;
      CHECK(std::fabs(d.distance - (known.signed_distance - sphere.radius)) < Real(1e-5));
      CHECK(length(d.normal - known.normal) < Real(1e-3));
      CHECK(length(d.point_a - known.point) < Real(1e-4));
      CHECK(length(d.point_b - (place - sphere.radius * d.normal)) < Real(1e-5));
    }
  }

  TEST_CASE("capsules are as far apart as their segments") {
    std::mt19937 random(2);
    for (int i = 0; i < 2000; ++i) {
      const Convex a = placed(random_shape(ShapeKind::kCapsule, random), {}, random_turn(random));
      const Vec3 place = uniform(random, 0, 3) * random_unit(random);
      const Convex b = placed(random_shape(ShapeKind::kCapsule, random), place, random_turn(random));
      const auto ends = [](const Convex& c) {
        const Vec3 end = c.shape.half_height * c.axes.y;
        return hooke::geometry::Segment<Real>{c.center - end, c.center + end};
      };
      const auto known = hooke::geometry::closest_between_segments(ends(a), ends(b));
      const Real expected = std::sqrt(known.distance_squared) - a.shape.radius - b.shape.radius;
      CHECK(std::fabs(distance_between(a, b).distance - expected) < Real(1e-5));
    }
  }

  TEST_CASE("the distance is what the planes across the normal hold apart, and symmetric, for all shapes") {
    std::mt19937 random(3);
    for (const ShapeKind kind_a : kRoundedKinds) {
      for (const ShapeKind kind_b : kRoundedKinds) {
        for (int i = 0; i < 60; ++i) {
          const Convex a = placed(random_shape(kind_a, random), {}, random_turn(random));
          const Vec3 place = uniform(random, 0.5, 4) * random_unit(random);
          const Convex b = placed(random_shape(kind_b, random), place, random_turn(random));
          const Distance d = distance_between(a, b);
          const Distance mirrored = distance_between(b, a);
          CHECK(d.cores_overlap == mirrored.cores_overlap);
          CHECK(std::fabs(d.distance - mirrored.distance) < Real(2e-5));
          if (d.cores_overlap) continue;
          // A lower bound that is reached, and points that reach it: nothing else is the distance.
          CHECK(std::fabs(hooke::collision::separation_along(a, b, d.normal) - d.distance) < Real(1e-4));
          CHECK(std::fabs(length(d.point_b - d.point_a) - std::fabs(d.distance)) < Real(1e-5));
        }
      }
    }
  }

  TEST_CASE("shapes in the same place overlap, and nothing is ever not a number") {
    std::mt19937 random(4);
    for (const ShapeKind kind_a : kRoundedKinds) {
      for (const ShapeKind kind_b : kRoundedKinds) {
        const Convex a = placed(random_shape(kind_a, random), {}, {});
        const Convex b = placed(random_shape(kind_b, random), {}, {});
        const Distance d = distance_between(a, b);
        CHECK(d.cores_overlap);
        CHECK(d.normal == Vec3{});
        for (const Real size : {Real(1e-6), Real(1e6)}) {
          Convex far = b;
          far.center = {size, Real(0), size};
          const Distance e = distance_between(a, far);
          CHECK(std::isfinite(e.distance));
          CHECK(is_finite(e.normal));
          CHECK(is_finite(e.point_a));
        }
      }
    }
  }

  TEST_CASE("shapes farther apart than is asked for give a lower bound, and nearer ones their distance") {
    std::mt19937 random(7);
    int given_up = 0;
    for (const ShapeKind kind_a : kRoundedKinds) {
      for (const ShapeKind kind_b : kRoundedKinds) {
        for (int i = 0; i < 60; ++i) {
          const Convex a = placed(random_shape(kind_a, random), {}, random_turn(random));
          const Vec3 place = uniform(random, 0.5, 4) * random_unit(random);
          const Convex b = placed(random_shape(kind_b, random), place, random_turn(random));
          const Real enough = uniform(random, 0, 2);
          const Distance whole = distance_between(a, b);
          const Distance d = distance_between(a, b, enough);
          CHECK(d.cores_overlap == whole.cores_overlap);
          if (d.distance > enough) {
            CHECK(d.distance <= whole.distance + Real(1e-5));
            given_up += d.distance < Real(0.99) * whole.distance ? 1 : 0;
          } else {
            CHECK(d.distance == whole.distance);
            CHECK(d.normal == whole.normal);
          }
        }
      }
    }
    CHECK(given_up > 100);
  }

  TEST_CASE("a triangle seen from its front, its edge and its corner") {
    Convex triangle = {.shape = {.kind = ShapeKind::kMesh}};
    triangle.corners = {Vec3{Real(0), Real(0), Real(0)}, Vec3{Real(0), Real(0), Real(1)},
                        Vec3{Real(1), Real(0), Real(0)}};
    const Shape ball = Shape::sphere(Real(0.25));
    const auto distance_to = [&](double x, double y, double z) {
      return double(distance_between(triangle, placed(ball, {Real(x), Real(y), Real(z)}, {})).distance);
    };
    CHECK(distance_to(0.2, 1, 0.2) == doctest::Approx(0.75));
    CHECK(distance_to(0.5, 0.3, -0.4) == doctest::Approx(0.25));
    CHECK(distance_to(-1, 1, -1) == doctest::Approx(std::sqrt(3.0) - 0.25));
  }

  TEST_CASE("a capsule and a triangle are as far apart from either side") {
    std::mt19937 random(7);
    for (int i = 0; i < 2000; ++i) {
      Convex triangle = {.shape = {.kind = ShapeKind::kMesh}};
      for (Vec3& corner : triangle.corners) corner = uniform(random, 0, 2) * random_unit(random);
      const Convex capsule = placed(random_shape(ShapeKind::kCapsule, random),
                                    uniform(random, 0, 3) * random_unit(random), random_turn(random));
      const Distance d = distance_between(triangle, capsule);
      const Distance back = distance_between(capsule, triangle);
      REQUIRE(d.cores_overlap == back.cores_overlap);
      CHECK(std::fabs(d.distance - back.distance) < Real(1e-5));
      if (!d.cores_overlap && d.distance > Real(1e-2)) CHECK(length(d.normal + back.normal) < Real(1e-3));
    }
  }
}
