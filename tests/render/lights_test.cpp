#include "render/frame.h"
#include "render/shapes.h"
#include "render/stage.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>

using hooke::ErrorCode;
using hooke::Vec3;
using hooke::render::DrawList;
using hooke::render::DrawMesh;
using hooke::render::Image;
using hooke::render::Light;
using hooke::render_test::brightness;
using hooke::render_test::draw;
using hooke::render_test::make_mesh;
using hooke::render_test::make_renderer;
using hooke::render_test::make_square;
using hooke::render_test::pixel_of;
namespace render = hooke::render;

namespace {

/// A ball and a box on the ground at night.
DrawList night() {
  DrawList list;
  list.camera = {{0, 4, 5}, {0, 0, 0}, {0, 1, 0}, 45};
  list.sun.intensity = 0;
  list.sky.brightness = 0.05F;
  list.ground->grid_spacing = 0;
  DrawMesh box = make_mesh(render::make_box({0.5F, 0.5F, 0.5F}), {0.7F, 0.5F, 0.6F});
  box.transform.m[3][1] = 0.5F;
  list.meshes.push_back(box);
  list.spheres.push_back(
      {{1.2F, 0.4F, 0.5F}, 0.4F, {0.3F, 0.6F, 0.8F}, {.metalness = 0.5F, .roughness = 0.3F}});
  return list;
}

/// A black square before a black sky: what is seen of it is what a light gives.
DrawList square_at_night() {
  DrawList list;
  list.ground.reset();
  list.camera = {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45};
  list.sun.intensity = 0;
  list.sky.brightness = 0;
  list.meshes.push_back(make_mesh(make_square(1), {0.6F, 0.6F, 0.6F}));
  list.meshes[0].surface.roughness = 1;
  return list;
}

int largest_difference(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  int largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<int>(a.pixels[i]) - static_cast<int>(b.pixels[i])));
  return largest;
}

constexpr Light::Kind kKinds[] = {Light::Kind::kDirectional, Light::Kind::kPoint, Light::Kind::kSpot};

}  // namespace

