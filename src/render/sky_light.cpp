#include "render/sky_light.h"

#include "render/batches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke::render {

namespace {

constexpr float kSkyStrength = 1.5F;
constexpr float kWhiteness = 0.55F;  ///< Share of the sky's color that clouds and walls around take away.
constexpr int kDirections = 256;     ///< Directions of the sum over the sphere.

LinearColor scaled_color(const LinearColor& color, float factor) {
  return {factor * color[0], factor * color[1], factor * color[2]};
}

}  // namespace

SkyLight sky_light_of(const DrawList& list) {
  SkyLight sky;
  const float brightness = std::max(list.sky.brightness, 0.0F);
  sky.zenith = scaled_color(linear_of(list.sky.zenith), brightness);
  sky.horizon = scaled_color(linear_of(list.sky.horizon), brightness);
  sky.sun = scaled_color(linear_of(list.sun.color), kSunStrength * std::max(list.sun.intensity, 0.0F));
  sky.sun_direction = normalize(list.sun.direction);
  if (sky.sun_direction == Vec3{}) sky.sun_direction = {0, 1, 0};
  sky.ambient = kSkyStrength * std::max(list.sky.ambient, 0.0F);
  const LinearColor ground = list.ground ? linear_of(list.ground->color) : sky.horizon;
  const float facing = std::max(sky.sun_direction.y, 0.0F);
  for (std::size_t i = 0; i < 3; ++i) {
    const float above = 0.5F * (sky.zenith[i] + sky.horizon[i]);
    // Things stand in the way of some of the light that reaches the ground near them.
    sky.below[i] = ground[i] * (0.5F * above + 0.6F * sky.sun[i] * facing);
  }
  return sky;
}

LinearColor radiance(const SkyLight& sky, Vec3 direction) {
  if (direction.y < 0) return sky.below;
  const float up = 1 - std::exp(-3.5F * direction.y);
  const float near_sun = std::pow(std::max(dot(direction, sky.sun_direction), 0.0F), 8.0F);
  const float glow = 0.10F * near_sun + 0.25F * std::pow(near_sun, 4.0F);
  LinearColor result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = sky.horizon[i] + up * (sky.zenith[i] - sky.horizon[i]) + glow * sky.sun[i];
  return result;
}

std::array<LinearColor, 9> irradiance_of(const SkyLight& sky) {
  std::array<LinearColor, 9> sums = {};
  // Factors of the basis, squared, times those of the cosine lobe over pi.
  constexpr std::array<float, 9> kFactors = {0.0795775F,
                                             0.2387324F * 2 / 3,
                                             0.2387324F * 2 / 3,
                                             0.2387324F * 2 / 3,
                                             1.0925484F * 1.0925484F / 4,
                                             1.0925484F * 1.0925484F / 4,
                                             0.3153916F * 0.3153916F / 4,
                                             1.0925484F * 1.0925484F / 4,
                                             0.5462742F * 0.5462742F / 4};
  const float weight = 4 * std::numbers::pi_v<float> / kDirections;
  for (int i = 0; i < kDirections; ++i) {
    // Directions on a spiral, each with the same part of the sphere.
    const float y = 1 - (2 * static_cast<float>(i) + 1) / kDirections;
    const float flat = std::sqrt(1 - y * y);
    const float angle = 2.39996323F * static_cast<float>(i);
    const Vec3 n = {flat * std::cos(angle), y, flat * std::sin(angle)};
    const LinearColor light = radiance(sky, n);
    const std::array<float, 9> basis = {
        1, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3 * n.z * n.z - 1, n.x * n.z, n.x * n.x - n.y * n.y};
    for (std::size_t k = 0; k < 9; ++k) {
      for (std::size_t c = 0; c < 3; ++c)
        sums[k][c] += sky.ambient * weight * kFactors[k] * basis[k] * light[c];
    }
  }
  for (LinearColor& sum : sums) {
    const float gray = 0.3F * sum[0] + 0.5F * sum[1] + 0.2F * sum[2];
    for (float& part : sum) part += kWhiteness * (gray - part);
  }
  return sums;
}

}  // namespace hooke::render
