#include "render/stage.h"

#include <doctest/doctest.h>
#include <unistd.h>

namespace hooke::render_test {

std::optional<render::Renderer> make_renderer(const render::RendererOptions& options) {
  const auto context = render::Context::create_headless();
  if (!context) {
    MESSAGE("skipped: " << context.error().message);
    return std::nullopt;
  }
  auto renderer = render::Renderer::create(context.value(), options);
  if (!renderer) {
    FAIL_CHECK(renderer.error().where << ": " << renderer.error().message);
    return std::nullopt;
  }
  return std::move(renderer).value();
}

render::Image draw(render::Renderer& renderer, const render::DrawList& list) {
  const auto drawn = renderer.draw(list);
  if (!drawn) FAIL_CHECK(drawn.error().where << ": " << drawn.error().message);
  auto image = renderer.read_image();
  if (!image) FAIL_CHECK(image.error().where << ": " << image.error().message);
  return image ? std::move(image).value() : render::Image{};
}

Rgb pixel_at(const render::Image& image, int x, int y) {
  REQUIRE((x >= 0 && y >= 0 && x < image.width && y < image.height));
  const auto at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

Rgb pixel_of(const render::Image& image, const render::Camera& camera, Vec3 point) {
  const float aspect = static_cast<float>(image.width) / static_cast<float>(image.height);
  const render::View view = render::make_view(camera, aspect, {}, nullptr);
  const Vec3 away = point - view.eye;
  const float depth = dot(away, view.forward);
  const float x = dot(away, view.right) / (length_squared(view.right) * depth);
  const float y = dot(away, view.up) / (length_squared(view.up) * depth);
  return pixel_at(image, static_cast<int>((0.5F + 0.5F * x) * static_cast<float>(image.width)),
                  static_cast<int>((0.5F - 0.5F * y) * static_cast<float>(image.height)));
}

int brightness(Rgb color) {
  return color.r + color.g + color.b;
}

render::DrawMesh make_mesh(render::MeshGeometry geometry, render::Color color) {
  render::DrawMesh mesh;
  mesh.geometry = std::make_shared<const render::MeshGeometry>(std::move(geometry));
  mesh.color = color;
  mesh.surface.roughness = 1;
  return mesh;
}

render::MeshGeometry make_square(float half) {
  const Vec3 front = {0, 0, 1};
  return {{{{-half, -half, 0}, front, 0, 0},
           {{half, -half, 0}, front, 1, 0},
           {{half, half, 0}, front, 1, 1},
           {{-half, half, 0}, front, 0, 1}},
          {0, 1, 2, 0, 2, 3}};
}

TemporaryFolder::TemporaryFolder() {
  static int count = 0;
  path_ = std::filesystem::temp_directory_path() /
          ("hooke_render_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
  std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code code;
  std::filesystem::remove_all(path_, code);
}

}  // namespace hooke::render_test
