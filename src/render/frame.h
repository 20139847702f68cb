#pragma once

#include "hooke/result.h"

#include "render/view.h"

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// The uniform blocks of the shaders: what is the same in a whole picture, and the lights besides the sun.

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

inline constexpr std::size_t kMostLights = 8;
inline constexpr std::size_t kMostLightMaps = 12;  ///< A point light has six, any other one.
inline constexpr int kLightColumns = 4;

/// This is the uniform block Lights of the shaders, in the std140 layout.
struct LightUniforms {
  using Vec4 = std::array<float, 4>;

  Vec4 count = {};                           ///< Number of lights, size of a tile [texels], rows of tiles.
  std::array<Vec4, kMostLights> place = {};  ///< Place and 1, or direction to a light from far away and 0.
  std::array<Vec4, kMostLights> beam = {};  ///< Direction in which it shines, cosine beyond which it is dark.
  std::array<Vec4, kMostLights> color = {};  ///< Linear color; one over the width of the rim, as a cosine.
  /// First map, or -1 for none; number of maps; size of a texel [m], of those with a place at a distance of 1
  /// m.
  std::array<Vec4, kMostLights> map = {};
  std::array<Mat4, kMostLightMaps> matrices = {};  ///< To the map's own space, 0 to 1 in all three.
};

/// What is needed to draw the lights of one list.
struct LightPlan {
  LightUniforms uniforms;
  std::vector<Mat4> clips;  ///< For each map, the matrix to clip space.
};

/// Makes the plan; `tile` is the size of a map in texels, 0 for no shadows. Errors: kLimitExceeded for more
/// than kMostLights lights, or more than kMostLightMaps maps.
Result<LightPlan> plan_lights(const DrawList& list, const View& view, const Bounds& casters, int tile);

}  // namespace hooke::render
