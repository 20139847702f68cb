#include "render/renderer.h"

#include "render/batches.h"
#include "render/frame.h"
#include "render/gl/programs.h"
#include "render/gpu_cache.h"
#include "render/targets.h"
#include "render/text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

namespace hooke::render {

namespace {

/// This is a buffer that is filled anew every frame, and the vertex array that reads it.
struct Stream {
  GlName vertex_array;
  GlName buffer;
};

struct GroundMesh {
  GlName vertex_array;
  GlName buffer;
  GLsizei vertex_count = 0;
};

/// This is what the line shader reads of one line.
struct LineInstance {
  std::array<float, 4> from = {};
  std::array<float, 3> to = {};
  std::array<float, 4> color = {};
};

/// Radius of the outermost ring of the ground mesh, whose innermost ring has radius one half.
constexpr float kGroundRadius = 16384;

constexpr int kGroundSides = 32;

/// This is what both passes draw.
struct Prepared {
  Batches batches;
  std::vector<const GpuMesh*> meshes;  ///< One for each batch.
  std::vector<GLuint> textures;        ///< 0 means none.
};

}  // namespace

struct RendererData {
  explicit RendererData(const Context& owner) : context(owner) {}
  RendererData(const RendererData&) = delete;
  RendererData& operator=(const RendererData&) = delete;
  // The members are deleted after this body, in the context they belong to. If the driver refuses, the
  // context and its objects are gone.
  ~RendererData() { static_cast<void>(context.make_current()); }

  Context context;
  RendererOptions options;
  Programs programs;
  PictureTarget picture;
  std::optional<ShadowTarget> shadow_map;
  GpuCache cache;
  SharedMeshes shared = make_shared_meshes();
  GlName frame_buffer;
  GlName instance_buffer;
  GlName empty_array;  ///< For shaders that make their own vertices.
  GroundMesh ground;
  Stream lines;
  Stream texts;
};

namespace {

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

/// Brings everything to the graphics card, or returns what is wrong with it.
Result<Prepared> prepare(RendererData& data, const DrawList& list) {
  auto batches = make_batches(list, data.picture.height, data.shared);
  if (!batches) return batches.error();
  Prepared prepared;
  prepared.batches = std::move(batches).value();
  for (const Batch& batch : prepared.batches.batches) {
    const std::string where =
        batch.mesh == kNoMesh ? "renderer" : "meshes[" + std::to_string(batch.mesh) + "]";
    const auto mesh = data.cache.update(batch.geometry, where);
    if (!mesh) return mesh.error();
    prepared.meshes.push_back(mesh.value());
    prepared.textures.push_back(0);
    if (!batch.texture) continue;
    const auto texture = data.cache.update(batch.texture, where);
    if (!texture) return texture.error();
    prepared.textures.back() = texture.value();
  }
  fill_buffer(GL_ARRAY_BUFFER, data.instance_buffer, prepared.batches.instances);
  return prepared;
}

void draw_batch(const RendererData& data, const Batch& batch, const GpuMesh& mesh) {
  glBindVertexArray(mesh.vertex_array.name());
  glBindBuffer(GL_ARRAY_BUFFER, data.instance_buffer.name());
  const std::size_t start = batch.first_instance * sizeof(Instance);
  for (std::size_t row = 0; row < 3; ++row) {
    const std::size_t place = start + offsetof(Instance, rows) + 4 * sizeof(float) * row;
    set_float_attribute(static_cast<GLuint>(3 + row), 4, sizeof(Instance), place, 1);
  }
  set_float_attribute(6, 4, sizeof(Instance), start + offsetof(Instance, color), 1);
  set_float_attribute(7, 2, sizeof(Instance), start + offsetof(Instance, gloss), 1);
  glFrontFace(batch.mirrored ? GL_CW : GL_CCW);
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(batch.index_count), GL_UNSIGNED_INT,
                          buffer_offset(batch.first_index * sizeof(std::uint32_t)),
                          static_cast<GLsizei>(batch.instance_count));
}

void bind_surface(GLuint texture) {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture);
}

