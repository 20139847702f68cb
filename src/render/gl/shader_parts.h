#pragma once

#include "render/gl/shaders.h"

#include <string>

/// \file
/// Parts of which the shaders are put together, as GLSL.

namespace hooke::render {

/// The first line of each shader. Fast ones leave out what a software driver has no time for.
std::string shader_version(bool fast = false);
/// The same for shaders of lit surfaces, with the number LIGHTS of lights besides the sun.
std::string lit_version(LitKind kind);
std::string frame_part();        ///< The uniform block Frame.
std::string color_part();        ///< Exposure and the haze of what is far away.
std::string sky_part();          ///< The brightness of the sky in a direction, sharp or blurred.
std::string corner_part();       ///< Light at the corners of triangles, for quick pictures.
std::string shadow_part();       ///< How much of the sun reaches a point.
std::string reflection_part();   ///< How a surface throws back the sun and the sky.
std::string mesh_inputs_part();  ///< Attributes of vertices and copies.

}  // namespace hooke::render
