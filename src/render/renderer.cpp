#include "render/renderer.h"

#include "render/frame.h"
#include "render/renderer_data.h"
#include "render/text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

namespace hooke::render {

namespace {

/// This is what the line shader reads of one line.
struct LineInstance {
  std::array<float, 4> from = {};
  std::array<float, 3> to = {};
  std::array<float, 4> color = {};
};

constexpr int kGroundSides = 32;

/// Width and height of a picture in those of the smaller picture of its sky.
constexpr int kSkyPart = 4;

/// How far things darken each other, in distances of the eye from its target.
constexpr float kOcclusionRadius = 0.09F;

void set_float_attribute(GLuint location, GLint size, std::size_t stride, std::size_t offset,
                         GLuint divisor) {
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                        buffer_offset(offset));
  glVertexAttribDivisor(location, divisor);
}

template <class T>
void fill_buffer(GLenum target, const GlName& buffer, const std::vector<T>& data) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STREAM_DRAW);
}

Stream make_stream() {
  Stream stream{make_vertex_array(), make_buffer()};
  glBindVertexArray(stream.vertex_array.name());
  glBindBuffer(GL_ARRAY_BUFFER, stream.buffer.name());
  return stream;
}

Stream make_line_stream() {
  Stream stream = make_stream();
  set_float_attribute(0, 4, sizeof(LineInstance), offsetof(LineInstance, from), 1);
  set_float_attribute(1, 3, sizeof(LineInstance), offsetof(LineInstance, to), 1);
  set_float_attribute(2, 4, sizeof(LineInstance), offsetof(LineInstance, color), 1);
  return stream;
}

Stream make_text_stream() {
  Stream stream = make_stream();
  set_float_attribute(0, 2, sizeof(TextVertex), offsetof(TextVertex, x_px), 0);
  set_float_attribute(1, 3, sizeof(TextVertex), offsetof(TextVertex, color), 0);
  return stream;
}

/// Makes rings whose radius doubles, so that no triangle is so large that its depth loses digits.
GroundMesh make_ground_mesh() {
  std::vector<Vec3> vertices;
  const auto at = [](int side, float radius) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(side) / kGroundSides;
    return Vec3{radius * std::sin(angle), 0, radius * std::cos(angle)};
  };
  float inner = 0;
  for (int ring = -1; std::exp2(ring) <= kGroundRadius; ++ring) {
    const auto outer = static_cast<float>(std::exp2(ring));
    for (int side = 0; side < kGroundSides; ++side) {
      vertices.insert(vertices.end(), {at(side, inner), at(side, outer), at(side + 1, outer)});
      vertices.insert(vertices.end(), {at(side, inner), at(side + 1, outer), at(side + 1, inner)});
    }
    inner = outer;
  }
  GroundMesh mesh{make_vertex_array(), make_buffer(), static_cast<GLsizei>(vertices.size())};
  glBindVertexArray(mesh.vertex_array.name());
  fill_buffer(GL_ARRAY_BUFFER, mesh.buffer, vertices);
  set_float_attribute(0, 3, sizeof(Vec3), 0, 0);
  return mesh;
}

/// Brings the images of a batch to the graphics card: that of its color, and those of its relief and finish.
Result<std::pair<GLuint, DetailTextures>> prepare_images(RendererData& data, LitPrograms& programs,
                                                         const Batch& batch, const std::string& where) {
  std::pair<GLuint, DetailTextures> found;
  const bool has_details = batch.normals || batch.finish;
  if (batch.texture || has_details) {
    const auto color = data.cache.update(batch.texture ? batch.texture : data.plain, true, where);
    if (!color) return color.error();
    found.first = color.value();
  }
  if (!has_details) return found;
  const auto made = make_detailed_programs(programs);
  if (!made) return made.error();
  const auto normals = data.cache.update(batch.normals ? batch.normals : data.flat, false, where);
  if (!normals) return normals.error();
  const auto finish = data.cache.update(batch.finish ? batch.finish : data.plain, false, where);
  if (!finish) return finish.error();
  found.second = {normals.value(), finish.value()};
  return found;
}

