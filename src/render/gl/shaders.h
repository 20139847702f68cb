#pragma once

#include <string>

/// \file
/// The GLSL sources share the uniform block Frame, whose layout is that of FrameUniforms in render/frame.h.

namespace hooke::render {

struct ShaderSource {
  std::string vertex;
  std::string fragment;
};

ShaderSource mesh_shader();           ///< Lit triangles, instanced.
ShaderSource shadow_shader();         ///< Depth only, instanced.
ShaderSource cutout_shadow_shader();  ///< Depth where the texture has no hole.
ShaderSource ground_shader();         ///< The plane with its grid.
ShaderSource sky_shader();            ///< The gradient behind everything.
ShaderSource line_shader();           ///< Lines of a width in pixels, instanced.
ShaderSource text_shader();           ///< Triangles in pixels.
ShaderSource present_shader();        ///< Shows the finished picture in a window.

}  // namespace hooke::render
