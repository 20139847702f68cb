#include "collision/query/queries.h"

#include "collision/continuous/shape_bounds.h"
#include "collision/distance/shape_gap.h"
#include "collision/query/queries_ray.h"
#include "collision/scene.h"
#include "geometry/mesh/bvh.h"
#include "geometry/meshes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

namespace hooke::collision {

namespace {

double signed_unit(std::mt19937& random) {
  return static_cast<double>(random()) / 2147483648.0 - 1.0;
}
DVec3 random_vector(std::mt19937& random) {
  const double x = signed_unit(random);
  const double y = signed_unit(random);
  return {x, y, signed_unit(random)};
}

state::ColliderShape collider_of(const Shape& shape) {
  return {.shape = shape, .mesh = nullptr, .hull = nullptr};
}
state::ColliderShape random_hull(std::mt19937& random) {
  std::vector<Vec3> points;
  for (int i = 0; i < 30; ++i) points.push_back(vector_cast<Real>(random_vector(random)));
  state::ColliderShape collider = collider_of(Shape{.kind = ShapeKind::kHull});
  collider.hull = std::make_shared<geometry::ConvexHull>(geometry::make_convex_hull(points).value());
  return collider;
}
state::ColliderShape ball_of_triangles() {
  auto mesh = std::make_shared<state::Mesh>();
  mesh->desc = test::make_sphere(3);
  mesh->bvh = geometry::build_bvh(mesh->desc.positions, mesh->desc.triangles);
  state::ColliderShape collider = collider_of(Shape{.kind = ShapeKind::kMesh});
  collider.mesh = mesh;
  return collider;
}
std::vector<state::ColliderShape> solids(std::mt19937& random) {
  return {collider_of(Shape::half_space()),
          collider_of(Shape::sphere(Real(0.8))),
          collider_of(Shape::box({Real(0.9), Real(0.5), Real(0.3)})),
          collider_of(Shape::capsule(Real(0.4), Real(0.5))),
          collider_of(Shape::cylinder(Real(0.6), Real(0.5))),
          collider_of(Shape::cone(Real(0.7), Real(0.6))),
          random_hull(random)};
}

double distance_to(const state::ColliderShape& shape, DVec3 x) {
  return static_cast<double>(gap_to_shape(shape, vector_cast<Real>(x)).distance);
}

/// Against the distance to the shape along the way: positive before the hit, zero there, growing along the
/// normal.
bool check_ray(const state::ColliderShape& shape, DVec3 origin, DVec3 motion) {
  constexpr double kSmall = 3e-6;  // what a distance in float is good for here
  const auto hit = cast_ray_on_shape(shape, origin, motion);
  const double end = hit ? hit->fraction : 1.0;
  double least = 1;
  for (int i = 0; i < 200; ++i)
    least = std::min(least, distance_to(shape, origin + (end * i / 200) * motion));
  if (!hit) {
    CHECK(least > -kSmall);
    return false;
  }
  CHECK(length(hit->normal) == doctest::Approx(1.0));
  if (hit->fraction == 0) {
    CHECK(distance_to(shape, origin) < kSmall);
    return true;
  }
  CHECK(least > -kSmall);
  const DVec3 place = origin + hit->fraction * motion;
  CHECK(std::fabs(distance_to(shape, place)) < kSmall);
  CHECK(dot(hit->normal, motion) < 0);
  CHECK(std::fabs(distance_to(shape, place + 0.01 * hit->normal) - 0.01) < 2 * kSmall);
  return true;
}

/// Bodies of all kinds about the origin, and the broad phase over them.
struct World {
  test::PairScene scene;
  BroadPhase broad_phase;

