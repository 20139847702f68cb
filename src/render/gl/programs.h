#pragma once

#include "render/gl/gl_objects.h"

namespace hooke::render {

/// These are all compiled shaders. Samplers have fixed units: 0 is the surface or picture, 1 the shadow map.
struct Programs {
  GlName mesh;
  GLint mesh_has_texture = -1;
  GLint mesh_alpha_mode = -1;
  GlName shadow;
  GlName cutout_shadow;
  GlName ground;
  GLint ground_plane = -1;
  GLint ground_color = -1;
  GLint ground_grid_color = -1;
  GLint ground_grid_origin = -1;
  GlName sky;
  GlName line;
  GlName text;
  GlName present;
};

/// Compiles all shaders, or returns the first error of the driver's compiler.
Result<Programs> make_programs();

}  // namespace hooke::render
