#include "collision/manifold/manifold_points.h"
#include "collision/pairs.h"
#include "geometry/box.h"
#include "geometry/convex/convex_hull.h"

#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <memory>
#include <random>
#include <string>
#include <vector>

using hooke::Quat;
using hooke::Real;
using hooke::Shape;
using hooke::ShapeKind;
using hooke::Vec3;
using hooke::collision::ContactResult;
using hooke::collision::ContactResultPoint;
using hooke::collision::Convex;
using hooke::collision::Distance;
using hooke::collision::separation_along;
using hooke::geometry::ConvexHull;
using hooke::test::meeting_of;
using hooke::test::placed;
using hooke::test::random_shape;
using hooke::test::random_turn;
using hooke::test::random_unit;
using hooke::test::sampled_separation;
using hooke::test::uniform;

namespace {

constexpr ShapeKind kKinds[] = {ShapeKind::kSphere,   ShapeKind::kCapsule, ShapeKind::kBox,
                                ShapeKind::kCylinder, ShapeKind::kCone,    ShapeKind::kHull};
const Quat kQuarterAboutX = hooke::quaternion_about(Vec3{Real(1), Real(0), Real(0)}, Real(1.5707963268));

/// A random shape of a kind, and the hull if it is or has one.
struct Body {
  Convex convex;
  std::shared_ptr<ConvexHull> hull;
};

Body random_body(ShapeKind kind, Vec3 center, std::mt19937& random) {
  Body body;
  const Shape shape = random_shape(kind, random);
  if (kind == ShapeKind::kBox) {
    body.hull = std::make_shared<ConvexHull>(hooke::geometry::make_box_hull(shape.half_extents));
  } else if (kind == ShapeKind::kHull) {
    std::vector<Vec3> points;
    for (int i = 0; i < 20; ++i) points.push_back(uniform(random, 0.3, 1) * random_unit(random));
    body.hull = std::make_shared<ConvexHull>(hooke::geometry::make_convex_hull(points).value());
  }
  body.convex = placed(shape, center, random_turn(random), body.hull.get());
  return body;
}

/// Moves b along `direction` until a meeting finds it at the given separation, roughly.
void bring_to(const Convex& a, Convex& b, Vec3 direction, Real separation) {
  for (int i = 0; i < 12; ++i) {
    const ContactResult m = meeting_of(a, b, Real(10));
    b.center += Real(0.9) * (separation - m.separation) * direction;
  }
}

const ContactResultPoint& point(const ContactResult& result, int i) {
  return result.point[static_cast<std::size_t>(i)];
}

Real distance_to(const Convex& shape, Vec3 p) {
  return hooke::collision::distance_between(shape, placed(Shape::sphere(Real(0)), p, {})).distance;
}

/// What an axis may be worse than the best: faces are preferred to edges by 2 mm, and the rims of cylinders
/// and cones, where the separation has several maxima, are searched from a few places only.
Real allowed_loss(const Convex& a, const Convex& b) {
  const auto has_rim = [](const Convex& c) {
    return c.shape.kind == ShapeKind::kCylinder || c.shape.kind == ShapeKind::kCone;
  };
  return has_rim(a) || has_rim(b) ? Real(0.005) : Real(0.0021);
}

/// What holds for the meeting of any two shapes.
void check_meeting(const Convex& a, const Convex& b, const ContactResult& m) {
  CHECK(std::fabs(length(m.normal) - Real(1)) < Real(1e-5));
  // The shapes are held apart by what the meeting says, and no axis holds them farther apart.
  CHECK(std::fabs(separation_along(a, b, m.normal) - m.separation) < Real(1e-5));
  CHECK(sampled_separation(a, b) - m.separation < allowed_loss(a, b));
  REQUIRE(m.count > 0);
  for (int i = 0; i < m.count; ++i) {
    const ContactResultPoint& p = point(m, i);
    CHECK(std::fabs(dot(m.normal, p.on_b - p.on_a) - p.separation) < Real(1e-5));
    CHECK(p.separation > m.separation - Real(1e-3));
    CHECK(distance_to(a, p.on_a) < Real(1e-2));
    CHECK(distance_to(b, p.on_b) < Real(1e-2));
  }
}

ContactResult ball_meets(const Convex& shape, Vec3 place, Real radius) {
  return meeting_of(shape, placed(Shape::sphere(radius), place, {}));
}

}  // namespace

