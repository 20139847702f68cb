#pragma once

#include "render/view.h"

#include <array>

namespace hooke::render {

/// This is the uniform block Frame of the shaders, in the std140 layout. Colors are linear.
struct FrameUniforms {
  using Vec4 = std::array<float, 4>;

  Mat4 view_projection;
  Mat4 shadow_matrix;
  Mat4 shadow_clip;
  Vec4 eye = {};  ///< w is the near distance [m].
  Vec4 ray_right = {};
  Vec4 ray_up = {};
  Vec4 ray_forward = {};
  Vec4 sun_direction = {};
  Vec4 sun_color = {};
  Vec4 zenith = {};
  Vec4 horizon = {};  ///< w is the cover of clouds.
  Vec4 below = {};
  std::array<Vec4, 9> irradiance = {};
  /// Texel [m], size of the map, 1 if there is a map, distance of the haze [m].
  Vec4 shadow_info = {};
  /// Depth of the map [m], tangent of the sun's half angle, taps, widest half shadow [m].
  Vec4 shadow_light = {};
  Vec4 viewport = {};  ///< Width, height [px], radius of occlusion [m], 1 if there is occlusion.
};

/// Fills the block but for the viewport; `map_size` 0 draws no shadows.
FrameUniforms make_frame(const DrawList& list, const View& view, const ShadowView& shadow, int map_size);

}  // namespace hooke::render
