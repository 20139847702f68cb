/// Cases with known answers that other engines test themselves by: Box3D (test_collision.c, test_shape.c,
/// test_distance.c), MuJoCo (engine_collision tests), Jolt (CastShapeTests, GJKTests, CollideShapeTests).
/// docs/geometry_cases.md lists them all.

#include "collision/pairs.h"
#include "geometry/meshes.h"
#include "world/make.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace hooke {

using collision::Distance;
using namespace test;

namespace {

const Shape kBall = Shape::sphere(Real(1));

Shape cube(double half) {
  const auto h = static_cast<Real>(half);
  return Shape::box({h, h, h});
}

Quat about_z(double degrees) {
  return quaternion_about(Vec3{0, 0, 1}, static_cast<Real>(degrees * std::numbers::pi / 180));
}

/// Of a ray against one shape; -1 for a miss.
double ray_fraction(const Shape& shape, const Pose& pose, DVec3 origin, DVec3 motion) {
  World world = make_world();
  take(world.add_body({.shape = shape, .position = pose.position, .rotation = pose.rotation}));
  const auto hit = take(world.cast_ray(origin, motion));
  return hit ? hit->fraction : -1;
}

std::optional<CastHit> cast_on_triangle(const Shape& shape, const std::vector<Vec3>& corners, DVec3 origin,
                                        DVec3 motion) {
  World world = make_world();
  const MeshId mesh = take(world.add_mesh({.positions = corners, .triangles = {{0, 1, 2}}}));
  take(world.add_body({.shape = Shape::of_mesh(mesh)}));
  return take(world.cast_shape(shape, {origin}, motion));
}

}  // namespace

