#include "render/renderer.h"

#include "render/shapes.h"
#include "render/stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>

using hooke::ErrorCode;
using hooke::Vec3;
using hooke::render::DrawList;
using hooke::render::DrawMesh;
using hooke::render::Image;
using hooke::render_test::brightness;
using hooke::render_test::draw;
using hooke::render_test::make_mesh;
using hooke::render_test::make_renderer;
using hooke::render_test::make_square;
using hooke::render_test::pixel_at;
using hooke::render_test::pixel_of;
using hooke::render_test::Rgb;
namespace render = hooke::render;

namespace {

/// A box of 1 m on the ground, the sun to the right at 45 degrees, no grid.
DrawList box_on_ground() {
  DrawList list;
  list.camera = {{0, 4, 5}, {0, 0, 0}, {0, 1, 0}, 45};
  list.sun.direction = {1, 1, 0};
  list.ground->grid_spacing = 0;
  DrawMesh box = make_mesh(render::make_box({0.5F, 0.5F, 0.5F}), {0.7F, 0.7F, 0.7F});
  box.transform.m[3][1] = 0.5F;
  list.meshes.push_back(box);
  return list;
}

/// A square at the origin before the bare sky, seen from the front.
DrawList square_before_sky(render::Color color) {
  DrawList list;
  list.ground.reset();
  list.camera = {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45};
  list.sun.direction = {0, 0, 1};
  list.meshes.push_back(make_mesh(make_square(1), color));
  return list;
}

std::shared_ptr<const Image> make_image(int width, int height, int channels,
                                        std::vector<std::uint8_t> pixels) {
  return std::make_shared<const Image>(Image{width, height, channels, std::move(pixels)});
}

}  // namespace

