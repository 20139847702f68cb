#pragma once

#include "render/draw_list.h"

#include <array>

/// \file
/// The light of the sky. The shaders have the same formula (`sky_radiance` in gl/shader_parts.cpp).

namespace hooke::render {

/// A white surface that faces the sun is just below the point from which brightness is compressed; one in its
/// shadow has about a quarter of that.
inline constexpr float kSunStrength = 1.5F;

using LinearColor = std::array<float, 3>;  ///< Linear red, green and blue, not bounded.

/// The light that comes from all sides, in the units of the shaders: a white matte surface has the brightness
/// that it is given.
struct SkyLight {
  LinearColor zenith = {};
  LinearColor horizon = {};
  LinearColor sun = {};     ///< What a white surface across the sun's light throws back of it.
  Vec3 sun_direction = {};  ///< Unit length.
  LinearColor below = {};   ///< What the ground throws back, as far as it is seen.
  float ambient = 1;        ///< Factor of the light on surfaces; the background does not change with it.
};

/// Makes the light of a list. `ground` is the color of the ground, or of what is below without one.
SkyLight sky_light_of(const DrawList& list);

/// Returns what comes from a direction of unit length; below the horizon that is the ground's.
LinearColor radiance(const SkyLight& sky, Vec3 direction);

/// Returns the nine sums of spherical harmonics from which the shaders make the light on a surface by its
/// normal: Ramamoorthi and Hanrahan, "An efficient representation for irradiance environment maps", 2001. The
/// brightness of a white matte surface is their sum with the polynomials 1, y, z, x, xy, yz, 3zz-1, xz and
/// xx-yy of its normal.
std::array<LinearColor, 9> irradiance_of(const SkyLight& sky);

}  // namespace hooke::render
