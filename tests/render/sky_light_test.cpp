#include "render/sky_light.h"

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using hooke::Vec3;
namespace render = hooke::render;

namespace {

/// The brightness of a white matte surface: the cosine-weighted mean of what comes from all sides, summed
/// directly.
float brightness_by_sum(const render::SkyLight& sky, Vec3 normal) {
  constexpr int kRings = 90;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double y = -1 + (2 * i + 1.0) / kRings;
    for (int j = 0; j < 2 * kRings; ++j) {
      const double angle = std::numbers::pi * (j + 0.5) / kRings;
      const double flat = std::sqrt(1 - y * y);
      const Vec3 way = {static_cast<float>(flat * std::cos(angle)), static_cast<float>(y),
                        static_cast<float>(flat * std::sin(angle))};
      const float facing = dot(way, normal);
      if (facing > 0) sum += facing * radiance(sky, way)[1];
    }
  }
  // Each direction has 4 pi / (2 n^2) of the sphere; a matte surface throws back 1 / pi of the sum.
  return static_cast<float>(sum * 4 / (2.0 * kRings * kRings)) * sky.ambient;
}

float brightness_by_harmonics(const render::SkyLight& sky, Vec3 n) {
  const auto sums = irradiance_of(sky);
  const float basis[9] = {
      1, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3 * n.z * n.z - 1, n.x * n.z, n.x * n.x - n.y * n.y};
  float result = 0;
  for (std::size_t k = 0; k < 9; ++k) result += basis[k] * sums[k][1];
  return result;
}

}  // namespace

TEST_SUITE("render/sky_light") {
  TEST_CASE("nine harmonics give the light of the sky on a surface to four hundredths") {
    render::DrawList list;
    list.sky.zenith = {0.5F, 0.5F, 0.5F};
    list.sky.horizon = {0.8F, 0.8F, 0.8F};
    list.sun.color = {1, 1, 1};
    list.ground->color = {0.3F, 0.3F, 0.3F};
    const render::SkyLight sky = sky_light_of(list);
    const float up = brightness_by_sum(sky, {0, 1, 0});
    for (const Vec3 n : {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -1}, Vec3{0.6F, 0.8F, 0}}) {
      CHECK(std::abs(brightness_by_harmonics(sky, n) - brightness_by_sum(sky, n)) < 0.04F * up);
    }
  }

  TEST_CASE("a sky of one brightness gives that brightness to a surface, times the ambient light") {
    render::DrawList list;
    list.sun.intensity = 0;
    list.sky.zenith = list.sky.horizon = {1, 1, 1};
    const render::SkyLight sky = sky_light_of(list);
    render::SkyLight even = sky;
    even.below = {1, 1, 1};
    CHECK(brightness_by_harmonics(even, {0, 1, 0}) == doctest::Approx(even.ambient).epsilon(0.01));
    CHECK(brightness_by_harmonics(even, {0, 0, 1}) == doctest::Approx(even.ambient).epsilon(0.01));
  }
}
