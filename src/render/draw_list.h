#pragma once

#include "hooke/math.h"

#include "render/image.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// \file
/// What one picture shows, as plain data. Lengths are meters relative to an origin near the camera: the
/// caller subtracts it in double precision before anything arrives here. Colors are sRGB as picked in a paint
/// program, 0 to 1.
///
/// Geometry and textures are shared by pointer. The renderer keeps its copy on the graphics card for as long
/// as the pointer lives, so an object that does not change costs nothing to draw again.

namespace hooke::render {

struct Color {
  float r = 0.8F;
  float g = 0.8F;
  float b = 0.8F;
};

/// Near and far distances are chosen from the scene.
struct Camera {
  Vec3 eye = {4, 3, 6};
  Vec3 target = {0, 0, 0};
  Vec3 up = {0, 1, 0};
  float vertical_fov_deg = 45;  ///< 1 to 170.
};

struct Sun {
  Vec3 direction = {0.45F, 0.8F, 0.35F};  ///< From the scene to the sun; any length but zero.
  Color color = {1.0F, 0.97F, 0.91F};
  float intensity = 1;  ///< 0 is night.
};

/// The picture's background, the color of distant fog and the ambient light.
struct Sky {
  Color zenith = {0.42F, 0.60F, 0.82F};
  Color horizon = {0.85F, 0.90F, 0.94F};
  float ambient = 0.6F;  ///< How much the sky lights, relative to its own brightness.
};

/// An endless plane with a square grid, seen from above only.
struct Ground {
  float height = 0;
  Color color = {0.60F, 0.61F, 0.60F};
  Color line_color = {0.36F, 0.38F, 0.40F};
  float grid_spacing = 1;  ///< [m], every tenth line is stronger; 0 or less draws no grid.
  float grid_x = 0;  ///< A point where grid lines cross, so that the grid stands still when the origin moves.
  float grid_z = 0;
};

struct Vertex {
  Vec3 position;
  Vec3 normal = {0, 1, 0};  ///< Unit length, on the counter-clockwise side.
  float u = 0;
  float v = 0;  ///< 0 is the bottom row of the texture, 1 the top.
};

/// Triangles. The owner may edit it between two draws and then raises the matching revision.
struct MeshGeometry {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;   ///< Three per triangle, counter-clockwise from the front.
  std::uint64_t vertex_revision = 0;    ///< Raise after a change of `vertices`.
  std::uint64_t topology_revision = 0;  ///< Raise after a change of `indices`.
};

enum class AlphaMode {
  kOpaque,  ///< The texture's alpha is not read.
  kCutout,  ///< Holes where the texture's alpha is below one half; sharp, sorted by depth, casts a holed
            ///< shadow.
  kBlend,   ///< See-through: texture alpha times opacity. Drawn far to near after everything solid.
};

struct DrawMesh {
  std::shared_ptr<const MeshGeometry> geometry;
  std::size_t first_index = 0;           ///< One part of the geometry, for meshes of several materials.
  std::size_t index_count = 0;           ///< 0 is: all from first_index.
  Mat4 transform;                        ///< Affine; scale may be uneven or mirrored.
  std::shared_ptr<const Image> texture;  ///< Multiplies the color; none is white.
  Color color;
  float opacity = 1;     ///< Below 1 implies AlphaMode::kBlend.
  float shininess = 40;  ///< Blinn-Phong exponent.
  float specular = 0.15F;
  AlphaMode alpha = AlphaMode::kOpaque;
  bool two_sided =
      false;  ///< Back faces are drawn, with the normal turned to their side. Else they are culled.
  bool casts_shadow = true;  ///< See-through parts below opacity one half never do.
  bool is_in_order = false;  ///< Drawn before all others, in the order of the list and of its triangles, over
                             ///< what is there: see painter.h. Opaque only.
};

/// A smooth round tube through the points (Catmull-Rom), with round ends.
struct DrawRope {
  std::vector<Vec3> points;  ///< Fewer than two different ones draw nothing.
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

/// One or more lines of ASCII text over the picture.
struct DrawText {
  float x_px = 8;  ///< Top left corner of the text, from the top left corner of the picture.
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
