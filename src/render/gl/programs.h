#pragma once

#include "render/gl/gl_objects.h"
#include "render/gl/shaders.h"

#include <array>

namespace hooke::render {

/// Each sampler of the shaders has a fixed texture unit.
enum TextureUnit : GLuint {
  kSurfaceUnit,      ///< The surface's texture, or the picture that is read.
  kShadowUnit,       ///< The shadow map, which compares.
  kShadowDepthUnit,  ///< The shadow map's depths.
  kOcclusionUnit,
  kNoiseUnit,
  kNormalsUnit,    ///< Normals of the surface.
  kFinishUnit,     ///< Roughness and metalness of the surface.
  kLightMapsUnit,  ///< The shadow maps of lights besides the sun, which compare.
  kTextureUnits,
};

/// A program that draws lit triangles.
struct MeshProgram {
  GlName program;
  GLint alpha_mode = -1;
};

/// A program that draws the depth of what may have holes.
struct HoledProgram {
  GlName program;
  GLint density = -1;
  GLint has_texture = -1;
};

struct GroundProgram {
  GlName program;
  GLint plane = -1;
  GLint color = -1;
  GLint grid_color = -1;
  GLint grid_origin = -1;
};

/// The shaders of lit surfaces.
struct LitPrograms {
  LitKind kind;
  /// By look; without a texture, with one, and with relief and finish, which are made when first used.
  std::array<std::array<MeshProgram, 3>, kMeshLooks> meshes;
  GroundProgram ground;
};

/// These are all other compiled shaders.
struct Programs {
  GlName shadow;
  HoledProgram holed_shadow;
  GlName depth;
  HoledProgram holed_depth;
  GlName ground_depth;
  GLint ground_depth_plane = -1;
  GlName sky;
  GlName occlusion;
  GLint occlusion_half_pixel = -1;
  GlName occlusion_blur;
  GLint occlusion_blur_step = -1;
  GlName line;
  GlName text;
  GlName present;
};

/// Compiles shaders, or returns the first error of the driver's compiler.
Result<Programs> make_programs(bool fast);
Result<LitPrograms> make_lit_programs(LitKind kind);

/// Compiles the shaders of meshes with relief and finish, if they are not there.
Result<void> make_detailed_programs(LitPrograms& programs);

}  // namespace hooke::render