TEST_SUITE("render/renderer") {
  TEST_CASE("a box darkens the ground behind it, from its very edge") {
    auto renderer = make_renderer();
    if (!renderer) return;
    const DrawList list = box_on_ground();
    const Image image = draw(*renderer, list);
    // At 45 degrees the shadow is as long as the box is high: from x = -0.5 to -1.5.
    const int beside = brightness(pixel_of(image, list.camera, {1.0F, 0, 0.3F}));
    CHECK(brightness(pixel_of(image, list.camera, {-1.0F, 0, 0.3F})) < 0.7 * beside);
    CHECK(brightness(pixel_of(image, list.camera, {-1.46F, 0, 0.3F})) < 0.7 * beside);
    CHECK(brightness(pixel_of(image, list.camera, {-0.54F, 0, 0.3F})) < 0.7 * beside);
    CHECK(brightness(pixel_of(image, list.camera, {-1.54F, 0, 0.3F})) > 0.95 * beside);
    CHECK(brightness(pixel_of(image, list.camera, {0.54F, 0, 0.3F})) > 0.95 * beside);
  }

  TEST_CASE("a thin lid shadows the ground as a tall box does") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = box_on_ground();
    list.sun.direction = {0, 1, 0};
    list.meshes = {make_mesh(render::make_box({0.5F, 0.004F, 0.5F}), {0.7F, 0.7F, 0.7F})};
    list.meshes[0].transform.m[3][1] = 1;
    const Image image = draw(*renderer, list);
    const int beside = brightness(pixel_of(image, list.camera, {1.5F, 0, 0.3F}));
    // The eye looks below the lid at the ground in front of its middle.
    CHECK(brightness(pixel_of(image, list.camera, {0, 0, 0.42F})) < 0.7 * beside);

    // A wide floor neither takes the whole shadow map nor loses the shadow on it.
    list.meshes.push_back(make_mesh(render::make_box({40, 0.1F, 40}), {0.7F, 0.7F, 0.7F}));
    list.meshes.push_back(make_mesh(render::make_box({0.1F, 0.5F, 0.1F}), {0.7F, 0.7F, 0.7F}));
    list.meshes[2].transform.m[3][0] = -1.5F;
    const Image floor = draw(*renderer, list);
    CHECK(brightness(pixel_of(floor, list.camera, {0, 0.1F, 0.42F})) <
          0.7 * brightness(pixel_of(floor, list.camera, {1.5F, 0.1F, 0.3F})));
  }

  TEST_CASE("the half shadow is as wide as the sun's disk seen from the ground") {
    auto renderer = make_renderer({.width = 800, .height = 800});
    if (!renderer) return;
    DrawList list = box_on_ground();
    list.camera = {{0, 6, 0.01F}, {0, 0, 0}, {0, 1, 0}, 30};
    list.sun = {.direction = {0, 1, 0}, .half_angle_deg = 5};
    // The rim of a lid is at x = 0; it is too small to hide its shadow, as the sun stands a little aside.
    const auto width = [&](float height) {
      list.sun.direction = {-1, 2, 0};
      list.meshes = {make_mesh(render::make_box({0.5F, 0.004F, 0.5F}), {0.7F, 0.7F, 0.7F})};
      list.meshes[0].transform.m[3][1] = height;
      const Image image = draw(*renderer, list);
      const auto at = [&](float x) { return brightness(pixel_of(image, list.camera, {x, 0, 0})); };
      // Toward +x the shadow ends around half a side plus half the height.
      const float end = 0.5F + 0.5F * height;
      const int dark = at(end - 0.25F);
      const int bright = at(end + 0.35F);
      int between = 0;
      for (float x = end - 0.25F; x < end + 0.35F; x += 0.005F) {
        const int here = at(x);
        if (here > dark + 0.1F * (bright - dark) && here < dark + 0.9F * (bright - dark)) ++between;
      }
      return 0.005F * static_cast<float>(between);
    };
    // Rays reach the ground after a way of height / sin; the disk is stretched by 1 / sin once more. Four
    // fifths of it are between a tenth and nine tenths of the light.
    const float slant = 2 / std::sqrt(5.0F);
    for (const float height : {0.5F, 1.0F}) {
      const float full = 2 * std::tan(5 * 3.14159265F / 180) * height / (slant * slant);
      CHECK(width(height) == doctest::Approx(0.7F * full).epsilon(0.3));
    }
  }

  TEST_CASE("things near each other keep the light of the sky from one another") {
    const render::RendererOptions size = {.width = 640, .height = 480};
    auto renderer = make_renderer(size);
    if (!renderer) return;
    render::RendererOptions without = size;
    without.occlusion = false;
    auto plain = make_renderer(without);
    REQUIRE(plain);
    DrawList list = box_on_ground();
    list.sun.intensity = 0;
    const Image seen = draw(*renderer, list);
    const Image all = draw(*plain, list);
    const auto part = [&](Vec3 place) {
      return static_cast<float>(brightness(pixel_of(seen, list.camera, place))) /
             static_cast<float>(brightness(pixel_of(all, list.camera, place)));
    };
    CHECK(part({0, 0, 0.54F}) < 0.85F);
    CHECK(part({0, 0.05F, 0.5F}) < 0.9F);
    CHECK(part({0, 0, 1.5F}) > 0.98F);
    CHECK(part({0, 1, 0.2F}) > 0.98F);
  }

  TEST_CASE("bright colors keep their hue, and white does not clip") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({0.95F, 0.45F, 0.10F});
    list.sun.intensity = 3;
    const Rgb orange = pixel_of(draw(*renderer, list), list.camera, {});
    CHECK(orange.r > orange.g + 30);
    CHECK(orange.g > orange.b + 30);
    list.meshes[0].color = {0.92F, 0.92F, 0.92F};
    list.sun.intensity = 1;
    const Rgb white = pixel_of(draw(*renderer, list), list.camera, {});
    CHECK(white.g > 200);
    CHECK(white.r < 255);
  }

  TEST_CASE("a metal mirrors the sky, an insulator of the same color shows its own") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({0.9F, 0.2F, 0.2F});
    list.sun.direction = {1, 0, 0};
    list.sky.zenith = list.sky.horizon = {0.2F, 0.9F, 0.2F};
    list.sky.clouds = 0;
    // Turned so that it mirrors what is above the eye.
    list.meshes[0].transform =
        hooke::make_transform(Vec3{}, hooke::quaternion_about(Vec3{1, 0, 0}, -0.6F), Vec3{1, 1, 1});
    list.meshes[0].surface = {.roughness = 0.1F};
    const Rgb painted = pixel_of(draw(*renderer, list), list.camera, {});
    list.meshes[0].color = {0.9F, 0.9F, 0.9F};
    list.meshes[0].surface.metalness = 1;
    const Rgb mirror = pixel_of(draw(*renderer, list), list.camera, {});
    CHECK(mirror.g > 2 * mirror.r);
    CHECK(painted.g < mirror.g);
  }

  TEST_CASE("glass colors what is behind it, and its shadow is pale") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({0.9F, 0.9F, 0.9F});
    DrawMesh pane = make_mesh(make_square(0.5F), {0.3F, 0.9F, 0.4F});
    pane.transform.m[3][2] = 0.5F;
    pane.surface.transmission = 0.95F;
    list.meshes.push_back(pane);
    const Image image = draw(*renderer, list);
    const Rgb behind = pixel_of(image, list.camera, {});
    CHECK(behind.g > behind.r + 30);
    CHECK(behind.g > behind.b + 30);

    DrawList lid = box_on_ground();
    lid.sun.direction = {1, 1, 0};
    const auto shadow = [&](float transmission) {
      lid.meshes[0].surface.transmission = transmission;
      const Image picture = draw(*renderer, lid);
      return brightness(pixel_of(picture, lid.camera, {-1.0F, 0, 0.3F}));
    };
    CHECK(shadow(1) > 1.2 * shadow(0));
  }

  TEST_CASE("a cloth lets light through where a board does not") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({0.8F, 0.6F, 0.5F});
    list.meshes[0].two_sided = true;
    list.sun.direction = {0, 0.2F, -1};
    const int board = brightness(pixel_of(draw(*renderer, list), list.camera, {}));
    list.meshes[0].surface.shading = render::Shading::kCloth;
    CHECK(brightness(pixel_of(draw(*renderer, list), list.camera, {})) > 1.15 * board);
  }

  TEST_CASE("hairs shine across their direction and cast a shadow") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = box_on_ground();
    list.camera = {{0, 1.5F, 3}, {0, 0.5F, 0}, {0, 1, 0}, 30};
    list.meshes.clear();
    const Image empty = draw(*renderer, list);
    for (int i = -10; i <= 10; ++i) {
      const float x = 0.01F * static_cast<float>(i);
      list.ropes.push_back({{{x, 1, 0}, {x, 0.7F, 0}, {x, 0.4F, 0}}, 0.004F});
      list.ropes.back().surface = {.shading = render::Shading::kHair, .roughness = 0.4F};
    }
    const Image image = draw(*renderer, list);
    const auto change = [&](Vec3 place) {
      return std::abs(brightness(pixel_of(image, list.camera, place)) -
                      brightness(pixel_of(empty, list.camera, place)));
    };
    CHECK(change({0, 0.7F, 0}) > 30);
    CHECK(change({0.4F, 0.7F, 0}) < 5);
    // At 45 degrees the hair from 0.4 m to 1 m shadows the ground as far beside it.
    CHECK(change({-0.7F, 0, 0}) > 30);
  }

  TEST_CASE("nothing is shadowed without a shadow map") {
    auto renderer = make_renderer({hooke::render_test::kWidth, hooke::render_test::kHeight, 4, 0});
    if (!renderer) return;
    const DrawList list = box_on_ground();
    const Image image = draw(*renderer, list);
    const int beside = brightness(pixel_of(image, list.camera, {1.0F, 0, 0.3F}));
    CHECK(brightness(pixel_of(image, list.camera, {-1.0F, 0, 0.3F})) > 0.95 * beside);
  }

  TEST_CASE("a slab and a ball do not shadow themselves under a low sun") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list;
    list.camera = {{0, 3, 4}, {0, 0, 0}, {0, 1, 0}, 45};
    list.sun.direction = {1, 0.25F, 0.2F};
    list.ground.reset();
    list.meshes.push_back(make_mesh(render::make_box({2, 0.1F, 2}), {0.7F, 0.7F, 0.7F}));
    const Image slab = draw(*renderer, list);
    const int middle = brightness(pixel_of(slab, list.camera, {0, 0.1F, 0}));
    for (int i = -80; i <= 80; ++i) {
      const float x = 0.02F * static_cast<float>(i);
      CHECK(std::abs(brightness(pixel_of(slab, list.camera, {x, 0.1F, 0.3F * x})) - middle) <= 6);
    }
    list.meshes = {make_mesh(render::make_sphere(5), {0.7F, 0.7F, 0.7F})};
    const Image with_shadows = draw(*renderer, list);
    auto plain = make_renderer({hooke::render_test::kWidth, hooke::render_test::kHeight, 4, 0});
    REQUIRE(plain);
    const Image without_shadows = draw(*plain, list);
    int different = 0;
    for (std::size_t i = 0; i < with_shadows.pixels.size(); ++i) {
      if (std::abs(with_shadows.pixels[i] - without_shadows.pixels[i]) > 12) ++different;
    }
    // A ball lies in nobody's shadow but its own, which the angle to the sun darkens anyway.
    CHECK(different == 0);
  }

  TEST_CASE("a texture shows its colors, its top row at v = 1") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({1, 1, 1});
    // Two rows of blue above two rows of red.
    list.meshes[0].texture = make_image(1, 4, 3, {0, 0, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0});
    const Image image = draw(*renderer, list);
    const Rgb top = pixel_of(image, list.camera, {0, 0.5F, 0});
    const Rgb bottom = pixel_of(image, list.camera, {0, -0.5F, 0});
    CHECK(top.b > 150);
    CHECK(top.r < 0.4 * top.b);
    CHECK(bottom.r > 150);
    CHECK(bottom.b < 0.4 * bottom.r);
  }

  TEST_CASE("a two-sided cloth is lit from the side one looks at, a one-sided one is not seen from behind") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({0.7F, 0.3F, 0.3F});
    list.meshes[0].two_sided = true;
    const auto middle = [&](float eye_z, float sun_z) {
      list.camera.eye = {0, 0, eye_z};
      list.sun.direction = {0, 0, sun_z};
      return brightness(pixel_of(draw(*renderer, list), list.camera, {}));
    };
    const int front = middle(4, 1);
    const int back = middle(-4, -1);
    CHECK(std::abs(front - back) <= 3);
    CHECK(middle(-4, 1) < 0.7 * front);
    CHECK(middle(4, -1) < 0.7 * front);

    const Rgb cloth = pixel_of(draw(*renderer, list), list.camera, {});
    CHECK(cloth.r > cloth.b + 20);
    list.meshes[0].two_sided = false;
    list.camera.eye = {0, 0, -4};
    const Rgb sky = pixel_of(draw(*renderer, list), list.camera, {});
    CHECK(sky.b >= sky.r);
  }

  TEST_CASE("a mirrored mesh keeps its outside outside") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({0.7F, 0.3F, 0.3F});
    const int plain = brightness(pixel_of(draw(*renderer, list), list.camera, {0.3F, 0, 0}));
    list.meshes[0].transform.m[0][0] = -1;
    CHECK(brightness(pixel_of(draw(*renderer, list), list.camera, {0.3F, 0, 0})) == plain);
  }

  TEST_CASE("a rope is as wide as its diameter, to one pixel") {
    auto renderer = make_renderer({400, 400});
    if (!renderer) return;
    DrawList list;
    list.ground.reset();
    list.camera = {{0, 0, 20}, {0, 0, 0}, {0, 1, 0}, 6};
    const Image empty = draw(*renderer, list);
    for (const float radius : {0.05F, 0.2F}) {
      list.ropes = {{{{-3, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {3, 0, 0}}, radius}};
      const Image image = draw(*renderer, list);
      const float half_height = 20 * std::tan(3 * 3.14159265F / 180);
      const float expected = 2 * radius * 200 / half_height;
      for (const int x : {40, 200, 333}) {
        int covered = 0;
        for (int y = 0; y < 400; ++y) {
          const Rgb with = pixel_at(image, x, y);
          const Rgb without = pixel_at(empty, x, y);
          // Half covered pixels at both rims count half.
          const int change = std::abs(with.r - without.r) + std::abs(with.b - without.b);
          if (change > 20) ++covered;
        }
        CHECK(std::abs(static_cast<float>(covered) - expected) <= 1.0F + 1e-3F);
      }
    }
  }

  TEST_CASE("the ground meets the sky in a level line at the eye's height") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list;
    list.camera = {{0, 2, 10}, {0, 2, 0}, {0, 1, 0}, 60};
    list.ground->color = {0.2F, 0.2F, 0.2F};
    list.ground->grid_spacing = 0.5F;
    const Image image = draw(*renderer, list);
    const int sky = brightness(pixel_at(image, 0, 100));
    int lowest = 0;
    int highest = image.height;
    for (int x = 0; x < image.width; ++x) {
      int row = 100;
      while (row < image.height && brightness(pixel_at(image, x, row)) > 0.75 * sky) ++row;
      lowest = std::max(lowest, row);
      highest = std::min(highest, row);
    }
    CHECK(lowest - highest <= 1);
    // Below the middle by no more than the fog's depth.
    CHECK(highest >= 120);
    CHECK(lowest <= 132);
  }

  TEST_CASE("holes of a texture show what is behind and let the sun through") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = box_on_ground();
    list.sun.direction = {0, 1, 0};
    // A lid at a height of 1, open on the left half.
    render::MeshGeometry lid = make_square(0.8F);
    for (auto& vertex : lid.vertices) {
      vertex.position = {vertex.position.x, 1, -vertex.position.y};
      vertex.normal = {0, 1, 0};
    }
    list.meshes = {make_mesh(lid, {1, 0, 0})};
    list.meshes[0].texture = make_image(2, 1, 4, {255, 255, 255, 0, 255, 255, 255, 255});
    list.meshes[0].alpha = render::AlphaMode::kCutout;
    list.meshes[0].two_sided = true;
    const Image image = draw(*renderer, list);
    const Rgb hole = pixel_of(image, list.camera, {-0.6F, 1, 0});
    const Rgb solid = pixel_of(image, list.camera, {0.6F, 1, 0});
    CHECK(solid.r > 2.5 * solid.b);
    CHECK(hole.b > 0.8 * hole.r);
    const int beside = brightness(pixel_of(image, list.camera, {1.5F, 0, 0.7F}));
    CHECK(brightness(pixel_of(image, list.camera, {-0.6F, 0, 0.7F})) > 0.95 * beside);
    CHECK(brightness(pixel_of(image, list.camera, {0.6F, 0, 0.7F})) < 0.7 * beside);
  }

  TEST_CASE("see-through things mix with what is behind, whatever their order in the list") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({1, 0, 0});
    list.sky.ambient = 0;
    DrawMesh pane = make_mesh(make_square(1.2F), {0, 1, 0});
    pane.transform.m[3][2] = 0.5F;
    pane.opacity = 0.4F;
    DrawMesh nearer = make_mesh(make_square(1.2F), {0, 0, 1});
    nearer.transform.m[3][2] = 1;
    nearer.opacity = 0.4F;
    list.meshes.push_back(pane);
    list.meshes.push_back(nearer);
    const Image first = draw(*renderer, list);
    const Rgb mixed = pixel_of(first, list.camera, {});
    CHECK(mixed.r > 60);
    CHECK(mixed.g > 60);
    CHECK(mixed.b > mixed.g);
    std::reverse(list.meshes.begin(), list.meshes.end());
    CHECK(draw(*renderer, list) == first);
  }

  TEST_CASE("copies of one mesh keep their own colors and places") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({1, 0, 0});
    list.camera.eye = {0, 0, 8};
    list.meshes.push_back(list.meshes[0]);
    list.meshes[0].transform.m[3][0] = -1.2F;
    list.meshes[1].transform.m[3][0] = 1.2F;
    list.meshes[1].color = {0, 0, 1};
    list.spheres = {{{0, 2, 0}, 0.5F, {0, 1, 0}}};
    const Image image = draw(*renderer, list);
    CHECK(pixel_of(image, list.camera, {-1.2F, 0, 0}).r > 150);
    CHECK(pixel_of(image, list.camera, {1.2F, 0, 0}).b > 150);
    CHECK(pixel_of(image, list.camera, {0, 2, 0}).g > 150);
    CHECK(pixel_of(image, list.camera, {0, 2.45F, 0}).r <
          0.5 * pixel_of(image, list.camera, {0, 2.45F, 0}).g);
  }

  TEST_CASE("vertices are read again when their revision rises") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({1, 0, 0});
    const auto geometry = std::make_shared<render::MeshGeometry>(make_square(1));
    list.meshes[0].geometry = geometry;
    const Image before = draw(*renderer, list);
    CHECK(draw(*renderer, list) == before);
    for (auto& vertex : geometry->vertices) vertex.position.x += 1.5F;
    ++geometry->vertex_revision;
    const Image after = draw(*renderer, list);
    CHECK(pixel_of(before, list.camera, {-0.5F, 0, 0}).g < 100);
    CHECK(pixel_of(after, list.camera, {-0.5F, 0, 0}).g > 150);
    CHECK(pixel_of(after, list.camera, {1.8F, 0, 0}).g < 100);
  }

  TEST_CASE("indices beyond the vertices are an error that names the mesh") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list = square_before_sky({1, 0, 0});
    render::MeshGeometry bad = make_square(1);
    bad.indices[4] = 4;
    list.meshes.push_back(make_mesh(bad, {}));
    const auto beyond = renderer->draw(list);
    REQUIRE_FALSE(beyond);
    CHECK(beyond.error().code == ErrorCode::kOutOfRange);
    CHECK(beyond.error().where == "meshes[1].indices");

    list.meshes[1] = list.meshes[0];
    list.meshes[1].first_index = 3;
    list.meshes[1].index_count = 6;
    const auto range = renderer->draw(list);
    REQUIRE_FALSE(range);
    CHECK(range.error().where == "meshes[1]");

    // Fewer vertices than before, same indices.
    const auto shrinking = std::make_shared<render::MeshGeometry>(make_square(1));
    list.meshes[1] = list.meshes[0];
    list.meshes[1].geometry = shrinking;
    CHECK(renderer->draw(list));
    shrinking->vertices.pop_back();
    ++shrinking->vertex_revision;
    CHECK_FALSE(renderer->draw(list));
  }

  TEST_CASE("a line has its width in pixels, also when it starts behind the eye") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list;
    list.ground.reset();
    list.camera = {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45};
    list.lines = {{{0, -1, 0}, {0, 1, 0}, {1, 0, 0}, 1, 6}};
    const Image image = draw(*renderer, list);
    int red = 0;
    for (int x = 0; x < image.width; ++x) {
      if (pixel_at(image, x, 120).g < 60) ++red;
    }
    CHECK(red == 6);
    // Behind the eye, and beside it, where a point has no place on the screen.
    for (const float z : {8.0F, 4.0F}) {
      list.lines = {{{0.2F, -1, z}, {0, 0, 0}, {1, 0, 0}, 1, 6}};
      CHECK(pixel_of(draw(*renderer, list), list.camera, {0.02F, -0.1F, 0.1F * z}).g < 60);
    }
  }

  TEST_CASE("a line on top is seen through what stands before it") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list;
    list.ground.reset();
    list.camera = {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45};
    list.spheres = {{{0, 0, 0}, 0.5F, {0.2F, 0.9F, 0.2F}}};
    for (const bool on_top : {false, true}) {
      list.lines = {{{0, -1, -1}, {0, 1, -1}, {1, 0, 0}, 1, 6, on_top}};
      const auto pixel = pixel_of(draw(*renderer, list), list.camera, {0, 0, 0});
      CHECK((pixel.r > 2 * pixel.g) == on_top);
    }
  }

  TEST_CASE("text stands where it should") {
    auto renderer = make_renderer();
    if (!renderer) return;
    DrawList list;
    list.ground.reset();
    const Image empty = draw(*renderer, list);
    list.texts = {{100, 50, 24, {0, 0, 0}, "H\x01\xff"}};
    const Image image = draw(*renderer, list);
    int left = image.width;
    int right = 0;
    int top = image.height;
    int bottom = 0;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (brightness(pixel_at(empty, x, y)) - brightness(pixel_at(image, x, y)) < 200) continue;
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
    CHECK(left >= 100);
    CHECK(right < 120);
    CHECK(right > left + 5);
    CHECK(top >= 50);
    CHECK(bottom < 74);
    CHECK(bottom > top + 10);
  }

  TEST_CASE("degenerate lists draw what is left of them") {
    auto renderer = make_renderer();
    if (!renderer) return;
    const float nan = std::nanf("");
    DrawList list;
    list.camera = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0};
    list.sun.direction = {};
    list.meshes.emplace_back();
    list.ropes = {{{}, 0.1F}, {{{0, 0, 0}, {0, 0, 0}}, 0.1F}, {{{nan, 0, 0}, {0, 0, 0}, {1, 0, 0}}, nan}};
    list.spheres = {{{nan, 0, 0}, 1, {}}, {{0, 0, 0}, -1, {}}};
    list.lines = {{{0, 0, 0}, {0, 0, 0}}};
    list.texts = {{0, 0, 16, {}, ""}};
    CHECK(renderer->draw(list));
    CHECK(renderer->draw(DrawList{}));
  }

  TEST_CASE("the picture can change its size, within limits") {
    auto renderer = make_renderer();
    if (!renderer) return;
    CHECK(renderer->resize(101, 57));
    const Image image = draw(*renderer, DrawList{});
    CHECK(image.width == 101);
    CHECK(image.height == 57);
    CHECK(render::is_consistent(image));
    CHECK_FALSE(renderer->resize(0, 57));
    CHECK_FALSE(renderer->resize(101, 9000));
    CHECK(renderer->width() == 101);
    const auto context = render::Context::create_headless();
    REQUIRE(context);
    CHECK_FALSE(render::Renderer::create(context.value(), {100, 100, 4, 100}));
  }
}
