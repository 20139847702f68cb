#include "render/gl/programs.h"

#include "render/gl/shaders.h"

namespace hooke::render {

namespace {

Result<void> build(GlName& program, const std::string& title, const ShaderSource& source) {
  auto made = make_program(title, source.vertex, source.fragment);
  if (!made) return made.error();
  program = std::move(made).value();
  const GLuint name = program.name();
  const GLuint frame = glGetUniformBlockIndex(name, "Frame");
  if (frame != GL_INVALID_INDEX) glUniformBlockBinding(name, frame, 0);
  glUseProgram(name);
  const auto bind_sampler = [name](const char* sampler, GLint unit) {
    const GLint location = glGetUniformLocation(name, sampler);
    if (location >= 0) glUniform1i(location, unit);
  };
  bind_sampler("surface_texture", 0);
  bind_sampler("picture", 0);
  bind_sampler("shadow_map", 1);
  return {};
}

}  // namespace

Result<Programs> make_programs() {
  Programs p;
  const auto all = {build(p.mesh, "mesh", mesh_shader()),
                    build(p.shadow, "shadow", shadow_shader()),
                    build(p.cutout_shadow, "cutout_shadow", cutout_shadow_shader()),
                    build(p.ground, "ground", ground_shader()),
                    build(p.sky, "sky", sky_shader()),
                    build(p.line, "line", line_shader()),
                    build(p.text, "text", text_shader()),
                    build(p.present, "present", present_shader())};
  for (const auto& built : all) {
    if (!built) return built.error();
  }
  p.mesh_has_texture = glGetUniformLocation(p.mesh.name(), "has_texture");
  p.mesh_alpha_mode = glGetUniformLocation(p.mesh.name(), "alpha_mode");
  p.ground_plane = glGetUniformLocation(p.ground.name(), "plane");
  p.ground_color = glGetUniformLocation(p.ground.name(), "ground_color");
  p.ground_grid_color = glGetUniformLocation(p.ground.name(), "grid_color");
  p.ground_grid_origin = glGetUniformLocation(p.ground.name(), "grid_origin");
  return p;
}

}  // namespace hooke::render