TEST_SUITE("world/known_cases") {
  TEST_CASE("T-04: rays enter boxes at a quarter and at a third") {
    CHECK(ray_fraction(cube(1), {}, {-2, 0, 0}, {4, 0, 0}) == doctest::Approx(0.25).epsilon(1e-9));
    const Pose corner = {{0.5, 0.5, 0.5}, {}};
    CHECK(ray_fraction(cube(0.5), corner, {-1, 0.5, 0.5}, {3, 0, 0}) ==
          doctest::Approx(1.0 / 3).epsilon(1e-9));
    CHECK(ray_fraction(cube(0.5), corner, {-1, -1, -1}, {3, 3, 3}) == doctest::Approx(1.0 / 3).epsilon(1e-9));
  }

  TEST_CASE("T-05, T-06, T-08: rays meet spheres, graze them or just miss, from near and from afar") {
    CHECK(ray_fraction(kBall, {}, {-4, 0, 0}, {8, 0, 0}) == doctest::Approx(3.0 / 8).epsilon(1e-9));
    CHECK(ray_fraction(Shape::sphere(2), {{5, 0, 0}, {}}, {}, {10, 0, 0}) ==
          doctest::Approx(0.3).epsilon(1e-9));
    CHECK(ray_fraction(kBall, {}, {-3, -3, 0}, {6, 6, 0}) == doctest::Approx(0.382149).epsilon(1e-5));
    CHECK(ray_fraction(kBall, {}, {-4, 0.999, 0}, {8, 0, 0}) > 0);
    CHECK(ray_fraction(kBall, {}, {-4, 1.001, 0}, {8, 0, 0}) == -1);
    for (double d = 1e2; d < 2e6; d *= 10)
      CHECK(std::abs(2 * d * ray_fraction(kBall, {}, {-d, 0, 0}, {2 * d, 0, 0}) - (d - 1)) < 1e-6);
  }

  TEST_CASE("T-07: rays meet a capsule at its side and its ends") {
    const Shape capsule = Shape::capsule(1, 2);
    const Pose lying = {{}, about_z(90)};
    CHECK(ray_fraction(capsule, lying, {0, 3, 0}, {0, -6, 0}) == doctest::Approx(1.0 / 3).epsilon(1e-6));
    CHECK(ray_fraction(capsule, lying, {-3, 3, 0}, {4, -4, 0}) == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(ray_fraction(capsule, lying, {5, 0, 0}, {-8, 0, 0}) == doctest::Approx(0.25).epsilon(1e-6));
    CHECK(ray_fraction(capsule, lying, {4, 2, 0}, {-4, -4, 0}) == doctest::Approx(0.323223).epsilon(1e-5));
  }

  TEST_CASE("T-09, T-17, T-21: distances of spheres and of boxes") {
    const Distance near =
        distance_between(placed(kBall, {Real(-1.5), 0, 0}, {}), placed(kBall, {Real(1.5), 0, 0}, {}));
    CHECK(near.distance == doctest::Approx(1).epsilon(1e-6));
    CHECK(length(near.point_a - Vec3{Real(-0.5), 0, 0}) < Real(1e-6));
    CHECK(length(near.point_b - Vec3{Real(0.5), 0, 0}) < Real(1e-6));
    const Distance far = distance_between(placed(kBall, {}, {}), placed(kBall, {10, 10, 10}, {}));
    CHECK(far.distance == doctest::Approx(15.320508).epsilon(1e-6));
    const Distance boxes = distance_between(placed(cube(1), {Real(-1.5), Real(0.5), 0}, {}),
                                            placed(cube(1), {Real(1.5), 0, 0}, {}));
    CHECK(boxes.distance == doctest::Approx(1).epsilon(1e-6));
  }

  TEST_CASE("T-10, T-26: spheres that overlap: how deep, and where") {
    const auto deep =
        meeting_of(placed(Shape::sphere(3), {-1, 0, 0}, {}), placed(Shape::sphere(3), {3, 0, 0}, {}));
    REQUIRE(deep.count == 1);
    CHECK(deep.point[0].separation == doctest::Approx(-2).epsilon(1e-6));
    CHECK(length(deep.normal - Vec3{1, 0, 0}) < Real(1e-6));
    CHECK(length(Real(0.5) * (deep.point[0].on_a + deep.point[0].on_b) - Vec3{1, 0, 0}) < Real(1e-5));
    const auto a = meeting_of(placed(Shape::sphere(2), {10, 11, 12}, {}),
                              placed(Shape::sphere(Real(1.5)), {13, 11, 12}, {}));
    REQUIRE(a.count == 1);
    CHECK(length(a.point[0].on_a - Vec3{12, 11, 12}) < Real(1e-5));
    CHECK(length(a.point[0].on_b - Vec3{Real(11.5), 11, 12}) < Real(1e-5));
    const auto b = meeting_of(placed(Shape::sphere(2), {10, 21, 12}, {}),
                              placed(Shape::sphere(Real(1.5)), {13, 22, 12}, {}));
    REQUIRE(b.count == 1);
    CHECK(b.point[0].separation == doctest::Approx(std::sqrt(10.0) - 3.5).epsilon(1e-5));
  }

  TEST_CASE("T-11, T-12, T-13, T-14: boxes that overlap, by a face, turned, four corners, or only touch") {
    const auto face = meeting_of(placed(cube(2.5), {-1, 0, 0}, {}), placed(cube(1), {Real(1.5), 0, 0}, {}));
    CHECK(face.separation == doctest::Approx(-1).epsilon(1e-6));
    CHECK(length(face.normal - Vec3{1, 0, 0}) < Real(1e-6));

    // About the middle of both: 4 m away float resolves no more than half a micrometer.
    const Shape slab = Shape::box({Real(0.25), Real(0.25), Real(0.05)});
    const double half_way = 0.5 * (4.6592303609 - 4.5622964424);
    const auto turned = meeting_of(placed(slab, {0, 0, static_cast<Real>(half_way)}, about_z(15)),
                                   placed(slab, {0, 0, static_cast<Real>(-half_way)}, about_z(30)));
    CHECK(turned.separation == doctest::Approx(-0.003066).epsilon(1e-3));
    CHECK(turned.normal.z == doctest::Approx(-1));

    const auto resting =
        meeting_of(placed(Shape::box({10, 10, 1}), {}, {}), placed(cube(1), {0, 0, Real(1.9)}, {}));
    REQUIRE(resting.count == 4);
    for (int i = 0; i < 4; ++i) {
      const auto& point = resting.point[static_cast<std::size_t>(i)];
      const Vec3 middle = Real(0.5) * (point.on_a + point.on_b);
      CHECK(point.separation == doctest::Approx(-0.1).epsilon(1e-5));
      CHECK(std::abs(middle.x) == doctest::Approx(1));
      CHECK(std::abs(middle.y) == doctest::Approx(1));
      CHECK(middle.z == doctest::Approx(0.95));
    }

    const auto z = static_cast<Real>(1.8599132000000014);
    const auto touching = meeting_of(placed(cube(1), {0, 0, z}, {}), placed(cube(1), {0, 2, z}, {}));
    CHECK(std::abs(touching.separation) < Real(1e-6));
  }

  TEST_CASE("T-03, T-22: a square and a sphere that are swept stop at what they meet") {
    World world = make_world();
    take(world.add_body({.shape = Shape::box({1, 1, Real(0.01)})}));
    take(world.add_body({.shape = kBall, .position = {0, 100, 0}}));
    // A segment with a skin of 1 cm, from x = 2.
    const auto segment = take(world.cast_shape(Shape::capsule(Real(0.01), 1), {{2, 0, 0}, {}}, {-2, 0, 0}));
    REQUIRE(segment);
    CHECK(segment->fraction == doctest::Approx(0.495).epsilon(1e-4));
    const auto ball = take(world.cast_shape(kBall, {{-10, 100, 0}, {}}, {20, 0, 0}));
    REQUIRE(ball);
    CHECK(ball->fraction == doctest::Approx(0.4).epsilon(1e-4));
  }

  TEST_CASE("T-23, T-24: a sphere swept onto a triangle: its face from both sides, its corners, its edges") {
    const Shape ball = Shape::sphere(Real(0.2));
    const std::vector<Vec3> corners = {{50, 25, 0}, {-50, 25, 0}, {0, -25, 0}};
    for (const double side : {1.0, -1.0}) {
      const auto face = cast_on_triangle(ball, corners, {0, 0, 15 * side}, {0, 0, -30 * side});
      REQUIRE(face);
      CHECK(face->fraction == doctest::Approx(14.8 / 30).epsilon(1e-4));
      CHECK(length(face->point) < 1e-3);
      CHECK(face->normal.z == doctest::Approx(side));
    }
    const auto overlapping = cast_on_triangle(ball, corners, {0, 0, 0.1}, {0, 0, -1});
    REQUIRE(overlapping);
    CHECK(overlapping->fraction == 0);

    const DVec3 middle = {0, 25.0 / 3, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = vector_cast<double>(corners[k]);
      const auto next = vector_cast<double>(corners[(k + 1) % 3]);
      const DVec3 edge_middle = 0.5 * (corner + next);
      const DVec3 edge = normalize(next - corner);
      const DVec3 off_edge = (edge_middle - middle) - dot(edge_middle - middle, edge) * edge;
      const struct {
        DVec3 place, out;
      } targets[] = {{corner, normalize(corner - middle)}, {edge_middle, normalize(off_edge)}};
      for (const auto& [place, out] : targets) {
        const auto hit = cast_on_triangle(ball, corners, place + 5.0 * out, -5.0 * out);
        REQUIRE(hit);
        CHECK(hit->fraction == doctest::Approx(1 - 0.2 / 5).epsilon(1e-4));
        CHECK(length(hit->point - place) < 1e-3);
      }
    }
  }

  TEST_CASE("T-25, C-07: a sphere swept past a triangle almost without width does not meet it") {
    const std::vector<Vec3> sliver = {{Real(14.5536213), Real(10.5973721), Real(-0.0060005188)},
                                      {Real(14.5536213), Real(10.5969315), Real(-3.18638134)},
                                      {Real(14.5536213), Real(10.5969315), Real(-5.18637228)}};
    const auto hit = cast_on_triangle(Shape::sphere(Real(0.2)), sliver, {14.831459, 8.1905508, -4.30825043},
                                      {-0.0988006592, 5.96046448e-8, 0.000732421875});
    CHECK_FALSE(hit);
  }

  TEST_CASE("T-27: a sphere inside a box is as deep as its nearest face, and its radius more") {
    for (const double depth : {0.5, 3.0}) {
      const auto at = static_cast<Real>(10 - depth);
      for (const Vec3 center : {Vec3{at, 0, 0}, Vec3{at, at, 0}, Vec3{at, at, at}}) {
        const auto meeting = meeting_of(placed(cube(10), {}, {}), placed(kBall, center, {}));
        REQUIRE(meeting.count == 1);
        CHECK(meeting.point[0].separation == doctest::Approx(-(depth + 1)).epsilon(1e-5));
      }
    }
  }

  TEST_CASE(
      "T-35, T-36: hulls of an octagonal prism and of a box far from its origin weigh what they should") {
    World world = make_world();
    MeshDesc prism;
    for (int i = 0; i < 16; ++i) {
      const double angle = std::numbers::pi / 4 * (i % 8);
      prism.positions.push_back(
          {static_cast<Real>(std::cos(angle)), Real(i < 8 ? 0 : 2), static_cast<Real>(std::sin(angle))});
    }
    prism.triangles = {{0, 1, 2}};
    const BodyId heavy = take(world.add_body({.kind = BodyKind::kDynamic,
                                              .shape = Shape::hull_of(take(world.add_mesh(prism))),
                                              .density = Real(1000)}));
    CHECK(world.mass(heavy) == doctest::Approx(5656.854).epsilon(1e-5));

    MeshDesc box = test::make_cube(1);
    for (Vec3& p : box.positions)
      p = {p.x < 0 ? Real(5) : Real(10), p.y < 0 ? Real(6) : Real(12), p.z < 0 ? Real(7) : Real(14)};
    const BodyId far = take(world.add_body({.kind = BodyKind::kDynamic,
                                            .shape = Shape::hull_of(take(world.add_mesh(box))),
                                            .density = Real(1.5)}));
    CHECK(world.mass(far) == doctest::Approx(315).epsilon(1e-5));
    CHECK(length(world.center_of_mass(far) - DVec3{7.5, 9, 10.5}) < 1e-5);
  }
}

}  // namespace hooke
