#pragma once

#include "render/view.h"

#include <array>

namespace hooke::render {

/// This is the uniform block Frame of the shaders, in the std140 layout. Colors are linear.
struct FrameUniforms {
  Mat4 view_projection;
  Mat4 shadow_matrix;
  Mat4 shadow_clip;
  std::array<float, 4> eye = {};  ///< w is the near distance [m].
  std::array<float, 4> ray_right = {};
  std::array<float, 4> ray_up = {};
  std::array<float, 4> ray_forward = {};
  std::array<float, 4> sun_direction = {};
  std::array<float, 4> sun_color = {};
  std::array<float, 4> zenith = {};
  std::array<float, 4> horizon = {};
  std::array<float, 4> sky_light = {};
  std::array<float, 4> ground_light = {};
  /// Texel [m], size of the map, 1 if there is a map, fog distance [m].
  std::array<float, 4> shadow_info = {};
  std::array<float, 4> viewport = {};  ///< Width, height [px].
};

/// Fills the block; `map_size` 0 draws no shadows.
FrameUniforms make_frame(const DrawList& list, const View& view, const ShadowView& shadow, int map_size);

}  // namespace hooke::render
