#include "collision/narrow_phase.h"

#include "collision/scene.h"

#include <cmath>
#include <doctest/doctest.h>

using hooke::DVec3;
using hooke::Real;
using hooke::Shape;
using hooke::Vec3;
using hooke::state::Manifold;
using hooke::test::PairScene;

namespace {

const Shape kCube = Shape::box({Real(0.5), Real(0.5), Real(0.5)});

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
      CHECK(p.separation == doctest::Approx(-0.001).epsilon(1e-3));
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
}
