#include "render/frame.h"

#include "render/batches.h"

#include <algorithm>

namespace hooke::render {

namespace {

// A white surface facing the sun is a little below the brightest value, one in the shadow at about a quarter
// of that.
constexpr float kSunStrength = 1.8F;
constexpr float kAmbientStrength = 1.0F;
// The fog hides the ground's end but nothing of the scene: it is 0.7 % at the farthest object.
constexpr float kFogReach = 12;

std::array<float, 4> vec4_of(Vec3 v, float w) {
  return {v.x, v.y, v.z, w};
}

std::array<float, 4> scaled(const std::array<float, 3>& color, float factor) {
  return {factor * color[0], factor * color[1], factor * color[2], 1};
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
  Vec3 sun = normalize(list.sun.direction);
  if (sun == Vec3{}) sun = {0, 1, 0};
  frame.sun_direction = vec4_of(sun, 0);
  frame.sun_color = scaled(linear_of(list.sun.color), kSunStrength * std::max(list.sun.intensity, 0.0F));
  const auto zenith = linear_of(list.sky.zenith);
  const auto horizon = linear_of(list.sky.horizon);
  frame.zenith = scaled(zenith, 1);
  frame.horizon = scaled(horizon, 1);
  const float ambient = kAmbientStrength * std::max(list.sky.ambient, 0.0F);
  const auto below = list.ground ? linear_of(list.ground->color) : horizon;
  for (std::size_t i = 0; i < 3; ++i) {
    frame.sky_light[i] = ambient * 0.5F * (zenith[i] + horizon[i]);
    // The ground reflects a part of the light that falls on it.
    frame.ground_light[i] =
        below[i] * 0.6F * (frame.sky_light[i] + 0.15F * frame.sun_color[i] * std::max(sun.y, 0.0F));
  }
  frame.shadow_info = {shadow.texel_size, static_cast<float>(map_size), map_size > 0 ? 1.0F : 0.0F,
                       kFogReach * view.reach};
  return frame;
}

}  // namespace hooke::render
