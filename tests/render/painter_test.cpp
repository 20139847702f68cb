#include "render/painter.h"

#include "render/shapes.h"
#include "render/stage.h"

#include <algorithm>
#include <cstdlib>
#include <doctest/doctest.h>

using hooke::Quat;
using hooke::Vec3;
using hooke::render::DrawList;
using hooke::render::DrawMesh;
using hooke::render::Image;
using hooke::render::paint_in_order;
using hooke::render_test::draw;
using hooke::render_test::make_mesh;
using hooke::render_test::make_renderer;
using hooke::render_test::make_square;
namespace render = hooke::render;

namespace {

/// Boxes in two rows, one through the next, a ball through the ground, a mirrored box, and a glass before
/// them.
DrawList crowd() {
  DrawList list;
  list.camera = {{1.5F, 2.5F, 4}, {0, 0.3F, 0}, {0, 1, 0}, 45};
  for (int i = 0; i < 7; ++i) {
    const auto x = static_cast<float>(i);
    DrawMesh box = make_mesh(render::make_box({0.35F, 0.2F + 0.05F * x, 0.3F}),
                             {0.2F + 0.1F * x, 0.5F, 0.9F - 0.1F * x});
    box.transform =
        make_transform(Vec3{0.45F * x - 1.5F, 0.3F, i % 2 == 0 ? 0.2F : -0.4F},
                       normalize(Quat{0.1F * x, 0.2F * x, 0.1F, 1}), Vec3{i == 3 ? -1.0F : 1.0F, 1, 1});
    list.meshes.push_back(box);
  }
  DrawMesh ball = make_mesh(render::make_sphere(3), {0.9F, 0.8F, 0.2F});
  ball.transform = make_transform(Vec3{0.2F, 0.1F, 0.9F}, Quat{}, Vec3{0.4F, 0.4F, 0.4F});
  list.meshes.push_back(ball);
  DrawMesh glass = make_mesh(make_square(0.5F), {0.2F, 0.8F, 0.3F});
  glass.transform = make_transform(Vec3{-0.6F, 0.5F, 1.2F}, Quat{}, Vec3{1, 1, 1});
  glass.opacity = 0.5F;
  list.meshes.push_back(glass);
  return list;
}

/// Share of the pixels that differ by more than 1 in 32 of the range.
double difference(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  std::size_t differ = 0;
  const auto channels = static_cast<std::size_t>(a.channels);
  for (std::size_t i = 0; i + channels <= a.pixels.size(); i += channels) {
    int most = 0;
    for (std::size_t c = 0; c < channels; ++c)
      most = std::max(most, std::abs(int{a.pixels[i + c]} - int{b.pixels[i + c]}));
    differ += most > 8 ? 1 : 0;
  }
  return static_cast<double>(differ * channels) / static_cast<double>(a.pixels.size());
}

}  // namespace

TEST_SUITE("render/painter") {
  TEST_CASE("a picture in painter's order is the picture by depth, but for pixels at edges") {
    auto renderer = make_renderer();
    if (!renderer) return;
    for (const Vec3 eye : {Vec3{1.5F, 2.5F, 4}, Vec3{-3, 1, 2}, Vec3{0.5F, 0.6F, -4}, Vec3{0, 5, 0.1F}}) {
      DrawList list = crowd();
      list.camera.eye = eye;
      const Image by_depth = draw(*renderer, list);
      REQUIRE(paint_in_order(list));
      CHECK(list.meshes.size() > 9);
      CHECK(difference(draw(*renderer, list), by_depth) < 0.004);

      // From near to far the same triangles make another picture: it is the order that hides.
      std::reverse(list.meshes.begin(), list.meshes.end());
      CHECK(difference(draw(*renderer, list), by_depth) > 0.02);
    }
  }

  TEST_CASE("what is holed or see-through stays as it is, and nothing opaque is an error") {
    DrawList list = crowd();
    const auto glass = list.meshes.back().geometry;
    REQUIRE(paint_in_order(list));
    CHECK(list.meshes.back().geometry == glass);
    CHECK_FALSE(list.meshes.back().is_in_order);
    list.meshes = {list.meshes.back()};
    const auto refused = paint_in_order(list);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message == "there are no opaque triangles to order");
  }
}