TEST_SUITE("render/lights") {
  TEST_CASE("two lights of half the strength from one place give the picture of one") {
    auto renderer = make_renderer();
    if (!renderer) return;
    for (const Light::Kind kind : kKinds) {
      CAPTURE(static_cast<int>(kind));
      DrawList list = night();
      const Light whole = {.kind = kind,
                           .position = {-1.5F, 2.5F, 1.5F},
                           .direction = {0.6F, -1, -0.6F},
                           .color = {1, 0.8F, 0.6F},
                           .intensity = kind == Light::Kind::kDirectional ? 0.8F : 6.0F};
      const Image dark = draw(*renderer, list);
      list.lights = {whole};
      const Image one = draw(*renderer, list);
      CHECK(largest_difference(dark, one) > 60);
      Light half = whole;
      half.intensity = 0.5F * whole.intensity;
      list.lights = {half, half};
      CHECK(largest_difference(one, draw(*renderer, list)) <= 1);
    }
  }

  TEST_CASE("the light of a point falls off by the square, and is that of a directional one at 1 m") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_at_night();
    const auto middle = [&](const Light& light) {
      list.lights = {light};
      return brightness(pixel_of(draw(*renderer, list), list.camera, {}));
    };
    const int far = middle({.kind = Light::Kind::kDirectional, .direction = {0, 0, -1}, .intensity = 0.6F});
    CHECK(far > 100);
    for (const float distance : {0.5F, 1.0F, 2.0F, 3.0F}) {
      CAPTURE(distance);
      const float strength = 0.6F * distance * distance;
      CHECK(std::abs(middle({.position = {0, 0, distance}, .intensity = strength}) - far) <= 3);
      CHECK(std::abs(middle({.kind = Light::Kind::kSpot,
                             .position = {0, 0, distance},
                             .direction = {0, 0, -1},
                             .intensity = strength}) -
                     far) <= 3);
    }
    // At twice the distance it is a quarter of the light, which is less than half of the brightness shown.
    CHECK(middle({.position = {0, 0, 2}, .intensity = 0.6F}) < 0.65 * far);
  }

  TEST_CASE("a spot lights its cone and nothing else") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_at_night();
    // The rim is at tan(20) = 0.364 and tan(10) = 0.176 of 2 m.
    list.lights = {{.kind = Light::Kind::kSpot,
                    .position = {0, 0, 2},
                    .direction = {0, 0, -1},
                    .intensity = 2.4F,
                    .inner_deg = 10,
                    .outer_deg = 20}};
    const Image image = draw(*renderer, list);
    const auto at = [&](float x) { return brightness(pixel_of(image, list.camera, {x, 0, 0})); };
    const int middle = at(0);
    CHECK(at(0.3F) > 0.85 * middle);
    CHECK(at(0.5F) < 0.8 * middle);
    CHECK(at(0.5F) > 3);
    CHECK(at(0.8F) <= 3);
    CHECK(at(-0.8F) <= 3);
  }

  TEST_CASE("each kind of light casts shadows where it should, and none if it is told so") {
    auto renderer = make_renderer();
    if (!renderer) return;
    for (const Light::Kind kind : kKinds) {
      CAPTURE(static_cast<int>(kind));
      DrawList list = night();
      list.spheres.clear();
      // From the right and above at 45 degrees to the middle of the box.
      list.lights = {{.kind = kind,
                      .position = {3, 3.5F, 0},
                      .direction = {-1, -1, 0},
                      .intensity = kind == Light::Kind::kDirectional ? 0.8F : 12.0F,
                      .inner_deg = 40,
                      .outer_deg = 50}};
      const Image shadowed = draw(*renderer, list);
      const auto at = [&](const Image& image, float x) {
        return brightness(pixel_of(image, list.camera, {x, 0, 0.2F}));
      };
      list.lights[0].casts_shadow = false;
      const Image open = draw(*renderer, list);
      CHECK(at(shadowed, -0.7F) < 0.4 * at(open, -0.7F));
      CHECK(std::abs(at(shadowed, 1.0F) - at(open, 1.0F)) <= 2);
      CHECK(std::abs(at(shadowed, -3.0F) - at(open, -3.0F)) <= 2);
    }
  }

  TEST_CASE("a lamp among four posts throws four shadows away from itself") {
    auto renderer = make_renderer({.width = 480, .height = 480});
    if (!renderer) return;
    DrawList list = night();
    list.meshes.clear();
    list.spheres.clear();
    list.camera = {{0, 9, 0.01F}, {0, 0, 0}, {0, 1, 0}, 45};
    for (const Vec3 place : {Vec3{1, 0.5F, 0}, Vec3{-1, 0.5F, 0}, Vec3{0, 0.5F, 1}, Vec3{0, 0.5F, -1}}) {
      DrawMesh post = make_mesh(render::make_box({0.15F, 0.5F, 0.15F}), {0.7F, 0.7F, 0.7F});
      for (int k = 0; k < 3; ++k) post.transform.m[3][k] = k == 0 ? place.x : k == 1 ? place.y : place.z;
      list.meshes.push_back(post);
    }
    list.lights = {{.position = {0, 1, 0}, .intensity = 3}};
    const Image image = draw(*renderer, list);
    const auto at = [&](float x, float z) { return brightness(pixel_of(image, list.camera, {x, 0, z})); };
    for (const auto& [x, z] : {std::array{1.0F, 0.0F}, {-1.0F, 0.0F}, {0.0F, 1.0F}, {0.0F, -1.0F}}) {
      CAPTURE(x);
      CAPTURE(z);
      const float turned = 1.8F * std::sqrt(0.5F);
      CHECK(at(1.8F * x, 1.8F * z) < 0.6 * at(turned * (x - z), turned * (x + z)));
    }
  }

  TEST_CASE("more lights or shadows than there may be are refused with their number") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = night();
    list.lights.assign(9, {.casts_shadow = false});
    auto drawn = renderer->draw(list);
    REQUIRE_FALSE(drawn.has_value());
    CHECK(drawn.error().code == ErrorCode::kLimitExceeded);
    CHECK(drawn.error().message == "9 lights, and a picture has at most 8");
    list.lights.assign(3, {});
    drawn = renderer->draw(list);
    REQUIRE_FALSE(drawn.has_value());
    CHECK(
        drawn.error().message ==
        "their shadows need 18 maps, and a picture has at most 12: six for a point light, one for any other");
    list.lights.assign(2, {});
    CHECK(renderer->draw(list).has_value());
    list.lights.clear();
    CHECK(renderer->draw(list).has_value());
  }

  TEST_CASE("lights with odd values make a picture without errors") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = night();
    list.lights = {{.kind = Light::Kind::kSpot, .direction = {}, .inner_deg = 50, .outer_deg = 10},
                   {.kind = Light::Kind::kDirectional, .direction = {}},
                   {.kind = Light::Kind::kPoint, .position = {0, 0.5F, 0}, .intensity = -1}};
    CHECK(renderer->draw(list).has_value());
    list.meshes.clear();
    list.spheres.clear();
    CHECK(renderer->draw(list).has_value());
  }
}