void draw_shadow_map(const RendererData& data, const Prepared& prepared) {
  glBindFramebuffer(GL_FRAMEBUFFER, data.shadow_map->framebuffer.name());
  glViewport(0, 0, data.shadow_map->size, data.shadow_map->size);
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
  // Open surfaces cast shadows from both sides.
  glDisable(GL_CULL_FACE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 2);
  for (std::size_t i = 0; i < prepared.meshes.size(); ++i) {
    const Batch& batch = prepared.batches.batches[i];
    if (!batch.casts_shadow) continue;
    const bool holed = batch.alpha != AlphaMode::kOpaque && prepared.textures[i] != 0;
    glUseProgram(holed ? data.programs.cutout_shadow.name() : data.programs.shadow.name());
    if (holed) bind_surface(prepared.textures[i]);
    draw_batch(data, batch, *prepared.meshes[i]);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void draw_meshes(const RendererData& data, const Prepared& prepared, bool see_through) {
  glUseProgram(data.programs.mesh.name());
  for (std::size_t i = 0; i < prepared.meshes.size(); ++i) {
    const Batch& batch = prepared.batches.batches[i];
    if ((batch.alpha == AlphaMode::kBlend) != see_through) continue;
    glUniform1i(data.programs.mesh_has_texture, prepared.textures[i] != 0 ? 1 : 0);
    glUniform1i(data.programs.mesh_alpha_mode, static_cast<GLint>(batch.alpha));
    bind_surface(prepared.textures[i]);
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

void draw_ground(const RendererData& data, const Ground& ground, const View& view, float fog_distance) {
  const float above = view.eye.y - ground.height;
  if (!(above > 0)) return;
  // The rim is far enough to be less than a pixel below the horizon and deep in the fog.
  const float scale = std::max(above, 6 * fog_distance / kGroundRadius);
  const auto color = linear_of(ground.color);
  const auto line = linear_of(ground.line_color);
  const Programs& p = data.programs;
  glUseProgram(p.ground.name());
  glUniform4f(p.ground_plane, view.eye.x, ground.height, view.eye.z, scale);
  glUniform4f(p.ground_color, color[0], color[1], color[2], 1);
  glUniform4f(p.ground_grid_color, line[0], line[1], line[2], std::max(ground.grid_spacing, 0.0F));
  glUniform2f(p.ground_grid_origin, ground.grid_x, ground.grid_z);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CCW);
  glBindVertexArray(data.ground.vertex_array.name());
  glDrawArrays(GL_TRIANGLES, 0, data.ground.vertex_count);
}

void draw_sky(const RendererData& data) {
  glUseProgram(data.programs.sky.name());
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(data.empty_array.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void draw_lines(const RendererData& data, const std::vector<DrawLine>& lines) {
  if (lines.empty()) return;
  std::vector<LineInstance> instances;
  instances.reserve(lines.size());
  for (const DrawLine& line : lines) {
    const auto c = linear_of(line.color);
    instances.push_back({{line.from.x, line.from.y, line.from.z, line.width_px},
                         {line.to.x, line.to.y, line.to.z},
                         {c[0], c[1], c[2], line.opacity}});
  }
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

void draw_picture(const RendererData& data, const DrawList& list, const Prepared& prepared, const View& view,
                  float fog_distance) {
  glBindFramebuffer(GL_FRAMEBUFFER, data.picture.sampled_framebuffer.name());
  glViewport(0, 0, data.picture.width, data.picture.height);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glDepthMask(GL_TRUE);
  // No color is cleared, because the sky covers every pixel that nothing else does.
  glClear(GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, data.shadow_map ? data.shadow_map->texture.name() : 0);
  glCullFace(GL_BACK);
  draw_meshes(data, prepared, false);
  if (list.ground) draw_ground(data, *list.ground, view, fog_distance);
  draw_sky(data);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  draw_lines(data, list.lines);
  draw_meshes(data, prepared, true);
  glDisable(GL_BLEND);
  draw_texts(data, list.texts);
  resolve(data.picture);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
}

/// Resets state that another user of the context (a user interface) may have left.
void reset_state() {
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glEnable(GL_MULTISAMPLE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  for (GLuint unit = 0; unit < 2; ++unit) glBindSampler(unit, 0);
}

}  // namespace

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
  auto programs = make_programs();
  if (!programs) return programs.error();
  data->programs = std::move(programs).value();
  auto picture = make_picture_target(options.width, options.height, options.samples);
  if (!picture) return picture.error();
  data->picture = std::move(picture).value();
  if (options.shadow_map_size != 0) {
    auto shadow_map = make_shadow_target(options.shadow_map_size);
    if (!shadow_map) return shadow_map.error();
    data->shadow_map = std::move(shadow_map).value();
  }
  data->frame_buffer = make_buffer();
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
  auto picture = make_picture_target(width, height, data_->options.samples);
  if (!picture) return picture.error();
  data_->picture = std::move(picture).value();
  return {};
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
  frame.viewport = {static_cast<float>(data.picture.width), static_cast<float>(data.picture.height), 0, 0};
  glBindBuffer(GL_UNIFORM_BUFFER, data.frame_buffer.name());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(frame), &frame, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, data.frame_buffer.name());

  reset_state();
  if (map_size > 0) draw_shadow_map(data, prepared.value());
  draw_picture(data, list, prepared.value(), view, frame.shadow_info[3]);
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
  bind_surface(data_->picture.texture.name());
  glBindVertexArray(data_->empty_array.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  return take_gl_error("present");
}

}  // namespace hooke::render
