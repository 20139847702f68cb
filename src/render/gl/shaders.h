#pragma once

#include <cstddef>
#include <string>

/// \file
/// The GLSL sources share the uniform block Frame, whose layout is that of FrameUniforms in render/frame.h.

namespace hooke::render {

struct ShaderSource {
  std::string vertex;
  std::string fragment;
};

/// Which of the shaders of lit triangles.
enum class MeshLook { kSolid, kClear, kCloth, kRope, kHair };
constexpr std::size_t kMeshLooks = 5;

/// Whence depths are seen.
enum class DepthFrom { kSun, kEye };

/// Which images a mesh has: none, of its color, or of color, normals and finish.
enum class MeshImages { kNone, kColor, kAll };

/// What the shaders of lit surfaces do. Software drivers pay for a loop over lights even if it runs zero
/// times.
struct LitKind {
  bool fast = false;        ///< Whether they leave out soft shadows and fine grain.
  bool has_lights = false;  ///< Whether there are lights besides the sun.
};

ShaderSource mesh_shader(MeshLook look, MeshImages images, LitKind kind);  ///< Lit triangles, instanced.
/// Depth only, instanced; with holes where light goes through.
ShaderSource depth_shader(DepthFrom from, bool holed);
ShaderSource ground_shader(LitKind kind);  ///< The plane with its grid.
ShaderSource ground_depth_shader();        ///< Depth of the plane from the eye.
ShaderSource sky_shader(bool fast);        ///< The sky behind everything.
ShaderSource occlusion_shader();           ///< How much of the sky each pixel sees.
ShaderSource occlusion_blur_shader();      ///< Evens that out.
ShaderSource line_shader();                ///< Lines of a width in pixels, instanced.
ShaderSource text_shader();                ///< Triangles in pixels.
ShaderSource present_shader();             ///< Fills what nothing else covers with a picture.

}  // namespace hooke::render
