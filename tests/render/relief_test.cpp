#include "render/image.h"
#include "render/stage.h"

#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <memory>

using hooke::Vec3;
using hooke::render::DrawList;
using hooke::render::Image;
using hooke::render_test::brightness;
using hooke::render_test::draw;
using hooke::render_test::make_mesh;
using hooke::render_test::make_renderer;
using hooke::render_test::make_square;
using hooke::render_test::pixel_of;
using hooke::render_test::Rgb;
namespace render = hooke::render;

namespace {

std::shared_ptr<const Image> one_pixel(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return std::make_shared<const Image>(Image{1, 1, 3, {r, g, b}});
}

/// The image of a normal that leans by an angle toward u and v.
std::shared_ptr<const Image> leaning(float u, float v) {
  const auto byte = [](float x) { return static_cast<std::uint8_t>(std::lround(128 + 127 * x)); };
  return one_pixel(byte(u), byte(v), byte(std::sqrt(1 - u * u - v * v)));
}

/// A square before the bare sky, lit from the right and a little from above.
DrawList lit_square() {
  DrawList list;
  list.ground.reset();
  list.camera = {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45};
  list.sun.direction = {1, 0.4F, 1};
  list.sky.brightness = 0.1F;
  list.meshes.push_back(make_mesh(make_square(1), {0.6F, 0.6F, 0.6F}));
  return list;
}

}  // namespace

TEST_SUITE("render/relief") {
  TEST_CASE("flat normals and a full finish draw what is drawn without them") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = lit_square();
    for (const auto shading : {render::Shading::kSolid, render::Shading::kCloth}) {
      list.meshes[0].surface = {.shading = shading, .metalness = 0.3F, .roughness = 0.5F};
      list.meshes[0].normals = nullptr;
      list.meshes[0].finish = nullptr;
      const Rgb plain = pixel_of(draw(*renderer, list), list.camera, {0.2F, 0.1F, 0});
      list.meshes[0].normals = one_pixel(128, 128, 255);
      list.meshes[0].finish = one_pixel(0, 255, 255);
      const Rgb flat = pixel_of(draw(*renderer, list), list.camera, {0.2F, 0.1F, 0});
      CHECK(std::abs(plain.r - flat.r) <= 1);
      CHECK(std::abs(plain.g - flat.g) <= 1);
      CHECK(std::abs(plain.b - flat.b) <= 1);
    }
  }

  TEST_CASE("a normal that leans to the light is as bright as a surface that does") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = lit_square();
    const auto shown = [&] { return brightness(pixel_of(draw(*renderer, list), list.camera, {})); };
    const int flat = shown();
    // A square that is turned by an angle about y, or about x, against a normal that leans by as much.
    for (const float angle : {0.4F, -0.4F}) {
      list.meshes[0].normals = leaning(std::sin(angle), 0);
      const int along_u = shown();
      list.meshes[0].normals = leaning(0, std::sin(angle));
      const int along_v = shown();
      list.meshes[0].normals = nullptr;
      list.meshes[0].transform =
          hooke::make_transform(Vec3{}, hooke::quaternion_about(Vec3{0, 1, 0}, angle), Vec3{1, 1, 1});
      CHECK(std::abs(along_u - shown()) <= 9);
      list.meshes[0].transform =
          hooke::make_transform(Vec3{}, hooke::quaternion_about(Vec3{1, 0, 0}, -angle), Vec3{1, 1, 1});
      CHECK(std::abs(along_v - shown()) <= 9);
      list.meshes[0].transform = {};
      CHECK((along_u > flat) == (angle > 0));
    }
  }

  TEST_CASE("the relief turns with the texture, and its strength scales or reverses it") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = lit_square();
    const auto shown = [&] { return brightness(pixel_of(draw(*renderer, list), list.camera, {})); };
    const int flat = shown();
    list.meshes[0].normals = leaning(0.4F, 0);
    const int right = shown();
    list.meshes[0].surface.relief = 0;
    CHECK(std::abs(shown() - flat) <= 2);
    list.meshes[0].surface.relief = -1;
    const int left = shown();
    CHECK(right > flat + 20);
    CHECK(left < flat - 20);
    // A mirrored texture leans the other way.
    render::MeshGeometry mirrored = make_square(1);
    for (render::Vertex& vertex : mirrored.vertices) vertex.u = 1 - vertex.u;
    list.meshes[0].surface.relief = 1;
    list.meshes[0].geometry = std::make_shared<const render::MeshGeometry>(mirrored);
    CHECK(std::abs(shown() - left) <= 2);
  }

  TEST_CASE("the image of a finish makes a metal where it is blue, and a mirror where it is not green") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = lit_square();
    list.meshes[0].color = {0.9F, 0.3F, 0.2F};
    list.meshes[0].surface = {.metalness = 1, .roughness = 1};
    const auto shown = [&] { return pixel_of(draw(*renderer, list), list.camera, {}); };
    const auto with = [&](float metalness, float roughness) {
      list.meshes[0].finish = nullptr;
      list.meshes[0].surface = {.metalness = metalness, .roughness = roughness};
      return shown();
    };
    const Rgb insulator = with(0, 1);
    const Rgb mirror = with(1, 0.2F);
    list.meshes[0].surface = {.metalness = 1, .roughness = 1};
    list.meshes[0].finish = one_pixel(255, 255, 0);
    const Rgb without_blue = shown();
    CHECK(std::abs(brightness(without_blue) - brightness(insulator)) <= 2);
    list.meshes[0].finish = one_pixel(255, 51, 255);
    CHECK(std::abs(brightness(shown()) - brightness(mirror)) <= 2);
    CHECK(std::abs(brightness(insulator) - brightness(mirror)) > 20);
  }

  TEST_CASE("heights in grays become normals, and an image of normals stays as it is") {
    // A ramp that rises to the right by 8 of 255 a pixel, of 16 pixels.
    Image ramp = {16, 4, 3, {}};
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 16; ++x) ramp.pixels.insert(ramp.pixels.end(), 3, static_cast<std::uint8_t>(8 * x));
    }
    const Image normals = render::normals_of(ramp);
    REQUIRE(render::is_consistent(normals));
    const std::size_t middle = 3 * (16 + 8);
    // Its slope in widths is 8 / 255 times 16 / 64: the normal leans to the left.
    const float slope = 8.0F / 255 * 16 * render::kReliefHeight;
    CHECK(normals.pixels[middle] == std::lround(128 - 127 * slope / std::sqrt(1 + slope * slope)));
    CHECK(normals.pixels[middle + 1] == 128);
    CHECK(normals.pixels[middle + 2] > 250);
    const Image colored = {1, 1, 3, {140, 120, 250}};
    CHECK(render::normals_of(colored) == colored);
    const Image rising = {1, 4, 3, {0, 0, 0, 80, 80, 80, 160, 160, 160, 240, 240, 240}};
    // The rows go down, so heights that grow with them lean the normal up.
    CHECK(render::normals_of(rising).pixels[4] > 128);
  }
}
