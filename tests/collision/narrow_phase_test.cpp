#include "collision/narrow_phase/narrow_phase.h"

#include "collision/scene.h"

#include <cmath>
#include <doctest/doctest.h>
#include <vector>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Quat;
using hooke::Real;
using hooke::Shape;
using hooke::Vec3;
using hooke::state::Manifold;
using hooke::test::PairScene;

namespace {

const Shape kCube = Shape::box({Real(0.5), Real(0.5), Real(0.5)});

/// Manifolds that were carried along, and those of a new test: each with `count` points.
void check_same_points(const PairScene& cached, const PairScene& made, int count) {
  REQUIRE(made.pairs.manifold.size() == cached.pairs.manifold.size());
  for (std::size_t i = 0; i < made.pairs.manifold.size(); ++i) {
    const Manifold& a = cached.pairs.manifold[i];
    const Manifold& b = made.pairs.manifold[i];
    REQUIRE(a.point_count == count);
    REQUIRE(b.point_count == count);
    CHECK(length(a.normal - b.normal) < 2e-6);
    for (int k = 0; k < count; ++k) {
      const auto& p = a.point[static_cast<std::size_t>(k)];
      Real error = Real(1);
      for (const auto& q : b.point) {
        if (length(q.anchor_b - p.anchor_b) < Real(1e-3)) error = std::fabs(q.separation - p.separation);
      }
      CHECK(error < 5e-7);
    }
  }
}

/// Moves what `build` built by little, eight times: all of so many pairs are carried along, to the points of
/// a new test.
template <class Build>
void check_carried(const Build& build, std::uint32_t pairs, int points, PairScene& cached) {
  const Vec3 axis = hooke::normalize(Vec3{Real(0.3), Real(0.4), Real(-0.8)});
  for (int step = 1; step <= 8; ++step) {
    PairScene made;
    build(made, DVec3{1e-5 * step, -2e-6 * step, 4e-6 * step},
          hooke::quaternion_about(axis, Real(1e-5) * Real(step)));
    made.update();
    cached.bodies.center = made.bodies.center;
    cached.bodies.rotation = made.bodies.rotation;
    cached.update();
    REQUIRE(cached.counts.cached == pairs);
    check_same_points(cached, made, points);
  }
}

}  // namespace

