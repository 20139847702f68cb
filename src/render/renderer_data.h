#pragma once

#include "render/batches.h"
#include "render/frame.h"
#include "render/gl/programs.h"
#include "render/gpu_cache.h"
#include "render/renderer.h"
#include "render/targets.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

/// \file
/// What the passes of the renderer share. The owning context must be current in all of this.

namespace hooke::render {

/// Returns an image of one pixel.
inline std::shared_ptr<const Image> make_pixel(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  return std::make_shared<const Image>(Image{1, 1, 3, {red, green, blue}});
}

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

/// Radius of the outermost ring of the ground mesh, whose innermost ring has radius one half.
constexpr float kGroundRadius = 16384;

/// Textures of a surface's relief and finish; both are 0, or none is.
struct DetailTextures {
  GLuint normals = 0;
  GLuint finish = 0;
};

/// This is what all passes draw.
struct Prepared {
  Batches batches;
  std::vector<const GpuMesh*> meshes;   ///< One for each batch.
  std::vector<GLuint> textures;         ///< 0 means none.
  std::vector<DetailTextures> details;  ///< The same.
  const LitPrograms* programs = nullptr;
};

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
  std::array<std::optional<LitPrograms>, 2> lit;  ///< Without lights besides the sun, and with them.
  PictureTarget picture;
  std::optional<ShadowTarget> shadow_map;
  std::optional<ShadowTarget> light_maps;  ///< Made when lights besides the sun first cast shadows.
  int light_rows = 0;                      ///< Rows of its tiles.
  std::optional<OcclusionTarget> occlusion;
  std::optional<PictureTarget> sky;  ///< A smaller picture of the sky, for drivers without a graphics card.
  GlName raw_depths;  ///< The sampler that reads depths of the shadow map without comparing them.
  std::shared_ptr<const Image> flat = make_pixel(128, 128, 255);   ///< In place of normals.
  std::shared_ptr<const Image> plain = make_pixel(255, 255, 255);  ///< In place of a finish or a color.
  GlName noise;                                                    ///< Texture of clouds and grain.
  GpuCache cache;
  SharedMeshes shared = make_shared_meshes();
  GlName frame_buffer;
  GlName light_buffer;
  GlName instance_buffer;
  GlName empty_array;  ///< For shaders that make their own vertices.
  GroundMesh ground;
  Stream lines;
  Stream texts;
};

/// Binds a texture to a unit.
void bind_texture(TextureUnit unit, GLuint texture);

/// Draws one batch with the program in use.
void draw_batch(const RendererData& data, const Batch& batch, const GpuMesh& mesh);

/// Returns where the ground's mesh is placed: its center and scale. `haze_distance` is that of the frame [m].
std::array<float, 4> ground_plane(const Ground& ground, Vec3 eye, float haze_distance);

/// Draws depths from the sun into the shadow map.
void draw_shadow_map(const RendererData& data, const Prepared& prepared);

/// Draws depths from the lights into their maps. It leaves another frame in the buffer of the shaders.
void draw_light_maps(const RendererData& data, const Prepared& prepared, const LightPlan& plan,
                     FrameUniforms frame);

/// Draws depths of opaque solids from the eye, as draw_picture will, and no color.
void draw_opaque_depths(const RendererData& data, const Prepared& prepared);

/// Draws depths from the eye at half the size, and from them how much of the sky each pixel sees. `ground`
/// may be null; `plane` is that of ground_plane.
void draw_occlusion(const RendererData& data, const Prepared& prepared, const std::array<float, 4>* plane,
                    float pixels_per_length);

/// Returns a texture of 256 x 256 pixels that repeats: sums of smooth random numbers, from 0 to 1.
GlName make_noise_texture();

}  // namespace hooke::render