TEST_SUITE("collision/manifolds") {
  TEST_CASE("any two shapes that touch have the normal that holds them apart most, and points on both") {
    std::mt19937 random(7);
    for (const ShapeKind kind_a : kKinds) {
      for (const ShapeKind kind_b : kKinds) {
        for (const Real separation : {Real(0.01), Real(-0.002), Real(-0.01)}) {
          for (int i = 0; i < 4; ++i) {
            CAPTURE(int(kind_a));
            CAPTURE(int(kind_b));
            const Body a = random_body(kind_a, {}, random);
            const Vec3 direction = random_unit(random);
            Body b = random_body(kind_b, Real(2) * direction, random);
            bring_to(a.convex, b.convex, direction, separation);
            const ContactResult m = meeting_of(a.convex, b.convex, Real(0.05));
            if (std::fabs(m.separation - separation) > Real(0.01)) continue;
            if (m.separation > Real(0) && m.count == 0) continue;  // faces that pass each other
            check_meeting(a.convex, b.convex, m);
            const ContactResult mirrored = meeting_of(b.convex, a.convex, Real(0.05));
            CHECK(std::fabs(mirrored.separation - m.separation) < allowed_loss(a.convex, b.convex));
          }
        }
      }
    }
  }

  TEST_CASE("the meeting does not depend on where the two are") {
    std::mt19937 random(8);
    for (const ShapeKind kind_a : kKinds) {
      for (const ShapeKind kind_b : kKinds) {
        const Body a = random_body(kind_a, {}, random);
        const Vec3 direction = random_unit(random);
        Body b = random_body(kind_b, Real(2) * direction, random);
        bring_to(a.convex, b.convex, direction, Real(-0.01));
        const Quat turn = random_turn(random);
        const Vec3 shift = Real(5) * random_unit(random);
        const auto moved = [&](Convex c) {
          c.center = rotate(turn, c.center) + shift;
          c.axes = matrix_of(turn) * c.axes;
          return c;
        };
        const ContactResult m = meeting_of(a.convex, b.convex);
        const ContactResult other = meeting_of(moved(a.convex), moved(b.convex));
        CHECK(std::fabs(m.separation - other.separation) < Real(2e-4));
        if (m.axis == other.axis) CHECK(length(rotate(turn, m.normal) - other.normal) < Real(0.02));
      }
    }
  }

  TEST_CASE("boxes: signs and values of 1e5 random pairs are those of the distance") {
    std::mt19937 random(9);
    int overlapping = 0;
    for (int i = 0; i < 100000; ++i) {
      const Convex a = placed(random_shape(ShapeKind::kBox, random), {}, random_turn(random));
      const Vec3 place = uniform(random, 0.5, 2.5) * random_unit(random);
      const Convex b = placed(random_shape(ShapeKind::kBox, random), place, random_turn(random));
      const Distance d = hooke::collision::distance_between(a, b);
      const ContactResult m = meeting_of(a, b, Real(10));
      overlapping += d.cores_overlap ? 1 : 0;
      bool ok = std::isfinite(m.separation) && is_finite(m.normal);
      if (d.cores_overlap) {
        // Nothing but an overlap: no axis separates.
        ok = ok && m.separation < Real(1e-5) && m.count > 0;
        ok = ok && std::fabs(separation_along(a, b, m.normal) - m.separation) < Real(1e-4);
      } else {
        // The axes of faces and edges hold the boxes apart, by no more than their distance.
        ok = ok && m.separation > Real(-2e-3) && m.separation < d.distance + Real(1e-5);
        // Where a face or a pair of edges is nearest they hold them apart by all of it.
        const bool is_axis = std::fabs(separation_along(a, b, m.normal) - d.distance) < Real(1e-4);
        const bool same = length(m.normal - d.normal) < Real(2e-5);
        ok = ok && (!same || is_axis);
      }
      if (!ok) {
        CAPTURE(i);
        CHECK(ok);
      }
    }
    CHECK(overlapping > 20000);
    CHECK(overlapping < 80000);
  }

  TEST_CASE("hulls that wander about in each other have a point as deep as their overlap") {
    std::mt19937 random(11);
    int deep = 0;
    for (int walk = 0; walk < 200; ++walk) {
      // Boxes have edges of one direction: the axis of two is also that of others.
      const Body a = random_body(walk % 2 == 0 ? ShapeKind::kBox : ShapeKind::kHull, {}, random);
      const Vec3 direction = random_unit(random);
      Body b = random_body(walk % 4 < 2 ? ShapeKind::kBox : ShapeKind::kHull, Real(2) * direction, random);
      bring_to(a.convex, b.convex, direction, Real(-0.1));
      ContactResult m;
      for (int step = 0; step < 100; ++step) {
        b.convex.center += Real(0.005) * random_unit(random);
        b.convex.axes = matrix_of(hooke::quaternion_about(random_unit(random), Real(0.01))) * b.convex.axes;
        const std::uint32_t last_axis = m.axis;
        m.count = 0;
        collide_hulls(a.convex, b.convex, {.margin = Real(0.02), .last_axis = last_axis}, m);
        if (!(m.separation < Real(-0.01))) continue;
        ++deep;
        CHECK(deepest_of(m) < m.separation + Real(0.0025));
        CHECK(deepest_of(m) > m.separation - Real(1e-3));
      }
    }
    CHECK(deep > 12000);
  }

  TEST_CASE("a box and its hull meet alike") {
    std::mt19937 random(10);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 place = uniform(random, 0.1, 1.6) * random_unit(random);
      const Body a = random_body(ShapeKind::kBox, {}, random);
      const Body b = random_body(ShapeKind::kBox, place, random);
      ContactResult boxes;
      ContactResult hulls;
      collide_boxes(a.convex, b.convex, {.margin = Real(0.02)}, boxes);
      collide_hulls(a.convex, b.convex, {.margin = Real(0.02)}, hulls);
      if (boxes.separation > Real(0.02) && hulls.separation > Real(0.02)) continue;
      CHECK(std::fabs(boxes.separation - hulls.separation) < Real(1e-5));
      CHECK(length(boxes.normal - hulls.normal) < Real(1e-5));
      CHECK(boxes.count == hulls.count);
    }
  }

  TEST_CASE("cubes face to face have four corners, aligned, shifted or turned") {
    const Shape cube = Shape::box({Real(0.5), Real(0.5), Real(0.5)});
    const auto check = [&](Vec3 place, Quat turn, double area) {
      ContactResult m = meeting_of(placed(cube, {}, {}), placed(cube, place, turn));
      hooke::collision::reduce_points(m, Real(0.02), {});
      CHECK(m.normal == Vec3{Real(0), Real(1), Real(0)});
      REQUIRE(m.count == 4);
      Vec3 low = point(m, 0).on_a;
      Vec3 high = low;
      for (int i = 0; i < 4; ++i) {
        CHECK(std::fabs(point(m, i).separation + Real(0.001)) < Real(1e-6));
        CHECK(std::fabs(point(m, i).on_a.y - Real(0.5)) < Real(1e-6));
        low = hooke::geometry::min_of(low, point(m, i).on_a);
        high = hooke::geometry::max_of(high, point(m, i).on_a);
      }
      CHECK(double((high.x - low.x) * (high.z - low.z)) == doctest::Approx(area).epsilon(1e-4));
    };
    check({Real(0), Real(0.999), Real(0)}, {}, 1);
    check({Real(0.25), Real(0.999), Real(0.5)}, {}, 0.375);
    check({Real(1e-7), Real(0.999), Real(-1e-7)},
          hooke::quaternion_about(Vec3{Real(0), Real(1), Real(0)}, Real(1e-7)), 1);
  }

  TEST_CASE("crossing edges of boxes meet in one point") {
    const Shape beam = Shape::box({Real(1), Real(0.1), Real(0.1)});
    const double root = std::sqrt(0.02);
    const Quat on_edge = kQuarterAboutX * kQuarterAboutX;
    const Quat eighth = hooke::quaternion_about(Vec3{Real(1), Real(0), Real(0)}, Real(0.7853981634));
    const Quat across = hooke::quaternion_about(Vec3{Real(0), Real(1), Real(0)}, Real(1.2));
    const Convex lower = placed(beam, {}, eighth);
    const Convex upper = placed(beam, {Real(0), Real(2 * root - 0.001), Real(0)}, across * eighth * on_edge);
    const ContactResult m = meeting_of(lower, upper);
    CHECK(m.axis >= 7);
    REQUIRE(m.count == 1);
    CHECK(m.normal.y > Real(0.99999));
    CHECK(double(point(m, 0).separation) == doctest::Approx(-0.001).epsilon(1e-3).scale(0));
    CHECK(length(point(m, 0).on_a - Vec3{Real(0), Real(root), Real(0)}) < Real(1e-5));
  }

  TEST_CASE("thin plates one inside the other separate across their thickness") {
    const Shape plate = Shape::box({Real(1), Real(0.005), Real(1)});
    const ContactResult m =
        meeting_of(placed(plate, {}, {}), placed(plate, {Real(0.3), Real(0.004), Real(0)}, {}));
    CHECK(m.normal == Vec3{Real(0), Real(1), Real(0)});
    CHECK(double(m.separation) == doctest::Approx(-0.006).epsilon(1e-4).scale(0));
    CHECK(m.count >= 4);
  }

  TEST_CASE("concentric spheres separate upward, crossing capsules across both") {
    const Convex ball = placed(Shape::sphere(Real(0.5)), {}, {});
    const ContactResult balls = meeting_of(ball, ball);
    CHECK(std::fabs(balls.normal.y) == Real(1));
    CHECK(double(balls.separation) == doctest::Approx(-1));
    const Shape capsule = Shape::capsule(Real(0.2), Real(1));
    const ContactResult crossing = meeting_of(placed(capsule, {}, {}), placed(capsule, {}, kQuarterAboutX));
    CHECK(std::fabs(crossing.normal.x) == doctest::Approx(1));
    CHECK(double(crossing.separation) == doctest::Approx(-0.4));
    CHECK(crossing.count >= 1);
    const ContactResult same = meeting_of(placed(capsule, {}, {}), placed(capsule, {}, {}));
    CHECK(std::fabs(length(same.normal) - Real(1)) < Real(1e-6));
    CHECK(std::fabs(same.normal.y) < Real(1e-6));
  }

  TEST_CASE("a sphere meets cylinder and cone at side, end, rim and tip") {
    const Convex cylinder = placed(Shape::cylinder(Real(0.5), Real(1)), {}, {});
    const Real r = Real(0.25);
    CHECK(double(ball_meets(cylinder, {Real(0.75), Real(0.2), Real(0)}, r).separation) == doctest::Approx(0));
    CHECK(double(ball_meets(cylinder, {Real(0.1), Real(1.2), Real(0)}, r).separation) ==
          doctest::Approx(-0.05));
    const ContactResult rim = ball_meets(cylinder, {Real(0.65), Real(1.15), Real(0)}, r);
    CHECK(double(rim.separation) == doctest::Approx(0.15 * std::sqrt(2.0) - 0.25));
    CHECK(double(rim.normal.x) == doctest::Approx(std::sqrt(0.5)));
    CHECK(double(ball_meets(cylinder, {Real(0.4), Real(0), Real(0)}, r).separation) ==
          doctest::Approx(-0.35));
    const Convex cone = placed(Shape::cone(Real(1), Real(0.5)), {}, {});
    CHECK(double(ball_meets(cone, {Real(0), Real(0.7), Real(0)}, r).separation) == doctest::Approx(-0.05));
    const ContactResult side = ball_meets(cone, {Real(0.5) + r, r, Real(0)}, r);
    CHECK(double(side.separation) == doctest::Approx(r * (std::sqrt(2.0) - 1)));
    CHECK(double(side.normal.x) == doctest::Approx(std::sqrt(0.5)));
    CHECK(double(ball_meets(cone, {Real(0.1), Real(-0.7), Real(0)}, r).separation) == doctest::Approx(-0.05));
  }

  TEST_CASE("a cylinder that lies on a box touches along its side, straight up, however it is turned") {
    const Convex floor =
        placed(Shape::box({Real(5), Real(0.5), Real(5)}), {Real(0), Real(-0.5), Real(0)}, {});
    const Shape roller = Shape::cylinder(Real(0.3), Real(0.4));
    for (int i = 0; i < 100; ++i) {
      const Quat roll = hooke::quaternion_about(Vec3{Real(0), Real(1), Real(0)}, Real(0.13 * i));
      const Quat yaw = hooke::quaternion_about(Vec3{Real(0), Real(1), Real(0)}, Real(0.0713 * i));
      const ContactResult m =
          meeting_of(floor, placed(roller, {Real(0), Real(0.2999), Real(0)}, yaw * kQuarterAboutX * roll));
      CHECK(m.normal == Vec3{Real(0), Real(1), Real(0)});
      REQUIRE(m.count == 2);
      for (int k = 0; k < 2; ++k) {
        CHECK(std::fabs(point(m, k).separation + Real(1e-4)) < Real(1e-6));
        CHECK(std::fabs(length(point(m, k).on_a) - Real(0.4)) < Real(1e-5));
      }
    }
  }

  TEST_CASE("a standing cylinder has four points on its rim, on a box, a cylinder and in overlap") {
    const Shape can = Shape::cylinder(Real(0.3), Real(0.5));
    const Convex upper = placed(can, {Real(0), Real(0.999), Real(0)}, {});
    ContactResult m = meeting_of(placed(Shape::box({Real(1), Real(0.5), Real(1)}), {}, {}), upper);
    CHECK(m.normal == Vec3{Real(0), Real(1), Real(0)});
    REQUIRE(m.count == 4);
    for (int i = 0; i < 4; ++i) {
      const Vec3 p = point(m, i).on_b;
      CHECK(std::fabs(std::sqrt(p.x * p.x + p.z * p.z) - Real(0.3)) < Real(1e-5));
    }
    // A box smaller than the end stands on its own corners.
    m = meeting_of(
        upper, placed(Shape::box({Real(0.1), Real(0.1), Real(0.1)}), {Real(0), Real(1.598), Real(0)}, {}));
    REQUIRE(m.count == 4);
    CHECK(std::fabs(point(m, 0).on_b.x) == doctest::Approx(0.1));
    // Two cans, one shifted: the lens of their ends is as wide as it should be.
    m = meeting_of(placed(can, {}, {}), placed(can, {Real(0.3), Real(0.999), Real(0)}, {}));
    hooke::collision::reduce_points(m, Real(0.02), {});
    REQUIRE(m.count == 4);
    Real width = Real(0);
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < i; ++k) width = std::max(width, length(point(m, i).on_a - point(m, k).on_a));
    }
    CHECK(double(width) == doctest::Approx(2 * std::sqrt(0.09 - 0.0225)).epsilon(1e-3));
  }

  TEST_CASE("a half-space feels the lowest points of every shape") {
    const Quat tilt = hooke::quaternion_about(Vec3{Real(0), Real(0), Real(1)}, Real(0.4));
    std::mt19937 random(11);
    for (const ShapeKind kind : kKinds) {
      for (int i = 0; i < 50; ++i) {
        const Body body = random_body(kind, {Real(3), Real(0), Real(1)}, random);
        const Vec3 n = rotate(tilt, Vec3{Real(0), Real(1), Real(0)});
        const Vec3 low = support_of(body.convex, -n) - skin_of(body.convex) * n;
        ContactResult m;
        collide_half_space(low + Real(0.002) * n, n, body.convex, {.margin = Real(0.02)}, m);
        CHECK(m.normal == n);
        CHECK(std::fabs(m.separation + Real(0.002)) < Real(1e-5));
        REQUIRE(m.count > 0);
        CHECK(std::fabs(deepest_of(m) + Real(0.002)) < Real(1e-4));
        for (int k = 0; k < m.count; ++k) {
          CHECK(distance_to(body.convex, point(m, k).on_b) < Real(1e-4));
          CHECK(std::fabs(dot(n, point(m, k).on_a - low) - Real(0.002)) < Real(1e-5));
        }
      }
    }
  }

  TEST_CASE(
      "four points are kept: the deepest, and the widest; and the same ones when all are nearly alike") {
    ContactResult m;
    m.normal = {Real(0), Real(1), Real(0)};
    for (unsigned i = 0; i < 16; ++i) {
      const double angle = i * 0.392699;
      const Vec3 place = {Real(std::cos(angle)), Real(0), Real(std::sin(angle))};
      const Real depth = i == 5 ? Real(-0.01) : Real(-0.001) + Real(1e-5) * Real(i % 3);
      m.add({place, place, depth, 100 + i});
    }
    ContactResult first = m;
    hooke::collision::reduce_points(first, Real(0.02), {});
    REQUIRE(first.count == 4);
    std::array<std::uint32_t, 4> keys = {};
    bool has_deepest = false;
    for (int i = 0; i < 4; ++i) {
      keys[static_cast<std::size_t>(i)] = point(first, i).key;
      has_deepest = has_deepest || point(first, i).key == 105;
    }
    CHECK(has_deepest);
    // A square in the circle: nothing is larger.
    const Vec3 diagonal = point(first, 2).on_a - point(first, 0).on_a;
    CHECK(double(length(diagonal)) == doctest::Approx(2).epsilon(1e-3));
    for (int i = 0; i < m.count; ++i)
      m.point[static_cast<std::size_t>(i)].separation -= Real(1e-4) * Real(i % 2);
    hooke::collision::reduce_points(m, Real(0.02), keys);
    REQUIRE(m.count == 4);
    for (int i = 0; i < 4; ++i) CHECK(point(m, i).key == keys[static_cast<std::size_t>(i)]);
  }

  TEST_CASE("no finite placement gives anything that is not finite") {
    std::mt19937 random(12);
    for (const ShapeKind kind_a : kKinds) {
      for (const ShapeKind kind_b : kKinds) {
        for (const Real reach : {Real(0), Real(1e-6), Real(0.1), Real(1e5)}) {
          const Body a = random_body(kind_a, {}, random);
          const Body b = random_body(kind_b, reach * random_unit(random), random);
          Convex aligned = b.convex;
          aligned.axes = a.convex.axes;
          for (const Convex& other : {b.convex, aligned}) {
            const ContactResult m = meeting_of(a.convex, other);
            bool finite = std::isfinite(m.separation) && m.count <= ContactResult::kMaxPoints;
            for (int i = 0; i < m.count; ++i) {
              finite = finite && is_finite(point(m, i).on_a) && is_finite(point(m, i).on_b);
            }
            CHECK(finite);
            if (reach < Real(1)) CHECK(m.count > 0);
          }
        }
      }
    }
  }
}
