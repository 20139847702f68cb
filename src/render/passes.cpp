#include "render/renderer_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace hooke::render {

namespace {

constexpr int kNoiseSize = 256;    ///< [px]
constexpr int kOcclusionTaps = 8;  ///< Depths that are compared for each pixel.

/// Draws depths of all batches that `is_drawn` lets pass.
template <class IsDrawn>
void draw_depths(const RendererData& data, const Prepared& prepared, const GlName& solid,
                 const HoledProgram& holed, const IsDrawn& is_drawn) {
  for (std::size_t i = 0; i < prepared.meshes.size(); ++i) {
    const Batch& batch = prepared.batches.batches[i];
    if (!is_drawn(batch)) continue;
    const bool has_holes = batch.alpha != AlphaMode::kOpaque && prepared.textures[i] != 0;
    if (has_holes || batch.density < 1) {
      glUseProgram(holed.program.name());
      // The coarser filter of fast pictures blurs no pattern but that of a half.
      glUniform1f(holed.density, data.options.fast ? 0.5F * std::round(2 * batch.density) : batch.density);
      glUniform1i(holed.has_texture, has_holes ? 1 : 0);
      bind_texture(kSurfaceUnit, prepared.textures[i]);
    } else {
      glUseProgram(solid.name());
    }
    draw_batch(data, batch, *prepared.meshes[i]);
  }
}

void draw_triangle(const RendererData& data) {
  glBindVertexArray(data.empty_array.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Returns a number from 0 to 1 for a crossing of a grid that repeats.
float lattice(int x, int y, int period) {
  const auto wrap = [period](int i) { return static_cast<std::uint32_t>(((i % period) + period) % period); };
  std::uint32_t n = wrap(x) * 0x9E3779B9U + wrap(y) * 0x85EBCA6BU + static_cast<std::uint32_t>(period) * 77U;
  n = (n ^ (n >> 15)) * 0x2C1B3C6DU;
  n = (n ^ (n >> 12)) * 0x297A2D39U;
  return static_cast<float>((n ^ (n >> 15)) & 0xFFFFU) / 65535;
}

float smooth_noise(float x, float y, int period) {
  const float fx = std::floor(x);
  const float fy = std::floor(y);
  const auto ease = [](float t) { return t * t * (3 - 2 * t); };
  const float u = ease(x - fx);
  const float v = ease(y - fy);
  const int i = static_cast<int>(fx);
  const int j = static_cast<int>(fy);
  const float low = (1 - u) * lattice(i, j, period) + u * lattice(i + 1, j, period);
  const float high = (1 - u) * lattice(i, j + 1, period) + u * lattice(i + 1, j + 1, period);
  return (1 - v) * low + v * high;
}

}  // namespace

void bind_texture(TextureUnit unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture);
}

std::array<float, 4> ground_plane(const Ground& ground, Vec3 eye, float haze_distance) {
  const float above = eye.y - ground.height;
  // The rim is far enough to be less than a pixel below the horizon.
  return {eye.x, ground.height, eye.z, std::max(above, 6 * haze_distance / kGroundRadius)};
}

namespace {

/// Draws depths into the map that is bound. `is_far` is for a light without a place.
void draw_casters(const RendererData& data, const Prepared& prepared, bool is_far) {
  // Open surfaces cast shadows from both sides. What is nearer to the sun than the map reaches casts them,
  // too.
  glDisable(GL_CULL_FACE);
  if (is_far) glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.0F, 1);
  draw_depths(data, prepared, data.programs.shadow, data.programs.holed_shadow,
              [](const Batch& batch) { return batch.casts_shadow; });
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_CLAMP);
}

}  // namespace

void draw_shadow_map(const RendererData& data, const Prepared& prepared) {
  glBindFramebuffer(GL_FRAMEBUFFER, data.shadow_map->framebuffer.name());
  glViewport(0, 0, data.shadow_map->size, data.shadow_map->size);
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
  draw_casters(data, prepared, true);
}

