#pragma once

#include "io/motion/motion_usda_text.h"

#include <string>

/// \file
/// What a .usda file says of materials, by UsdPreviewSurface, and of lights, by UsdLux.

namespace hooke::io {

/// Writes the shaders of a material whose prim is at `path`.
void put_shaders(UsdaText& text, const MotionMaterial& material, const std::string& path,
                 const MaterialImages& images);

/// Writes the lights and the sky into the scope "Lights", if there are any.
void put_lights(UsdaText& text, const MotionData& data);

}  // namespace hooke::io