TEST_SUITE("collision/narrow_phase") {
  TEST_CASE("a cube on a half-space rests on its four lower corners") {
    PairScene scene;
    scene.add_static(Shape::half_space(), {0, 0, 0});
    scene.add_dynamic(kCube, {3, 0.499, 0});
    scene.update();
    REQUIRE(scene.pairs.manifold.size() == 1);
    const Manifold& m = scene.pairs.manifold[0];
    CHECK(m.point_count == 4);
    CHECK(m.normal == Vec3{Real(0), Real(1), Real(0)});
    for (int i = 0; i < m.point_count; ++i) {
      const auto& p = m.point[static_cast<std::size_t>(i)];
      CHECK(p.separation == doctest::Approx(-0.001).epsilon(1e-3).scale(0));
      CHECK(p.anchor_b.y == doctest::Approx(-0.5));
      CHECK(p.anchor_a.y == doctest::Approx(0).epsilon(1e-6));
      CHECK(std::fabs(p.anchor_b.x) == doctest::Approx(0.5));
      CHECK(p.anchor_a.x == doctest::Approx(p.anchor_b.x + 3));
    }
  }

  TEST_CASE("far from the world's origin contacts are as precise as near it") {
    PairScene near;
    PairScene far;
    const DVec3 away = {1e6, 3e5, -2e6};
    for (PairScene* scene : {&near, &far}) {
      const DVec3 shift = scene == &far ? away : DVec3{};
      scene->add_static(Shape::half_space(), shift + DVec3{-40, 0, 0});
      scene->add_dynamic(kCube, shift + DVec3{0, 0.5 - 1e-3, 0});
      scene->add_dynamic(kCube, shift + DVec3{0.25, 1.5 - 2e-3, 0});
      scene->update();
      REQUIRE(scene->pairs.manifold.size() == 2);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& a = near.pairs.manifold[i].point[0];
      const auto& b = far.pairs.manifold[i].point[0];
      CHECK(std::fabs(a.separation - b.separation) < 1e-6);
      CHECK(length(a.anchor_b - b.anchor_b) < 1e-6);
    }
  }

  TEST_CASE("a manifold that is carried along is the one that a new test makes") {
    const auto build = [](PairScene& scene, DVec3 way, Quat turn) {
      scene.add_static(Shape::half_space(), {1000, -0.5, 0});
      scene.add_dynamic(kCube, 0.5 * way, turn);
      scene.add_dynamic(kCube, DVec3{0.2, 0.9995, 0.1} + way, turn);
    };
    PairScene cached;
    build(cached, {}, {});
    cached.update();
    REQUIRE(cached.counts.tested == 3);
    check_carried(build, 2, 4, cached);
    cached.move(2, {1e-3, 0, 0});
    cached.update();
    CHECK(cached.counts.tested == 1);
    CHECK(cached.counts.cached == 1);
  }

  TEST_CASE("manifolds on a mesh are carried along too") {
    // A valley of two slopes, in which a cube stands on two of its edges.
    MeshDesc valley;
    valley.positions = {{-2, 2, -2}, {-2, 2, 2}, {0, 0, 2}, {0, 0, -2}, {2, 2, 2}, {2, 2, -2}};
    valley.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
    const DVec3 start = {0, 1 - 5e-4, 0};
    const auto build = [&](PairScene& scene, DVec3 way, Quat turn) {
      scene.add_mesh(valley);
      scene.add_dynamic(kCube, start + way, turn);
    };
    PairScene cached;
    build(cached, {}, {});
    cached.update();
    REQUIRE(cached.pairs.manifold.size() == 2);
    check_carried(build, 1, 2, cached);
    cached.move(1, {1e-2, 0, 0});
    cached.update();
    CHECK(cached.counts.tested == 1);
  }

  TEST_CASE("where all bodies rest nothing is looked at, and what is gone leaves no manifold") {
    PairScene scene;
    scene.add_static(Shape::half_space(), {0, 0, 0});
    scene.add_dynamic(kCube, {-1, 0.499, 0});
    scene.add_dynamic(kCube, {1, 0.499, 0});
    scene.update();
    REQUIRE(scene.pairs.manifold.size() == 2);
    scene.bodies.asleep[1] = scene.bodies.asleep[2] = 1;
    scene.update();
    CHECK(scene.counts.tested == 0);
    CHECK(scene.counts.skipped == 3);
    CHECK(scene.pairs.manifold.size() == 2);

    const std::vector<hooke::collision::ColliderPair> left = {{0, 2}};
    const auto update = [&] {
      scene.narrow_phase.merge_pairs(left, scene.pairs);
      scene.counts = scene.narrow_phase.update_manifolds(scene.pool, scene.bodies, scene.colliders, {},
                                                         {.dt = Real(0.01), .substeps = 8}, scene.pairs);
    };
    update();
    REQUIRE(scene.pairs.manifold.size() == 1);
    CHECK(scene.pairs.manifold[0].body_b == 2);
    CHECK(scene.counts.tested == 0);

    scene.bodies.asleep[2] = 0;
    scene.move(2, {0, 0.3, 0});
    update();
    CHECK(scene.counts.tested == 1);
    CHECK(scene.pairs.manifold.empty());
  }

  TEST_CASE("what goes along a mesh, or away from it, is not held where it cannot come in the step") {
    MeshDesc floor;
    floor.positions = {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto manifolds = [&](Vec3 velocity, double gap) {
      PairScene scene;
      scene.add_mesh(floor);
      scene.add_dynamic(kCube, {0.3, 0.5 + gap, 0.1});
      scene.bodies.motion[1].v = velocity;
      scene.update();
      return scene.pairs.manifold.size();
    };
    const Real speed = Real(2.4);  // 4 cm in a step
    for (const Vec3 across : {Vec3{speed, Real(0), Real(0)}, Vec3{Real(0), Real(0), -speed}}) {
      CHECK(manifolds(across, 0.05) == 0);
      CHECK(manifolds(across, 0.015) == 1);  // 2 cm are always seen
    }
    CHECK(manifolds({Real(0), speed, Real(0)}, 0.05) == 0);
    CHECK(manifolds({Real(0), -speed, Real(0)}, 0.05) == 1);
    CHECK(manifolds({Real(0), -speed, Real(0)}, 0.065) == 0);
    // What is too fast for the margin of the whole way is held where it is.
    CHECK(manifolds({Real(300), Real(0), Real(0)}, -1e-3) == 1);
    CHECK(manifolds({Real(300), Real(0), Real(0)}, 1e-3) == 1);
  }

  TEST_CASE(
      "calm bodies of an island that is too large keep their manifold for 1.5 cm, others for half a "
      "millimeter") {
    const auto first_test_after = [](std::int8_t direct_state, Real speed) {
      PairScene scene;
      const std::uint32_t lower = scene.add_dynamic(kCube, {0, 0, 0});
      const std::uint32_t upper = scene.add_dynamic(kCube, {0, 0.9999, 0});
      for (const std::uint32_t body : {lower, upper}) {
        scene.bodies.direct_state[body] = direct_state;
        scene.bodies.motion[body].v = {speed, Real(0), Real(0)};
      }
      scene.update();
      double way = 0;
      do {
        scene.move(upper, {1e-4, 0, 0});
        scene.bodies.rotation[upper] = hooke::quaternion_about(Vec3{Real(0), Real(0), Real(1)}, Real(1e-6));
        way += 1e-4;
        const Vec3 normal = scene.pairs.manifold[0].normal;
        scene.update();
        const bool calm = direct_state < 0 && speed < Real(0.2);
        if (calm && scene.counts.cached == 1) CHECK(scene.pairs.manifold[0].normal == normal);
      } while (scene.counts.cached == 1 && way < 1);
      return way;
    };
    CHECK(std::fabs(first_test_after(-60, Real(0.1)) - 0.015) < 3e-4);
    CHECK(first_test_after(-60, Real(0.3)) < 6e-4);
    CHECK(first_test_after(0, Real(0.1)) < 6e-4);
  }

  TEST_CASE("impulses follow their points while aligned cubes shiver") {
    PairScene scene;
    scene.add_dynamic(kCube, {0, 0, 0});
    const std::uint32_t upper = scene.add_dynamic(kCube, {0, 0.9999, 0});
    scene.update();
    REQUIRE(scene.pairs.manifold.size() == 1);
    // Rounding decides which clip makes a corner: a vertex, or a crossing of edges.
    for (int step = 0; step < 50; ++step) {
      Manifold& m = scene.pairs.manifold[0];
      REQUIRE(m.point_count == 4);
      for (auto& p : m.point) p.normal_impulse = p.anchor_a.x + Real(2) * p.anchor_a.z + Real(3);
      m.friction_impulse = {Real(1), Real(2), Real(3)};
      m.twist_impulse = Real(4);
      m.touching = true;
      scene.move(upper, {1e-5 * (step % 3 - 1), 0, 1e-5 * (step % 5 - 2)});
      scene.bodies.rotation[upper] =
          hooke::quaternion_about(Vec3{Real(0), Real(1), Real(0)}, Real(1e-5) * Real(step % 7 - 3));
      scene.update();
      const Manifold& now = scene.pairs.manifold[0];
      REQUIRE(now.point_count == 4);
      for (const auto& p : now.point) {
        CHECK(std::fabs(p.normal_impulse - (p.anchor_a.x + Real(2) * p.anchor_a.z + Real(3))) < Real(1e-3));
      }
      CHECK(length(now.friction_impulse - Vec3{Real(1), Real(0), Real(3)}) < Real(1e-3));
      CHECK(now.twist_impulse == Real(4));
      CHECK(now.touching);
    }
  }

  TEST_CASE("an axis that is hardly better than the last one is not taken") {
    // A cube with its edge on another's: two faces hold them off equally well.
    PairScene scene;
    scene.add_dynamic(kCube, {0, 0, 0});
    const std::uint32_t other = scene.add_dynamic(kCube, {0.9991, 0.9990, 0});
    scene.update();
    REQUIRE(scene.pairs.manifold.size() == 1);
    CHECK(scene.pairs.manifold[0].normal.y == doctest::Approx(0));
    scene.move(other, {-0.0003, 0, 0});
    scene.update();
    CHECK(scene.pairs.manifold[0].normal.x == doctest::Approx(1));
    scene.move(other, {-0.0006, 0, 0});
    scene.update();
    CHECK(scene.pairs.manifold[0].normal.y == doctest::Approx(1));
  }

  TEST_CASE("a pair that is apart is tested again only when it may have met") {
    PairScene scene;
    scene.add_static(kCube, {0, 0, 0});
    const std::uint32_t moving = scene.add_dynamic(kCube, {3, 0, 0});
    scene.update();
    CHECK(scene.counts.tested == 1);
    int tested = 0;
    int first_manifold = 0;
    for (int step = 1; step <= 200; ++step) {
      scene.move(moving, {-0.01, 0, 0});
      scene.update();
      tested += int(scene.counts.tested);
      CHECK(scene.counts.tested + scene.counts.skipped == 1);
      if (scene.pairs.manifold.empty()) continue;
      first_manifold = step;
      break;
    }
    // Two meters apart, seen from two centimeters on.
    CHECK(first_manifold >= 198);
    CHECK(first_manifold <= 199);
    CHECK(tested < 10);
  }

  TEST_CASE("what stands or sleeps keeps its manifold and is not tested") {
    PairScene scene;
    scene.add_static(Shape::half_space(), {0, 0, 0});
    const std::uint32_t cube = scene.add_dynamic(kCube, {0, 0.5, 0});
    scene.update();
    scene.pairs.manifold[0].point[2].normal_impulse = Real(7);
    scene.bodies.asleep[cube] = 1;
    scene.update();
    CHECK(scene.counts.skipped == 1);
    REQUIRE(scene.pairs.manifold.size() == 1);
    CHECK(scene.pairs.manifold[0].point[2].normal_impulse == Real(7));
    scene.bodies.asleep[cube] = 0;
    scene.update();
    CHECK(scene.counts.cached == 1);
  }

  TEST_CASE("points are kept as far apart as the bodies' speeds can close in a step") {
    PairScene scene;
    scene.add_static(Shape::half_space(), {0, 0, 0});
    const std::uint32_t ball = scene.add_dynamic(Shape::sphere(Real(0.5)), {0, 0.55, 0});
    scene.update();
    CHECK(scene.pairs.manifold.empty());
    scene.bodies.motion[ball].v = {Real(0), Real(-3), Real(0)};
    scene.update();
    REQUIRE(scene.pairs.manifold.size() == 1);
    CHECK(double(scene.pairs.manifold[0].point[0].separation) == doctest::Approx(0.05));
  }

  TEST_CASE("the surface of a pair follows the rule, and the table of materials") {
    PairScene scene;
    const std::uint32_t floor = scene.add_static(Shape::half_space(), {0, 0, 0});
    const std::uint32_t cube = scene.add_dynamic(kCube, {0, 0.5, 0});
    scene.colliders.surface[floor] = {.friction = Real(0.9),
                                      .static_friction = Real(1.6),
                                      .restitution = Real(0.2),
                                      .rolling_friction = Real(0.01),
                                      .surface_velocity = {Real(1), Real(0), Real(0)},
                                      .material = 3};
    scene.colliders.surface[cube] = {.friction = Real(0.4), .restitution = Real(0.5), .material = 5};
    scene.update();
    const Manifold m = scene.pairs.manifold.at(0);
    CHECK(double(m.friction) == doctest::Approx(0.6));
    CHECK(double(m.static_friction) == doctest::Approx(0.8));
    CHECK(m.restitution == Real(0.5));
    CHECK(m.rolling_friction == Real(0.01));
    CHECK(m.surface_velocity == Vec3{Real(-1), Real(0), Real(0)});
    scene.materials = {{.a = 5, .b = 3, .friction = Real(0.1), .restitution = Real(1)}};
    scene.update();
    CHECK(scene.pairs.manifold.at(0).friction == Real(0.1));
    CHECK(scene.pairs.manifold.at(0).static_friction == Real(0.1));
    CHECK(scene.pairs.manifold.at(0).restitution == Real(1));
  }

  TEST_CASE("merged pairs keep what they remember, in order") {
    hooke::state::Pairs pairs;
    hooke::collision::NarrowPhase narrow_phase;
    narrow_phase.merge_pairs(std::vector<hooke::collision::ColliderPair>{{1, 2}, {1, 4}, {3, 4}}, pairs);
    pairs.pair[1].gap = Real(5);
    narrow_phase.merge_pairs(std::vector<hooke::collision::ColliderPair>{{0, 9}, {1, 4}, {2, 4}}, pairs);
    REQUIRE(pairs.pair.size() == 3);
    CHECK(pairs.pair[0].collider_b == 9);
    CHECK(pairs.pair[1].gap == Real(5));
    CHECK(pairs.pair[2].collider_a == 2);
    CHECK_FALSE(pairs.pair[2].tested);

    // Of those that were asked for, what is not found is gone; the others stay.
    std::vector<std::uint8_t> asked(10, 0);
    asked[9] = asked[3] = 1;
    narrow_phase.merge_pairs(std::vector<hooke::collision::ColliderPair>{{3, 4}}, asked, pairs);
    REQUIRE(pairs.pair.size() == 3);
    CHECK(pairs.pair[0].collider_a == 1);
    CHECK(pairs.pair[0].gap == Real(5));
    CHECK(pairs.pair[1].collider_a == 2);
    CHECK(pairs.pair[2].collider_a == 3);
  }

  TEST_CASE("any number of workers makes the same manifolds") {
    const auto run = [](int workers) {
      PairScene scene;
      hooke::parallel::ThreadPool pool(workers);
      scene.add_static(Shape::half_space(), {0, 0, 0});
      for (int i = 0; i < 40; ++i) {
        const Quat turn = hooke::quaternion_about(Vec3{Real(1), Real(2), Real(3)}, Real(0.1) * Real(i));
        const DVec3 place = {0.7 * (i % 5), 0.4 + 0.65 * (i / 10), 0.6 * (i % 10 / 5)};
        scene.add_dynamic(i % 3 == 0 ? Shape::cylinder(Real(0.3), Real(0.4)) : kCube, place, turn);
      }
      for (int step = 0; step < 3; ++step) {
        std::vector<hooke::collision::ColliderPair> found;
        for (std::uint32_t a = 0; a < 41; ++a) {
          for (std::uint32_t b = a + 1; b < 41; ++b) found.push_back({a, b});
        }
        scene.narrow_phase.merge_pairs(found, scene.pairs);
        scene.narrow_phase.update_manifolds(pool, scene.bodies, scene.colliders, {},
                                            {.dt = Real(0.01), .substeps = 8}, scene.pairs);
        for (std::uint32_t body = 1; body < 41; ++body) scene.move(body, {0.001 * body, -0.002, 0});
      }
      return scene.pairs;
    };
    const hooke::state::Pairs one = run(1);
    const hooke::state::Pairs five = run(5);
    REQUIRE(one.manifold.size() > 40);
    REQUIRE(one.manifold.size() == five.manifold.size());
    for (std::size_t i = 0; i < one.manifold.size(); ++i) {
      const Manifold& a = one.manifold[i];
      const Manifold& b = five.manifold[i];
      REQUIRE(a.point_count == b.point_count);
      CHECK(a.collider_a == b.collider_a);
      CHECK(a.normal == b.normal);
      for (std::size_t k = 0; k < std::size_t(a.point_count); ++k) {
        CHECK(a.point[k].anchor_a == b.point[k].anchor_a);
        CHECK(a.point[k].separation == b.point[k].separation);
        CHECK(a.point[k].key == b.point[k].key);
      }
    }
  }
}
