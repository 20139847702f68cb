#include "render/batches.h"
#include "render/frame.h"
#include "render/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace hooke::render {

namespace {

constexpr float kRim = 4;             ///< Texels around a map that its filter may reach.
constexpr float kDepthRange = 2000;   ///< Farthest over nearest distance of a map.
constexpr float kWidestHalfDeg = 80;  ///< Of a spot.

float cosine_of(float degrees) {
  return std::cos(degrees * std::numbers::pi_v<float> / 180);
}

/// How many maps the light needs.
std::size_t maps_of(const Light& light) {
  if (!light.casts_shadow) return 0;
  return light.kind == Light::Kind::kPoint ? 6 : 1;
}

/// Directions of the six maps of a point light, in the order in which the shaders choose among them.
constexpr std::array<Vec3, 6> kMapDirections = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

Mat4 texture_matrix(const Mat4& clip) {
  return affine(Mat3{{0.5F, 0, 0}, {0, 0.5F, 0}, {0, 0, 0.5F}}, Vec3{0.5F, 0.5F, 0.5F}) * clip;
}

/// Adds the view from a place along a direction; `slope` is the tangent of half the opening angle.
void add_view(const Light& light, Vec3 forward, float slope, float reach, LightPlan& plan) {
  const Camera camera = {light.position, light.position + forward,
                         std::abs(forward.y) < 0.9F ? Vec3{0, 1, 0} : Vec3{0, 0, 1}, 45};
  const Vec3 right = normalize(cross(forward, camera.up));
  const Vec3 up = cross(right, forward);
  const Mat3 rotation = transpose(Mat3{right, up, -forward});
  const float far = reach;
  const float near = reach / kDepthRange;
  const Mat4 projection = {{{1 / slope, 0, 0, 0},
                            {0, 1 / slope, 0, 0},
                            {0, 0, (near + far) / (near - far), -1},
                            {0, 0, 2 * near * far / (near - far), 0}}};
  plan.uniforms.matrices[plan.clips.size()] =
      texture_matrix(projection * affine(rotation, -(rotation * light.position)));
  plan.clips.push_back(projection * affine(rotation, -(rotation * light.position)));
}

/// Distance of the farthest thing that may cast a shadow.
float reach_of(const Light& light, const Bounds& casters) {
  if (is_empty(casters)) return 1;
  const auto farther = [](float low, float high, float x) {
    return std::max(std::abs(low - x), std::abs(high - x));
  };
  return 1.05F * length(Vec3{farther(casters.low.x, casters.high.x, light.position.x),
                             farther(casters.low.y, casters.high.y, light.position.y),
                             farther(casters.low.z, casters.high.z, light.position.z)}) +
         1e-3F;
}

void add_maps(const Light& light, const View& view, const Bounds& casters, int tile, std::size_t index,
              LightPlan& plan) {
  LightUniforms& all = plan.uniforms;
  const auto size = static_cast<float>(tile);
  const float widened = size / (size - 2 * kRim);
  all.map[index] = {static_cast<float>(plan.clips.size()), static_cast<float>(maps_of(light)), 0, 0};
  if (light.kind == Light::Kind::kDirectional) {
    const ShadowView from = make_shadow_view(view, casters, -light.direction, tile);
    all.matrices[plan.clips.size()] = from.matrix;
    plan.clips.push_back(from.clip_matrix);
    all.map[index][2] = from.texel_size;
    return;
  }
  const float reach = reach_of(light, casters);
  if (light.kind == Light::Kind::kSpot) {
    const float angle = std::clamp(light.outer_deg, 0.1F, kWidestHalfDeg) * std::numbers::pi_v<float> / 180;
    const Vec3 forward = {all.beam[index][0], all.beam[index][1], all.beam[index][2]};
    all.map[index][2] = 2 * std::tan(angle) * widened / size;
    return add_view(light, forward, std::tan(angle) * widened, reach, plan);
  }
  all.map[index][2] = 2 * widened / size;
  for (const Vec3 side : kMapDirections) add_view(light, side, widened, reach, plan);
}

/// Fills what does not depend on shadows.
void add_light(const Light& light, std::size_t index, LightUniforms& all) {
  Vec3 along = normalize(light.direction);
  if (along == Vec3{}) along = {0, -1, 0};
  const bool is_far = light.kind == Light::Kind::kDirectional;
  const Vec3 place = is_far ? -along : light.position;
  all.place[index] = {place.x, place.y, place.z, is_far ? 0.0F : 1.0F};
  const auto color = linear_of(light.color);
  const float strength = kSunStrength * std::max(light.intensity, 0.0F);
  all.color[index] = {strength * color[0], strength * color[1], strength * color[2], 1};
  // Without a cone the cosine is 1 beyond the limit everywhere.
  all.beam[index] = {0, 0, 0, -1};
  all.map[index] = {-1, 0, 0, 0};
  if (light.kind != Light::Kind::kSpot) return;
  const float outer = std::clamp(light.outer_deg, 0.1F, kWidestHalfDeg);
  const float inner = std::clamp(light.inner_deg, 0.0F, outer);
  all.beam[index] = {along.x, along.y, along.z, cosine_of(outer)};
  all.color[index][3] = 1 / std::max(cosine_of(inner) - cosine_of(outer), 1e-4F);
}

}  // namespace

Result<LightPlan> plan_lights(const DrawList& list, const View& view, const Bounds& casters, int tile) {
  LightPlan plan;
  if (list.lights.size() > kMostLights) {
    return Error{ErrorCode::kLimitExceeded, "lights",
                 std::to_string(list.lights.size()) + " lights, and a picture has at most " +
                     std::to_string(kMostLights)};
  }
  std::size_t maps = 0;
  for (const Light& light : list.lights) maps += maps_of(light);
  if (maps > kMostLightMaps) {
    return Error{ErrorCode::kLimitExceeded, "lights",
                 "their shadows need " + std::to_string(maps) + " maps, and a picture has at most " +
                     std::to_string(kMostLightMaps) + ": six for a point light, one for any other"};
  }
  for (std::size_t i = 0; i < list.lights.size(); ++i) {
    const Light& light = list.lights[i];
    add_light(light, i, plan.uniforms);
    if (tile > 0 && maps_of(light) > 0) add_maps(light, view, casters, tile, i, plan);
  }
  const int rows = (static_cast<int>(plan.clips.size()) + kLightColumns - 1) / kLightColumns;
  plan.uniforms.count = {static_cast<float>(list.lights.size()), static_cast<float>(tile),
                         static_cast<float>(std::max(rows, 1)), 0};
  return plan;
}

}  // namespace hooke::render
