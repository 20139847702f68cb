#include "render/gl/programs.h"

namespace hooke::render {

namespace {

Result<void> build(GlName& program, const std::string& title, const ShaderSource& source) {
  auto made = make_program(title, source.vertex, source.fragment);
  if (!made) return made.error();
  program = std::move(made).value();
  const GLuint name = program.name();
  const GLuint frame = glGetUniformBlockIndex(name, "Frame");
  if (frame != GL_INVALID_INDEX) glUniformBlockBinding(name, frame, 0);
  const GLuint lights = glGetUniformBlockIndex(name, "Lights");
  if (lights != GL_INVALID_INDEX) glUniformBlockBinding(name, lights, 1);
  glUseProgram(name);
  const auto bind_sampler = [name](const char* sampler, TextureUnit unit) {
    const GLint location = glGetUniformLocation(name, sampler);
    if (location >= 0) glUniform1i(location, static_cast<GLint>(unit));
  };
  bind_sampler("surface_texture", kSurfaceUnit);
  bind_sampler("picture", kSurfaceUnit);
  bind_sampler("depth_map", kSurfaceUnit);
  bind_sampler("shadow_map", kShadowUnit);
  bind_sampler("shadow_depth", kShadowDepthUnit);
  bind_sampler("occlusion_map", kOcclusionUnit);
  bind_sampler("noise_map", kNoiseUnit);
  bind_sampler("normals_map", kNormalsUnit);
  bind_sampler("finish_map", kFinishUnit);
  bind_sampler("light_maps", kLightMapsUnit);
  return {};
}

Result<void> build_mesh(LitPrograms& p, std::size_t look, MeshImages images) {
  const auto its_look = static_cast<MeshLook>(look);
  // Ropes and hairs have no texture.
  if (images != MeshImages::kNone && (its_look == MeshLook::kRope || its_look == MeshLook::kHair)) return {};
  MeshProgram& mesh = p.meshes[look][static_cast<std::size_t>(images)];
  auto built = build(mesh.program, "mesh", mesh_shader(its_look, images, p.kind));
  if (built) mesh.alpha_mode = glGetUniformLocation(mesh.program.name(), "alpha_mode");
  return built;
}

Result<void> build_meshes(LitPrograms& p) {
  for (std::size_t look = 0; look < kMeshLooks; ++look) {
    for (const MeshImages images : {MeshImages::kNone, MeshImages::kColor}) {
      auto built = build_mesh(p, look, images);
      if (!built) return built;
    }
  }
  return {};
}

Result<void> build_holed(HoledProgram& holed, const std::string& title, const ShaderSource& source) {
  auto built = build(holed.program, title, source);
  if (!built) return built;
  holed.density = glGetUniformLocation(holed.program.name(), "density");
  holed.has_texture = glGetUniformLocation(holed.program.name(), "has_texture");
  return {};
}

void find_ground(GroundProgram& ground) {
  const GLuint name = ground.program.name();
  ground.plane = glGetUniformLocation(name, "plane");
  ground.color = glGetUniformLocation(name, "ground_color");
  ground.grid_color = glGetUniformLocation(name, "grid_color");
  ground.grid_origin = glGetUniformLocation(name, "grid_origin");
}

}  // namespace

Result<void> make_detailed_programs(LitPrograms& programs) {
  const auto solid = static_cast<std::size_t>(MeshLook::kSolid);
  if (programs.meshes[solid][static_cast<std::size_t>(MeshImages::kAll)].program.name() != 0) return {};
  for (std::size_t look = 0; look < kMeshLooks; ++look) {
    auto built = build_mesh(programs, look, MeshImages::kAll);
    if (!built) return built;
  }
  return {};
}

Result<LitPrograms> make_lit_programs(LitKind kind) {
  LitPrograms p;
  p.kind = kind;
  const auto meshes = build_meshes(p);
  if (!meshes) return meshes.error();
  const auto ground = build(p.ground.program, "ground", ground_shader(kind));
  if (!ground) return ground.error();
  find_ground(p.ground);
  return p;
}

Result<Programs> make_programs(bool fast) {
  Programs p;
  const auto all = {build(p.shadow, "shadow", depth_shader(DepthFrom::kSun, false)),
                    build_holed(p.holed_shadow, "holed_shadow", depth_shader(DepthFrom::kSun, true)),
                    build(p.depth, "depth", depth_shader(DepthFrom::kEye, false)),
                    build_holed(p.holed_depth, "holed_depth", depth_shader(DepthFrom::kEye, true)),
                    build(p.ground_depth, "ground_depth", ground_depth_shader()),
                    build(p.sky, "sky", sky_shader(fast)),
                    build(p.occlusion, "occlusion", occlusion_shader()),
                    build(p.occlusion_blur, "occlusion_blur", occlusion_blur_shader()),
                    build(p.line, "line", line_shader()),
                    build(p.text, "text", text_shader()),
                    build(p.present, "present", present_shader())};
  for (const auto& built : all) {
    if (!built) return built.error();
  }
  p.ground_depth_plane = glGetUniformLocation(p.ground_depth.name(), "plane");
  p.occlusion_half_pixel = glGetUniformLocation(p.occlusion.name(), "half_pixel");
  p.occlusion_blur_step = glGetUniformLocation(p.occlusion_blur.name(), "step_over");
  return p;
}

}  // namespace hooke::render