/// Returns the shaders of lit surfaces, which are made when first used.
Result<LitPrograms*> lit_programs(RendererData& data, bool has_lights) {
  std::optional<LitPrograms>& lit = data.lit[has_lights ? 1 : 0];
  if (!lit) {
    auto made = make_lit_programs({data.options.fast, has_lights});
    if (!made) return made.error();
    lit = std::move(made).value();
  }
  return &*lit;
}

/// Brings everything to the graphics card, or returns what is wrong with it.
Result<Prepared> prepare(RendererData& data, const DrawList& list) {
  auto batches = make_batches(list, data.picture.height, data.options.fast, data.shared);
  if (!batches) return batches.error();
  const auto programs = lit_programs(data, !list.lights.empty());
  if (!programs) return programs.error();
  Prepared prepared;
  prepared.programs = programs.value();
  prepared.batches = std::move(batches).value();
  for (const Batch& batch : prepared.batches.batches) {
    const std::string where =
        batch.mesh == kNoMesh ? "renderer" : "meshes[" + std::to_string(batch.mesh) + "]";
    const auto mesh = data.cache.update(batch.geometry, where);
    if (!mesh) return mesh.error();
    prepared.meshes.push_back(mesh.value());
    const auto images = prepare_images(data, *programs.value(), batch, where);
    if (!images) return images.error();
    prepared.textures.push_back(images.value().first);
    prepared.details.push_back(images.value().second);
  }
  fill_buffer(GL_ARRAY_BUFFER, data.instance_buffer, prepared.batches.instances);
  return prepared;
}

MeshLook look_of(const Batch& batch) {
  if (batch.alpha == AlphaMode::kBlend) return MeshLook::kClear;
  switch (batch.shading) {
    case Shading::kCloth:
      return MeshLook::kCloth;
    case Shading::kRope:
      return MeshLook::kRope;
    case Shading::kHair:
      return MeshLook::kHair;
    case Shading::kSolid:
      break;
  }
  return MeshLook::kSolid;
}

/// Ropes and hairs have no texture.
const MeshProgram& program_of(const LitPrograms& programs, const Batch& batch, GLuint texture,
                              GLuint normals) {
  const auto& of_look = programs.meshes[static_cast<std::size_t>(look_of(batch))];
  const auto wanted = normals != 0 ? MeshImages::kAll : texture != 0 ? MeshImages::kColor : MeshImages::kNone;
  const MeshProgram& program = of_look[static_cast<std::size_t>(wanted)];
  return program.program.name() != 0 ? program : of_look[0];
}

void draw_meshes(const RendererData& data, const Prepared& prepared, bool see_through) {
  for (std::size_t i = 0; i < prepared.meshes.size(); ++i) {
    const Batch& batch = prepared.batches.batches[i];
    if ((batch.alpha == AlphaMode::kBlend) != see_through) continue;
    const DetailTextures& details = prepared.details[i];
    const MeshProgram& program = program_of(*prepared.programs, batch, prepared.textures[i], details.normals);
    glUseProgram(program.program.name());
    if (program.alpha_mode >= 0) glUniform1i(program.alpha_mode, static_cast<GLint>(batch.alpha));
    bind_texture(kSurfaceUnit, prepared.textures[i]);
    bind_texture(kNormalsUnit, details.normals);
    bind_texture(kFinishUnit, details.finish);
    if (batch.alpha == AlphaMode::kCutout) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    if (see_through && batch.two_sided) {
      // The far side is drawn first.
      glEnable(GL_CULL_FACE);
      glCullFace(GL_FRONT);
      draw_batch(data, batch, *prepared.meshes[i]);
      glCullFace(GL_BACK);
    } else if (batch.two_sided) {
      glDisable(GL_CULL_FACE);
    } else {
      glEnable(GL_CULL_FACE);
    }
    glDepthFunc(batch.is_in_order ? GL_ALWAYS : GL_LEQUAL);
    draw_batch(data, batch, *prepared.meshes[i]);
    glDepthFunc(GL_LEQUAL);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  }
}

