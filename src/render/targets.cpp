#include "render/targets.h"

#include <algorithm>

namespace hooke::render {

namespace {

constexpr int kMaxSide = 8192;

Result<void> check_framebuffer(const std::string& where) {
  auto error = take_gl_error(where);
  if (!error) return error;
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return {};
  return Error{ErrorCode::kUnsupported, where, "the driver cannot draw into this kind of picture"};
}

GlName make_sampled_storage(GLenum format, int samples, int width, int height) {
  GlName storage = make_renderbuffer();
  glBindRenderbuffer(GL_RENDERBUFFER, storage.name());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return storage;
}

/// Binds a new texture of that size, whose filter and rim are set.
GlName make_plain_texture(GLint format, int width, int height, GLenum layout, GLenum type, GLint filter) {
  GlName texture = make_texture();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

Result<PictureTarget> make_picture_target(int width, int height, int samples) {
  const std::string where = "picture " + std::to_string(width) + " x " + std::to_string(height);
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    return Error{ErrorCode::kOutOfRange, where,
                 "each side must be 1 to " + std::to_string(kMaxSide) + " pixels"};
  }
  GLint most_samples = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
  const int given = std::clamp(samples, 1, std::max(most_samples, 1));
  PictureTarget target;
  target.width = width;
  target.height = height;
  target.is_sampled = given > 1;
  target.texture = make_plain_texture(GL_RGBA8, width, height, GL_RGBA, GL_UNSIGNED_BYTE, GL_LINEAR);
  target.framebuffer = make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture.name(), 0);
  target.depth = make_sampled_storage(GL_DEPTH_COMPONENT24, target.is_sampled ? given : 0, width, height);
  if (target.is_sampled) {
    target.sampled_framebuffer = make_framebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, target.sampled_framebuffer.name());
    target.sampled_color = make_sampled_storage(GL_RGBA8, given, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              target.sampled_color.name());
  }
  // Depth belongs to what is drawn into, which is bound now.
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth.name());
  const auto complete = check_framebuffer(where);
  if (!complete) return complete.error();
  return target;
}

const GlName& drawn_framebuffer(const PictureTarget& target) {
  return target.is_sampled ? target.sampled_framebuffer : target.framebuffer;
}

void resolve(const PictureTarget& target) {
  if (!target.is_sampled) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.sampled_framebuffer.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer.name());
  glBlitFramebuffer(0, 0, target.width, target.height, 0, 0, target.width, target.height, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

Image read_pixels(const PictureTarget& target) {
  Image image;
  image.width = target.width;
  image.height = target.height;
  const auto row = static_cast<std::size_t>(target.width) * 3;
  const auto rows = static_cast<std::size_t>(target.height);
  image.pixels.resize(row * rows);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, target.width, target.height, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
  // OpenGL counts rows from the bottom.
  const auto at = [&](std::size_t y) { return image.pixels.begin() + static_cast<std::ptrdiff_t>(y * row); };
  for (std::size_t y = 0; y < rows / 2; ++y) std::swap_ranges(at(y), at(y + 1), at(rows - 1 - y));
  return image;
}

Result<ShadowTarget> make_shadow_target(int size) {
  const std::string where = "shadow map of " + std::to_string(size) + " pixels";
  if (size < 256 || size > kMaxSide) {
    return Error{ErrorCode::kOutOfRange, where, "the side must be 256 to " + std::to_string(kMaxSide)};
  }
  return make_shadow_tiles(size, 1, 1);
}

Result<ShadowTarget> make_shadow_tiles(int size, int columns, int rows) {
  const std::string where = "shadow map of " + std::to_string(size) + " pixels";
  ShadowTarget target;
  target.size = size;
  target.texture = make_plain_texture(GL_DEPTH_COMPONENT24, columns * size, rows * size, GL_DEPTH_COMPONENT,
                                      GL_UNSIGNED_INT, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  target.framebuffer = make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target.texture.name(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  const auto complete = check_framebuffer(where);
  if (!complete) return complete.error();
  return target;
}

Result<OcclusionTarget> make_occlusion_target(int width, int height, int part) {
  OcclusionTarget target;
  target.width = std::max((width + part - 1) / part, 1);
  target.height = std::max((height + part - 1) / part, 1);
  target.depth = make_plain_texture(GL_DEPTH_COMPONENT24, target.width, target.height, GL_DEPTH_COMPONENT,
                                    GL_UNSIGNED_INT, GL_NEAREST);
  target.depth_framebuffer = make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, target.depth_framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target.depth.name(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  const auto depth = check_framebuffer("occlusion depth");
  if (!depth) return depth.error();
  for (std::size_t i = 0; i < 2; ++i) {
    target.textures[i] =
        make_plain_texture(GL_RG8, target.width, target.height, GL_RG, GL_UNSIGNED_BYTE, GL_LINEAR);
    target.framebuffers[i] = make_framebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffers[i].name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.textures[i].name(), 0);
    const auto seen = check_framebuffer("occlusion");
    if (!seen) return seen.error();
  }
  return target;
}

}  // namespace hooke::render
