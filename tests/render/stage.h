#pragma once

#include "render/renderer.h"
#include "render/view.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

/// \file
/// A small stage for tests of pictures: a headless renderer and ways to look at single pixels.

namespace hooke::render_test {

struct Rgb {
  int r = 0;
  int g = 0;
  int b = 0;
};

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// None, with a message, if the machine has no driver for drawing without a display.
std::optional<render::Renderer> make_renderer(const render::RendererOptions& options = {kWidth, kHeight});

/// Draws and reads; a failed check and an empty image if that goes wrong.
render::Image draw(render::Renderer& renderer, const render::DrawList& list);

Rgb pixel_at(const render::Image& image, int x, int y);
/// The pixel at which the camera sees a point.
Rgb pixel_of(const render::Image& image, const render::Camera& camera, Vec3 point);
int brightness(Rgb color);

/// A mesh of one color at rest.
render::DrawMesh make_mesh(render::MeshGeometry geometry, render::Color color);
/// An upright square in the plane z = 0 of half the side `half`, front toward +z, v upward.
render::MeshGeometry make_square(float half);

/// A folder of its own, removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] bool is_empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

}  // namespace hooke::render_test
