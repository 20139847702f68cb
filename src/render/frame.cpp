#include "render/frame.h"

#include "render/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke::render {

namespace {

constexpr float kHazeReach = 8;      ///< Distance of the haze, in distances of the farthest object.
constexpr float kShadowTaps = 16;    ///< Samples of the shadow map where there is a half shadow.
constexpr float kWidestShadow = 24;  ///< Radius of the widest half shadow, in texels.

std::array<float, 4> vec4_of(Vec3 v, float w) {
  return {v.x, v.y, v.z, w};
}

std::array<float, 4> vec4_of(const LinearColor& color, float w) {
  return {color[0], color[1], color[2], w};
}

}  // namespace

FrameUniforms make_frame(const DrawList& list, const View& view, const ShadowView& shadow, int map_size) {
  FrameUniforms frame;
  frame.view_projection = view.view_projection;
  frame.shadow_matrix = shadow.matrix;
  frame.shadow_clip = shadow.clip_matrix;
  frame.eye = vec4_of(view.eye, view.near_distance);
  frame.ray_right = vec4_of(view.right, 0);
  frame.ray_up = vec4_of(view.up, 0);
  frame.ray_forward = vec4_of(view.forward, 0);
  const SkyLight sky = sky_light_of(list);
  frame.sun_direction = vec4_of(sky.sun_direction, 0);
  frame.sun_color = vec4_of(sky.sun, 1);
  frame.zenith = vec4_of(sky.zenith, 1);
  frame.horizon = vec4_of(sky.horizon, std::clamp(list.sky.clouds, 0.0F, 1.0F));
  frame.below = vec4_of(sky.below, 1);
  const auto irradiance = irradiance_of(sky);
  for (std::size_t i = 0; i < irradiance.size(); ++i) frame.irradiance[i] = vec4_of(irradiance[i], 0);
  frame.shadow_info = {shadow.texel_size, static_cast<float>(map_size), map_size > 0 ? 1.0F : 0.0F,
                       kHazeReach * view.reach};
  const float half_angle = std::clamp(list.sun.half_angle_deg, 0.0F, 20.0F) * std::numbers::pi_v<float> / 180;
  frame.shadow_light = {shadow.depth, std::tan(half_angle), kShadowTaps, kWidestShadow * shadow.texel_size};
  return frame;
}

}  // namespace hooke::render