  explicit World(std::mt19937& random) {
    const std::vector<state::ColliderShape> shapes = solids(random);
    for (std::size_t i = 0; i < 60; ++i) {
      const DVec3 axis = random_vector(random);
      const Quat rotation = quaternion_about(vector_cast<Real>(axis), Real(3) * Real(axis.x));
      const DVec3 place = i == 0 ? DVec3{0, -5, 0} : 5.0 * random_vector(random);
      const std::size_t kind = i == 0 ? 0 : 1 + i % (shapes.size());
      const auto row = scene.add_static(Shape{}, place, i == 0 ? Quat{} : rotation);
      scene.colliders.shape[row] = kind < shapes.size() ? shapes[kind] : ball_of_triangles();
      scene.bodies.traits[row].filter.category = i % 5 == 0 ? 2 : 1;
      scene.bodies.traits[row].sensor = i % 7 == 3;
      broad_phase.set(row, bounds_of(scene.colliders.shape[row], pose(row)), false);
    }
    broad_phase.update();
  }
  [[nodiscard]] QueryScene view() const { return {broad_phase, scene.bodies, scene.colliders}; }
  [[nodiscard]] Pose pose(std::uint32_t row) const {
    return {scene.bodies.center[row], scene.bodies.rotation[row]};
  }
  [[nodiscard]] bool is_found(std::uint32_t row, std::uint32_t mask, bool sensors) const {
    const state::BodyTraits& traits = scene.bodies.traits[row];
    return (traits.filter.category & mask) != 0 && (sensors || !traits.sensor);
  }
  /// A point of the world as the collider sees it.
  [[nodiscard]] DVec3 seen_by(std::uint32_t row, DVec3 point) const {
    const Quat q = scene.bodies.rotation[row];
    return rotate(conjugate(normalize(Quaternion<double>{q.x, q.y, q.z, q.w})),
                  point - scene.bodies.center[row]);
  }
};

}  // namespace

TEST_SUITE("collision/queries") {
  TEST_CASE("a ray meets a solid where its distance becomes zero, and the normal leads straight away") {
    std::mt19937 random(1);
    const auto shapes = solids(random);
    for (const state::ColliderShape& shape : shapes) {
      int hits = 0;
      for (int i = 0; i < 300; ++i) {
        const DVec3 origin = 2.0 * random_vector(random);
        DVec3 motion = 0.7 * random_vector(random) - origin;
        if (i % 5 == 0) motion = {0, motion.y, 0};
        if (i % 5 == 1) motion.y = 0;
        hits += check_ray(shape, origin, motion) ? 1 : 0;
      }
      CHECK(hits > 60);
      CHECK(hits < 300);
    }
  }

  TEST_CASE("what begins inside meets at once, what ends before or leads away does not") {
    std::mt19937 random(2);
    for (const state::ColliderShape& shape : solids(random)) {
      const DVec3 inside = {0.01, -0.1, 0.02};
      const auto hit = cast_ray_on_shape(shape, inside, {0, 2, 0});
      REQUIRE(hit);
      CHECK(hit->fraction == 0.0);
      CHECK(hit->normal == DVec3{0, -1, 0});
      CHECK(cast_ray_on_shape(shape, inside, {})->normal == DVec3{});
      CHECK_FALSE(cast_ray_on_shape(shape, {0, 3, 0}, {0, 0, 0}));
      CHECK_FALSE(cast_ray_on_shape(shape, {0, 3, 0}, {0, 1, 0}));
      CHECK_FALSE(cast_ray_on_shape(shape, {0, 3, 0}, {0, -1, 0}));
      CHECK(cast_ray_on_shape(shape, {0, 3, 0}, {0, -4, 0}));
    }
  }

  TEST_CASE("known answers") {
    const auto sphere = cast_ray_on_shape(collider_of(Shape::sphere(Real(0.5))), {-4, 0.3, 0}, {8, 0, 0});
    REQUIRE(sphere);
    CHECK(sphere->fraction == doctest::Approx(3.6 / 8).epsilon(1e-12));
    CHECK(sphere->normal.x == doctest::Approx(-0.8));
    CHECK(sphere->normal.y == doctest::Approx(0.6));
    // The side of a cone of radius 3 and height 4 has the normal (4, 3) / 5.
    const auto cone = collider_of(Shape::cone(Real(3), Real(2)));
    const auto side = cast_ray_on_shape(cone, {4, 0, 0}, {-4, 0, 0});
    REQUIRE(side);
    CHECK(side->fraction == doctest::Approx(2.5 / 4));
    CHECK(side->normal.x == doctest::Approx(0.8));
    CHECK(side->normal.y == doctest::Approx(0.6));
    CHECK_FALSE(cast_ray_on_shape(cone, {4, 2.5, 0}, {-8, 0, 0}));  // through the mirror image above the tip
    // Steeper than the side, from above and from below, and along the side through the base.
    CHECK(cast_ray_on_shape(cone, {1.5, 4, 0}, {0, -8, 0})->fraction == doctest::Approx(0.5));
    CHECK(cast_ray_on_shape(cone, {1.5, -4, 0}, {0, 8, 0})->fraction == doctest::Approx(0.25));
    CHECK(cast_ray_on_shape(cone, {2, -4, 0}, {-6, 8, 0})->fraction == doctest::Approx(0.25));
    const auto capsule =
        cast_ray_on_shape(collider_of(Shape::capsule(Real(0.5), Real(1))), {0.3, 4, 0}, {0, -8, 0});
    REQUIRE(capsule);
    CHECK(capsule->fraction == doctest::Approx((4 - 1.4) / 8));
    CHECK(capsule->normal.y == doctest::Approx(0.8));
  }

  TEST_CASE("a ray from a thousand kilometers away hits to the micrometer") {
    const auto sphere = collider_of(Shape::sphere(Real(0.5)));
    const DVec3 away = {6e5, 8e5, 0};
    const auto hit = cast_ray_on_shape(sphere, away, -2.0 * away);
    REQUIRE(hit);
    CHECK(length(away - 2.0 * hit->fraction * away) == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(hit->normal.x == doctest::Approx(0.6));
  }

  TEST_CASE("a mesh is met from either side, with the normal of the front") {
    const state::ColliderShape ball = ball_of_triangles();
    const auto outside = cast_ray_on_shape(ball, {0.1, 0.2, 3}, {0, 0, -6});
    REQUIRE(outside);
    CHECK(outside->fraction == doctest::Approx(2.03 / 6).epsilon(0.02).scale(0));
    CHECK(outside->normal.z > 0.9);
    const auto inside = cast_ray_on_shape(ball, {0.1, 0.2, 0}, {0, 0, -6});
    REQUIRE(inside);
    CHECK(inside->fraction == doctest::Approx(0.97 / 6).epsilon(0.02).scale(0));
    CHECK(inside->normal.z < -0.9);
  }

  TEST_CASE("rays through a world hit what each collider alone says, nearest first") {
    std::mt19937 random(3);
    const World world(random);
    std::vector<RayHit> hits;
    std::size_t total = 0;
    for (int i = 0; i < 400; ++i) {
      const DVec3 origin = 9.0 * random_vector(random);
      const DVec3 motion = 9.0 * random_vector(random) - origin;
      QueryScene view = world.view();
      view.filter.mask = i % 3 == 0 ? 1 : 3;
      view.sensors = i % 2 == 0;
      std::vector<std::pair<double, std::uint32_t>> expected;
      for (std::uint32_t row = 0; row < 60; ++row) {
        const DVec3 way = world.seen_by(row, origin + motion) - world.seen_by(row, origin);
        const auto hit = cast_ray_on_shape(world.scene.colliders.shape[row], world.seen_by(row, origin), way);
        if (hit && world.is_found(row, view.filter.mask, view.sensors))
          expected.emplace_back(hit->fraction, row);
      }
      std::sort(expected.begin(), expected.end());
      cast_ray_through(view, origin, motion, hits);
      REQUIRE(hits.size() == expected.size());
      total += hits.size();
      for (std::size_t k = 0; k < hits.size(); ++k) {
        CHECK(hits[k].fraction == doctest::Approx(expected[k].first).epsilon(1e-9));
        CHECK(hits[k].collider == expected[k].second);
      }
      const auto first = cast_ray(view, origin, motion);
      REQUIRE(first.has_value() == !hits.empty());
      if (first) CHECK(first->collider == hits[0].collider);
      if (first) CHECK(length(first->point - (origin + first->fraction * motion)) < 1e-12);
    }
    CHECK(total > 200);
  }

  TEST_CASE("the normal of a hit is in the world's axes") {
    test::PairScene scene;
    BroadPhase broad_phase;
    const Quat quarter = quaternion_about(Vec3{0, 0, 1}, Real(1.5707963267948966));
    scene.add_static(Shape::half_space(), {2, 0, 0}, quarter);
    broad_phase.set(0, bounds_of(scene.colliders.shape[0], {{2, 0, 0}, quarter}), false);
    const auto hit = cast_ray({broad_phase, scene.bodies, scene.colliders}, {0, 0.5, 0}, {4, 0, 0});
    REQUIRE(hit);
    CHECK(hit->fraction == doctest::Approx(0.5));
    CHECK(double(hit->normal.x) == doctest::Approx(-1.0));
  }

  TEST_CASE("the nearest colliders are those that each one's distance says, inside ones first") {
    std::mt19937 random(4);
    const World world(random);
    std::vector<ClosestHit> hits;
    std::size_t total = 0;
    for (int i = 0; i < 300; ++i) {
      const DVec3 point = 6.0 * random_vector(random);
      const Real reach =
          i % 10 == 0 ? geometry::Box::kFar : static_cast<Real>(std::fabs(signed_unit(random)));
      const QueryScene view = world.view();
      std::vector<std::uint32_t> expected;
      for (std::uint32_t row = 0; row < 60; ++row) {
        const state::ColliderShape& shape = world.scene.colliders.shape[row];
        const DVec3 x = world.seen_by(row, point);
        // Of a ball of triangles the distance is known roughly: those near the limit are left out.
        const bool is_ball = shape.shape.kind == ShapeKind::kMesh;
        const double distance = is_ball ? std::fabs(length(x) - 0.99) : distance_to(shape, x);
        const auto is_it = [&](const ClosestHit& hit) { return hit.collider == row; };
        find_near(view, point, reach, hits);
        const bool is_near = std::any_of(hits.begin(), hits.end(), is_it);
        if (std::fabs(distance - double(reach)) < 0.02) continue;
        CHECK(is_near == (distance < double(reach) && world.is_found(row, ~0u, false)));
        if (is_near) expected.push_back(row);
      }
      total += hits.size();
      for (const ClosestHit& hit : hits) {
        CHECK(length(hit.point - point) == doctest::Approx(std::fabs(double(hit.distance))).epsilon(1e-4));
        const DVec3 there = world.seen_by(hit.collider, hit.point);
        const state::ColliderShape& shape = world.scene.colliders.shape[hit.collider];
        // From up to 17 m away, in float.
        if (shape.shape.kind != ShapeKind::kMesh) CHECK(std::fabs(distance_to(shape, there)) < 4e-5);
      }
      CHECK(std::is_sorted(hits.begin(), hits.end(),
                           [](const ClosestHit& a, const ClosestHit& b) { return a.distance < b.distance; }));
      const auto first = find_closest(view, point, reach);
      REQUIRE(first.has_value() == !hits.empty());
      if (first) CHECK(first->collider == hits[0].collider);
    }
    CHECK(total > 300);
  }
}

}  // namespace hooke::collision