void draw_light_maps(const RendererData& data, const Prepared& prepared, const LightPlan& plan,
                     FrameUniforms frame) {
  glBindFramebuffer(GL_FRAMEBUFFER, data.light_maps->framebuffer.name());
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
  const int size = data.light_maps->size;
  for (std::size_t i = 0; i < plan.clips.size(); ++i) {
    // The shaders of depths read the matrix of the sun's map from the frame.
    frame.shadow_clip = plan.clips[i];
    glBindBuffer(GL_UNIFORM_BUFFER, data.frame_buffer.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(frame), &frame, GL_STREAM_DRAW);
    const int tile = static_cast<int>(i);
    glViewport(tile % kLightColumns * size, tile / kLightColumns * size, size, size);
    draw_casters(data, prepared, plan.clips[i].m[2][3] == 0);
  }
}

void draw_opaque_depths(const RendererData& data, const Prepared& prepared) {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  for (const bool two_sided : {false, true}) {
    const auto set_culling = two_sided ? glDisable : glEnable;
    set_culling(GL_CULL_FACE);
    draw_depths(data, prepared, data.programs.depth, data.programs.holed_depth, [&](const Batch& batch) {
      return batch.alpha == AlphaMode::kOpaque && batch.shading == Shading::kSolid && !batch.is_in_order &&
             batch.two_sided == two_sided;
    });
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void draw_occlusion(const RendererData& data, const Prepared& prepared, const std::array<float, 4>* plane,
                    float pixels_per_length) {
  const OcclusionTarget& target = *data.occlusion;
  const Programs& p = data.programs;
  glBindFramebuffer(GL_FRAMEBUFFER, target.depth_framebuffer.name());
  glViewport(0, 0, target.width, target.height);
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_CULL_FACE);
  draw_depths(data, prepared, p.depth, p.holed_depth, [](const Batch& batch) {
    return batch.alpha != AlphaMode::kBlend && batch.shading != Shading::kHair;
  });
  if (plane != nullptr) {
    glUseProgram(p.ground_depth.name());
    glUniform4fv(p.ground_depth_plane, 1, plane->data());
    glBindVertexArray(data.ground.vertex_array.name());
    glDrawArrays(GL_TRIANGLES, 0, data.ground.vertex_count);
  }
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  const float x = 1 / static_cast<float>(target.width);
  const float y = 1 / static_cast<float>(target.height);
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffers[0].name());
  glUseProgram(p.occlusion.name());
  glUniform4f(p.occlusion_half_pixel, x, y, kOcclusionTaps, pixels_per_length);
  bind_texture(kSurfaceUnit, target.depth.name());
  draw_triangle(data);
  glUseProgram(p.occlusion_blur.name());
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffers[1].name());
  glUniform2f(p.occlusion_blur_step, x, y);
  bind_texture(kSurfaceUnit, target.textures[0].name());
  draw_triangle(data);
  glEnable(GL_DEPTH_TEST);
}

GlName make_noise_texture() {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(kNoiseSize * kNoiseSize);
  for (int y = 0; y < kNoiseSize; ++y) {
    for (int x = 0; x < kNoiseSize; ++x) {
      float sum = 0;
      float weight = 0.5F;
      for (int period = 4; period <= 128; period *= 2, weight *= 0.55F) {
        const float scale = static_cast<float>(period) / kNoiseSize;
        sum += weight * smooth_noise(scale * static_cast<float>(x), scale * static_cast<float>(y), period);
      }
      pixels.push_back(static_cast<std::uint8_t>(std::clamp(255 * (1.9F * sum - 0.5F), 0.0F, 255.0F)));
    }
  }
  GlName texture = make_texture();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kNoiseSize, kNoiseSize, 0, GL_RED, GL_UNSIGNED_BYTE, pixels.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

}  // namespace hooke::render
