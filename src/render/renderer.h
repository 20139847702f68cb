#pragma once

#include "hooke/result.h"

#include "render/context.h"
#include "render/draw_list.h"
#include "render/image.h"

#include <memory>

namespace hooke::render {

struct RendererOptions {
  int width = 1280;  ///< [px], 1 to 8192.
  int height = 720;
  int samples = 4;             ///< Samples per pixel, for smooth edges; 1 is none. The driver may give fewer.
  int shadow_map_size = 2048;  ///< Size [px], 256 to 8192; 0 draws no shadows.
  /// Whether soft shadows and fine grain are left out, and occlusion is coarser, for drivers without a
  /// graphics card.
  bool fast = false;
  bool occlusion = true;  ///< Whether things near each other keep the light of the sky from one another.
};

struct RendererData;

/// A Renderer draws lists into a picture of its own, which is then read, or shown in the context's window.
/// Only the thread of its context may use it.
class Renderer {
 public:
  /// Compiles the shaders and makes the picture. It returns an Error if the driver lacks something or a size
  /// is too large.
  static Result<Renderer> create(const Context& context, const RendererOptions& options = {});

  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Changes the picture's size; what was drawn is lost. After an Error the old picture stays.
  Result<void> resize(int width, int height);

  /// Draws one picture. If indices leave the vertices of a mesh, the Error kOutOfRange names it, and nothing
  /// is drawn.
  Result<void> draw(const DrawList& list);

  /// Returns the picture drawn last, as RGB.
  [[nodiscard]] Result<Image> read_image() const;

  /// Fills the window with the picture; the caller swaps the buffers. `width` and `height` are those of the
  /// window's framebuffer [px].
  Result<void> present(int width, int height) const;

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

 private:
  explicit Renderer(std::unique_ptr<RendererData> data);

  std::unique_ptr<RendererData> data_;
};

}  // namespace hooke::render
