#include "scenes/scene_audit.h"

#include "scenes/scene_builder.h"
#include "scenes/scene_changes.h"

#include <doctest/doctest.h>

/// An audit that sees nothing passes everything: here each figure has something to see, or nothing.

namespace hooke {

using namespace test;

namespace {

SceneBuilder with_floor() {
  SceneBuilder builder;
  builder.scene.seconds = 2;
  (void)builder.box({2, 0.5, 2}, {0, -0.5, 0}, 0);
  builder.scene.objects.bodies.back().tag.name = "floor";
  return builder;
}

/// A rod of 1 m that a motor turns up about its end at 0.5 rad/s.
std::string add_arm(SceneBuilder& builder) {
  std::string arm = builder.box({0.5, 0.05, 0.05}, {0.5, 2, 0}, 3);
  SceneHook& hinge = builder.hook(HookKind::kHinge, "", arm, {0, 2, 0});
  hinge.desc.axis = {0, 0, 1};
  hinge.desc.motor = {.speed = Real(0.5), .max_force = Real(100)};
  return arm;
}

}  // namespace

TEST_SUITE("scenes/audit") {
  TEST_CASE("boxes that fall and come to rest are sound") {
    SceneBuilder builder = with_floor();
    for (int i = 0; i < 3; ++i) (void)builder.box({0.2, 0.2, 0.2}, {0, 0.3 + 0.5 * i, 0}, 1);
    const Audit audit = run_audit(builder.scene);
    for (std::size_t i = 0; i < kFigures; ++i) {
      const auto figure = static_cast<Figure>(i);
      CAPTURE(name_of(figure));
      CHECK(audit.of(figure).value <= limit_of(figure));
    }
  }

  TEST_CASE("a platform that lifts a box is seen to give it energy") {
    SceneBuilder builder;
    builder.scene.seconds = 2;
    (void)builder.box({1, 0.1, 1}, {0, 1, 0}, 0);
    builder.scene.objects.bodies.back().desc.kind = BodyKind::kKinematic;
    builder.scene.objects.bodies.back().desc.motion = {.kind = MotionDesc::Kind::kConstantVelocity,
                                                       .velocity = {0, Real(0.5), 0}};
    (void)builder.box({0.2, 0.2, 0.2}, {0, 1.3, 0}, 3);
    CHECK(run_audit(builder.scene).of(Figure::kEnergy).value == doctest::Approx(1 / 1.3).epsilon(0.02));
  }

  TEST_CASE("the work of a motor that lifts a load is no gain, and neither is the swing of a spring") {
    SceneBuilder builder;
    builder.scene.seconds = 2;
    (void)add_arm(builder);
    const std::string jack = builder.box({0.1, 0.1, 0.1}, {3, 1, 0}, 5);
    SceneHook& slider = builder.hook(HookKind::kSlider, "", jack, {3, 1, 0});
    slider.desc.axis = {0, 1, 0};
    slider.desc.motor = {.speed = Real(0.5), .max_force = Real(200)};
    const std::string ball = builder.sphere(0.1, {6, 1, 0}, 1);
    builder.hook(HookKind::kSlider, "", ball, {6, 1, 0}).desc.spring = {.stiffness = Real(100),
                                                                        .target = Real(0.3)};
    CHECK(run_audit(builder.scene).of(Figure::kEnergy).value < limit_of(Figure::kEnergy));
  }

  TEST_CASE("a hook that cannot close is seen, and so is a body that a hook holds in the floor") {
    SceneBuilder builder = with_floor();
    (void)builder.rope(line({-1, 1, 0}, {-0.5, 1, 0}, 6), 1);
    builder.pin_both_ends();
    (void)builder.rope(line({0.5, 1, 0}, {1, 1, 0}, 6), 1);
    builder.pin_both_ends();
    builder.tie("rope_0", "rope_1", 0).a_point = ScenePoint{.index = 5};
    const std::string ball = builder.sphere(0.2, {0, 0.1, 1}, 1);
    builder.hook(HookKind::kFixed, "", ball, {0, 0.1, 1});
    const Audit audit = run_audit(builder.scene);
    CHECK(audit.of(Figure::kRestGap).value == doctest::Approx(1 / 0.3).epsilon(0.01));
    CHECK(audit.of(Figure::kRestOverlap).value == doctest::Approx(0.1 / 0.4).epsilon(0.1));
  }

  TEST_CASE("a soft rope is seen to stretch by its load over its stiffness") {
    SceneBuilder builder;
    builder.scene.seconds = 1;
    (void)builder.rope(line({0, 3, 0}, {0, 2, 0}, 11), 0.001);
    builder.scene.objects.ropes.back().pins = {{}};
    builder.scene.objects.ropes.back().desc.stiffness = Real(1000);
    builder.tie(builder.sphere(0.1, {0, 2, 0}, 10), "rope_0", 10);
    CHECK(run_audit(builder.scene).of(Figure::kRopeStretch).value ==
          doctest::Approx(2 * 10 * 9.81 / 1000).epsilon(0.1));
  }

  TEST_CASE("what falls beside the floor is outside") {
    SceneBuilder builder = with_floor();
    (void)builder.sphere(0.1, {4, 1, 0}, 1);
    CHECK(run_audit(builder.scene).of(Figure::kOutside).value == 1);
  }

  TEST_CASE("in a mirror a driven arm turns the other way and comes to the same height") {
    SceneBuilder builder;
    builder.scene.seconds = 1;
    const std::string arm = add_arm(builder);
    const DVec3 end = run_audit(builder.scene).ends.at(arm);
    const DVec3 other = run_audit(mirrored(builder.scene)).ends.at(arm);
    CHECK(end.y == doctest::Approx(2 + 0.5 * 0.4794).epsilon(0.01));
    CHECK(other.y == doctest::Approx(end.y).epsilon(1e-4));
    CHECK(other.x == doctest::Approx(-end.x).epsilon(1e-4));
  }
}

}  // namespace hooke
