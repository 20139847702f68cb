#include "render/view.h"

#include <cmath>
#include <doctest/doctest.h>

using hooke::Mat4;
using hooke::Vec3;
using hooke::render::Bounds;
using hooke::render::Camera;
using hooke::render::View;

namespace {

struct Clip {
  float x = 0;
  float y = 0;
  float z = 0;
  float w = 0;
};

Clip to_clip(const Mat4& a, Vec3 p) {
  const auto row = [&](int i) { return a.m[0][i] * p.x + a.m[1][i] * p.y + a.m[2][i] * p.z + a.m[3][i]; };
  return {row(0), row(1), row(2), row(3)};
}

}  // namespace

TEST_SUITE("render/view") {
  TEST_CASE("the target is in the middle, up is up and right is right") {
    const Camera camera = {{3, 2, 5}, {0.5F, 1, 0}, {0, 1, 0}, 50};
    const View view = hooke::render::make_view(camera, 1.5F, {}, nullptr);
    const Clip target = to_clip(view.view_projection, camera.target);
    CHECK(target.x / target.w == doctest::Approx(0).epsilon(1e-4));
    CHECK(target.y / target.w == doctest::Approx(0).epsilon(1e-4));
    const Clip edge = to_clip(view.view_projection, view.eye + 7 * (view.forward + view.up + view.right));
    CHECK(edge.x / edge.w == doctest::Approx(1).epsilon(1e-4));
    CHECK(edge.y / edge.w == doctest::Approx(1).epsilon(1e-4));
    CHECK(length(view.up) == doctest::Approx(std::tan(25 * 3.14159265 / 180)).epsilon(1e-4));
    CHECK(view.up.y > 0);
  }

  TEST_CASE("everything in front of the eye is between near and infinity") {
    const Camera camera = {{0, 1, 10}, {0, 1, 0}, {0, 1, 0}, 50};
    const Bounds objects[] = {{{-1, 0, -1}, {1, 2, 1}}, {{-500, 0, -500}, {-400, 50, -400}}};
    const hooke::render::Ground ground;
    const View view = hooke::render::make_view(camera, 1.5F, objects, &ground);
    for (const Vec3 p : {Vec3{0, 1, 1}, Vec3{-500, 50, -500}, Vec3{0, 0, 9.5F}, Vec3{0, 0, -1e6F}}) {
      const Clip clip = to_clip(view.view_projection, p);
      CHECK(clip.w > 0);
      CHECK(clip.z >= -clip.w);
      CHECK(clip.z <= clip.w);
    }
  }

  TEST_CASE("the shadow map holds every caster that the camera sees, and little more") {
    const Camera camera = {{0, 5, 10}, {0, 0, 0}, {0, 1, 0}, 60};
    const Bounds box = {{-1, 0, -1}, {1, 2, 1}};
    const View view = hooke::render::make_view(camera, 1.5F, std::span(&box, 1), nullptr);
    const auto shadow = hooke::render::make_shadow_view(view, box, {0.3F, 1, 0.2F}, 2048);
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner = {(i & 1) != 0 ? 1.0F : -1.0F, (i & 2) != 0 ? 2.0F : 0.0F,
                           (i & 4) != 0 ? 1.0F : -1.0F};
      const Vec3 place = transform_point(shadow.matrix, corner);
      for (const float part : {place.x, place.y, place.z}) {
        CHECK(part >= 0);
        CHECK(part <= 1);
      }
    }
    // The box's diagonal is 3.46 m; the side is rounded up by at most 2^(1/4).
    CHECK(2048 * shadow.texel_size < 3.47F * 1.02F * 1.19F);
    const Vec3 high = transform_point(shadow.matrix, {0, 2, 0});
    const Vec3 low = transform_point(shadow.matrix, {0, 0, 0});
    CHECK(high.z < low.z);
  }

  TEST_CASE("a far caster outside the picture does not cost resolution") {
    const Camera camera = {{0, 1, 10}, {0, 1, 0}, {0, 1, 0}, 40};
    const Bounds box = {{-1, 0, -1}, {1, 2, 1}};
    const View view = hooke::render::make_view(camera, 1, std::span(&box, 1), nullptr);
    for (const Vec3 far : {Vec3{1000, 0, 0}, Vec3{-1000, 0, 0}, Vec3{0, 0, 1000}, Vec3{0, 0, -1000}}) {
      Bounds all = box;
      extend(all, far);
      const auto shadow = hooke::render::make_shadow_view(view, all, {0, 1, 0}, 2048);
      CHECK(2048 * shadow.texel_size < 40);
    }
  }

  TEST_CASE("a degenerate camera still gives numbers") {
    for (const Camera& camera :
         {Camera{{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, 0}, Camera{{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 400}}) {
      const View view = hooke::render::make_view(camera, 1, {}, nullptr);
      for (const auto& column : view.view_projection.m) {
        for (const float value : column) CHECK(std::isfinite(value));
      }
      CHECK(length(view.right) > 0);
    }
  }
}
