#pragma once

#include "hooke/math.h"

#include "render/image.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Describes one picture as plain data. Lengths are meters relative to an origin near the camera, which the
/// caller subtracts in double. Colors are sRGB, as a paint program shows them, 0 to 1.
///
/// Geometry and textures are shared by pointer. The renderer keeps its copy on the graphics card as long as
/// the pointer lives, so an object that does not change costs nothing to draw again.

namespace hooke::render {

struct Color {
  float r = 0.8F;
  float g = 0.8F;
  float b = 0.8F;
};

/// The renderer chooses near and far distances from the scene.
struct Camera {
  Vec3 eye = {4, 3, 6};
  Vec3 target = {0, 0, 0};
  Vec3 up = {0, 1, 0};
  float vertical_fov_deg = 45;  ///< Range 1 to 170.
};

struct Sun {
  Vec3 direction = {0.45F, 0.8F, 0.35F};  ///< Direction from the scene to the sun, of any length but zero.
  Color color = {1.0F, 0.97F, 0.91F};
  float intensity = 1;  ///< 0 is night.
};

/// The sky gives the picture's background, the color of distant fog and the ambient light.
struct Sky {
  Color zenith = {0.42F, 0.60F, 0.82F};
  Color horizon = {0.85F, 0.90F, 0.94F};
  float ambient = 0.6F;  ///< Light of the sky, relative to its own brightness.
};

/// The ground is an endless plane with a square grid; it is visible from above only.
struct Ground {
  float height = 0;
  Color color = {0.60F, 0.61F, 0.60F};
  Color line_color = {0.36F, 0.38F, 0.40F};
  float grid_spacing = 1;  ///< Spacing of lines [m]; every tenth is stronger. 0 or less draws no grid.
  float grid_x = 0;  ///< x and z of a crossing of grid lines, so that the grid stays when the origin moves.
  float grid_z = 0;
};

struct Vertex {
  Vec3 position;
  Vec3 normal = {0, 1, 0};  ///< Unit vector on the counter-clockwise side.
  float u = 0;
  float v = 0;  ///< 0 is the bottom row of the texture, 1 the top.
};

/// MeshGeometry is triangles. The owner may edit it between two draws and must then raise the matching
/// revision.
struct MeshGeometry {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;   ///< Three per triangle, counter-clockwise from the front.
  std::uint64_t vertex_revision = 0;    ///< Raise after a change of `vertices`.
  std::uint64_t topology_revision = 0;  ///< Raise after a change of `indices`.
};

enum class AlphaMode {
  kOpaque,  ///< The alpha of the texture is not read.
  /// There are holes where the texture's alpha is below one half. Their edges are sharp, they are sorted by
  /// depth, and they cast a holed shadow.
  kCutout,
  /// The mesh is see-through by texture alpha times opacity. It is drawn from far to near after everything
  /// solid.
  kBlend,
};

struct DrawMesh {
  std::shared_ptr<const MeshGeometry> geometry;
  std::size_t first_index = 0;           ///< A part of the geometry, for meshes of several materials.
  std::size_t index_count = 0;           ///< 0 means all from first_index.
  Mat4 transform;                        ///< Affine; scale may be uneven or mirrored.
  std::shared_ptr<const Image> texture;  ///< Multiplies the color; null stands for white.
  Color color;
  float opacity = 1;     ///< Below 1 implies AlphaMode::kBlend.
  float shininess = 40;  ///< Blinn-Phong exponent.
  float specular = 0.15F;
  AlphaMode alpha = AlphaMode::kOpaque;
  bool two_sided =
      /// Whether back faces are drawn, with the normal turned to their side. Otherwise they are culled.
      false;
  /// See-through parts below opacity one half cast no shadow in any case.
  bool casts_shadow = true;
  /// Whether the mesh is drawn before all others, in the order of the list and of its triangles, and covers
  /// what is there (see painter.h). This is for opaque meshes only.
  bool is_in_order = false;
};

/// This is a smooth round tube through the points (Catmull-Rom), with round ends.
struct DrawRope {
  std::vector<Vec3> points;  ///< Fewer than two different points draw nothing.
  float radius = 0.02F;
  Color color = {0.72F, 0.56F, 0.36F};
  float shininess = 20;
  float specular = 0.1F;
};

struct DrawSphere {
  Vec3 center;
  float radius = 0.05F;
  Color color;
};

struct DrawLine {
  Vec3 from;
  Vec3 to;
  Color color = {1, 0.4F, 0.1F};
  float opacity = 1;
  float width_px = 1.5F;
};

/// This is text over the picture, one or more lines of ASCII.
struct DrawText {
  /// Top left corner of the text, from the top left corner of the picture.
  float x_px = 8;
  float y_px = 8;
  float size_px = 16;  ///< Height of a line.
  Color color = {0.1F, 0.1F, 0.12F};
  std::string text;
};

struct DrawList {
  Camera camera;
  Sun sun;
  Sky sky;
  std::optional<Ground> ground = Ground{};
  std::vector<DrawMesh> meshes;
  std::vector<DrawRope> ropes;
  std::vector<DrawSphere> spheres;
  std::vector<DrawLine> lines;
  std::vector<DrawText> texts;
};

}  // namespace hooke::render