void draw_ground(const RendererData& data, const GroundProgram& p, const Ground& ground,
                 const std::array<float, 4>& plane) {
  const auto color = linear_of(ground.color);
  const auto line = linear_of(ground.line_color);
  glUseProgram(p.program.name());
  glUniform4fv(p.plane, 1, plane.data());
  glUniform4f(p.color, color[0], color[1], color[2], 1);
  glUniform4f(p.grid_color, line[0], line[1], line[2], std::max(ground.grid_spacing, 0.0F));
  glUniform2f(p.grid_origin, ground.grid_x, ground.grid_z);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CCW);
  glBindVertexArray(data.ground.vertex_array.name());
  glDrawArrays(GL_TRIANGLES, 0, data.ground.vertex_count);
}

/// Fills what nothing else covers with the sky, or with the smaller picture of it.
void draw_sky(const RendererData& data) {
  glUseProgram(data.sky ? data.programs.present.name() : data.programs.sky.name());
  if (data.sky) bind_texture(kSurfaceUnit, data.sky->texture.name());
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(data.empty_array.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Draws the smaller picture of the sky, which is smooth enough for that.
void draw_small_sky(const RendererData& data) {
  glBindFramebuffer(GL_FRAMEBUFFER, data.sky->framebuffer.name());
  glViewport(0, 0, data.sky->width, data.sky->height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  bind_texture(kNoiseUnit, data.noise.name());
  glUseProgram(data.programs.sky.name());
  glBindVertexArray(data.empty_array.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

/// Draws the lines that lie on top of everything, or all others.
void draw_lines(const RendererData& data, const std::vector<DrawLine>& lines, bool on_top) {
  std::vector<LineInstance> instances;
  instances.reserve(lines.size());
  for (const DrawLine& line : lines) {
    if (line.on_top != on_top) continue;
    const auto c = linear_of(line.color);
    instances.push_back({{line.from.x, line.from.y, line.from.z, line.width_px},
                         {line.to.x, line.to.y, line.to.z},
                         {c[0], c[1], c[2], line.opacity}});
  }
  if (instances.empty()) return;
  glUseProgram(data.programs.line.name());
  glDisable(GL_CULL_FACE);
  glBindVertexArray(data.lines.vertex_array.name());
  fill_buffer(GL_ARRAY_BUFFER, data.lines.buffer, instances);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
}

void draw_texts(const RendererData& data, const std::vector<DrawText>& texts) {
  std::vector<TextVertex> triangles;
  for (const DrawText& text : texts) add_text(text, triangles);
  if (triangles.empty()) return;
  glUseProgram(data.programs.text.name());
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(data.texts.vertex_array.name());
  fill_buffer(GL_ARRAY_BUFFER, data.texts.buffer, triangles);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(triangles.size()));
}

/// Binds what the shaders of light read.
void bind_light(const RendererData& data) {
  const GLuint map = data.shadow_map ? data.shadow_map->texture.name() : 0;
  bind_texture(kShadowUnit, map);
  bind_texture(kShadowDepthUnit, map);
  glBindSampler(kShadowDepthUnit, data.raw_depths.name());
  bind_texture(kOcclusionUnit, data.occlusion ? data.occlusion->textures[1].name() : 0);
  bind_texture(kNoiseUnit, data.noise.name());
  bind_texture(kLightMapsUnit, data.light_maps ? data.light_maps->texture.name() : 0);
}

void draw_picture(const RendererData& data, const DrawList& list, const Prepared& prepared,
                  const std::array<float, 4>* plane) {
  glBindFramebuffer(GL_FRAMEBUFFER, drawn_framebuffer(data.picture).name());
  glViewport(0, 0, data.picture.width, data.picture.height);
  glDepthMask(GL_TRUE);
  // No color is cleared, because the sky covers every pixel that nothing else does.
  glClear(GL_DEPTH_BUFFER_BIT);
  bind_light(data);
  glCullFace(GL_BACK);
  // In software, depths are quicker than light on what something else hides: it saves a twentieth of the
  // time.
  if (data.options.fast) draw_opaque_depths(data, prepared);
  draw_meshes(data, prepared, false);
  if (plane != nullptr) draw_ground(data, prepared.programs->ground, *list.ground, *plane);
  draw_sky(data);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  draw_lines(data, list.lines, false);
  // What is behind is multiplied by the second color of the shader.
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  draw_meshes(data, prepared, true);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_DEPTH_TEST);
  draw_lines(data, list.lines, true);
  glDisable(GL_BLEND);
  draw_texts(data, list.texts);
  glBindSampler(kShadowDepthUnit, 0);
  resolve(data.picture);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
}

/// Brings the lights to the graphics card, and draws their shadow maps.
Result<void> prepare_lights(RendererData& data, const Prepared& prepared, const LightPlan& plan,
                            const FrameUniforms& frame) {
  glBindBuffer(GL_UNIFORM_BUFFER, data.light_buffer.name());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(plan.uniforms), &plan.uniforms, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, data.light_buffer.name());
  if (plan.clips.empty()) return {};
  const int rows = static_cast<int>(plan.uniforms.count[2]);
  if (!data.light_maps || data.light_rows != rows) {
    auto maps = make_shadow_tiles(data.options.shadow_map_size / 2, kLightColumns, rows);
    if (!maps) return maps.error();
    data.light_maps = std::move(maps).value();
    data.light_rows = rows;
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, data.frame_buffer.name());
  draw_light_maps(data, prepared, plan, frame);
  return {};
}

/// Makes what is drawn into for a picture of that size. After an Error the old ones stay.
Result<void> make_targets(RendererData& data, int width, int height) {
  const RendererOptions& options = data.options;
  auto picture = make_picture_target(width, height, options.samples);
  if (!picture) return picture.error();
  std::optional<OcclusionTarget> occlusion;
  if (options.occlusion) {
    auto made = make_occlusion_target(width, height, options.fast ? 4 : 2);
    if (!made) return made.error();
    occlusion = std::move(made).value();
  }
  std::optional<PictureTarget> sky;
  if (options.fast) {
    auto made = make_picture_target(std::max(width / kSkyPart, 1), std::max(height / kSkyPart, 1), 1);
    if (!made) return made.error();
    sky = std::move(made).value();
  }
  data.picture = std::move(picture).value();
  data.occlusion = std::move(occlusion);
  data.sky = std::move(sky);
  return {};
}

/// Resets state that another user of the context (a user interface) may have left.
void reset_state() {
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glEnable(GL_MULTISAMPLE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  for (GLuint unit = 0; unit < kTextureUnits; ++unit) glBindSampler(unit, 0);
}

}  // namespace

void draw_batch(const RendererData& data, const Batch& batch, const GpuMesh& mesh) {
  glBindVertexArray(mesh.vertex_array.name());
  glBindBuffer(GL_ARRAY_BUFFER, data.instance_buffer.name());
  const std::size_t start = batch.first_instance * sizeof(Instance);
  for (std::size_t row = 0; row < 3; ++row) {
    const std::size_t place = start + offsetof(Instance, rows) + 4 * sizeof(float) * row;
    set_float_attribute(static_cast<GLuint>(3 + row), 4, sizeof(Instance), place, 1);
  }
  set_float_attribute(6, 4, sizeof(Instance), start + offsetof(Instance, color), 1);
  set_float_attribute(7, 4, sizeof(Instance), start + offsetof(Instance, surface), 1);
  set_float_attribute(8, 2, sizeof(Instance), start + offsetof(Instance, clear), 1);
  glFrontFace(batch.mirrored ? GL_CW : GL_CCW);
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(batch.index_count), GL_UNSIGNED_INT,
                          buffer_offset(batch.first_index * sizeof(std::uint32_t)),
                          static_cast<GLsizei>(batch.instance_count));
}

Renderer::Renderer(std::unique_ptr<RendererData> data) : data_(std::move(data)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

int Renderer::width() const {
  return data_->picture.width;
}
int Renderer::height() const {
  return data_->picture.height;
}

Result<Renderer> Renderer::create(const Context& context, const RendererOptions& options) {
  const auto current = context.make_current();
  if (!current) return current.error();
  auto data = std::make_unique<RendererData>(context);
  data->options = options;
  auto programs = make_programs(options.fast);
  if (!programs) return programs.error();
  data->programs = std::move(programs).value();
  const auto lit = lit_programs(*data, false);
  if (!lit) return lit.error();
  const auto targets = make_targets(*data, options.width, options.height);
  if (!targets) return targets.error();
  if (options.shadow_map_size != 0) {
    auto shadow_map = make_shadow_target(options.shadow_map_size);
    if (!shadow_map) return shadow_map.error();
    data->shadow_map = std::move(shadow_map).value();
  }
  data->raw_depths = make_sampler();
  glSamplerParameteri(data->raw_depths.name(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
  glSamplerParameteri(data->raw_depths.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glSamplerParameteri(data->raw_depths.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  data->noise = make_noise_texture();
  data->frame_buffer = make_buffer();
  data->light_buffer = make_buffer();
  data->instance_buffer = make_buffer();
  data->empty_array = make_vertex_array();
  data->ground = make_ground_mesh();
  data->lines = make_line_stream();
  data->texts = make_text_stream();
  const auto error = take_gl_error("renderer");
  if (!error) return error.error();
  return Renderer(std::move(data));
}

Result<void> Renderer::resize(int width, int height) {
  if (width == data_->picture.width && height == data_->picture.height) return {};
  auto current = data_->context.make_current();
  if (!current) return current;
  return make_targets(*data_, width, height);
}

Result<void> Renderer::draw(const DrawList& list) {
  RendererData& data = *data_;
  auto current = data.context.make_current();
  if (!current) return current;
  data.cache.remove_orphans();
  const auto prepared = prepare(data, list);
  if (!prepared) return prepared.error();

  const float aspect = static_cast<float>(data.picture.width) / static_cast<float>(data.picture.height);
  const Batches& batches = prepared.value().batches;
  const View view = make_view(list.camera, aspect, batches.objects, list.ground ? &*list.ground : nullptr);
  const int map_size = data.shadow_map && list.sun.intensity > 0 ? data.shadow_map->size : 0;
  const ShadowView shadow =
      make_shadow_view(view, batches.casters, list.sun.direction, std::max(map_size, 1));
  FrameUniforms frame = make_frame(list, view, shadow, map_size);
  frame.viewport = {static_cast<float>(data.picture.width), static_cast<float>(data.picture.height),
                    kOcclusionRadius * length(list.camera.target - list.camera.eye),
                    data.occlusion ? 1.0F : 0.0F};
  const auto lights = plan_lights(list, view, batches.casters, data.options.shadow_map_size / 2);
  if (!lights) return lights.error();
  reset_state();
  auto lit = prepare_lights(data, prepared.value(), lights.value(), frame);
  if (!lit) return lit;
  glBindBuffer(GL_UNIFORM_BUFFER, data.frame_buffer.name());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(frame), &frame, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, data.frame_buffer.name());

  if (map_size > 0) draw_shadow_map(data, prepared.value());
  const bool from_above = list.ground && view.eye.y > list.ground->height;
  const auto plane =
      from_above ? ground_plane(*list.ground, view.eye, frame.shadow_info[3]) : std::array<float, 4>{};
  const std::array<float, 4>* const ground = from_above ? &plane : nullptr;
  if (data.occlusion) {
    const float half_height = std::max(length(view.up), 1e-6F);
    draw_occlusion(data, prepared.value(), ground,
                   0.5F * static_cast<float>(data.occlusion->height) / half_height);
  }
  if (data.sky) draw_small_sky(data);
  draw_picture(data, list, prepared.value(), ground);
  return take_gl_error("draw");
}

Result<Image> Renderer::read_image() const {
  const auto current = data_->context.make_current();
  if (!current) return current.error();
  Image image = read_pixels(data_->picture);
  const auto error = take_gl_error("read_image");
  if (!error) return error.error();
  return image;
}

Result<void> Renderer::present(int width, int height) const {
  auto current = data_->context.make_current();
  if (!current) return current;
  reset_state();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
  glUseProgram(data_->programs.present.name());
  bind_texture(kSurfaceUnit, data_->picture.texture.name());
  glBindVertexArray(data_->empty_array.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  return take_gl_error("present");
}

}  // namespace hooke::render
