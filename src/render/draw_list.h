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
  Color color = {1.0F, 0.95F, 0.86F};
  float intensity = 1;  ///< 0 is night.
  /// Half the angle under which the sun is seen. The true one is 0.27; a wider one gives softer shadows.
  float half_angle_deg = 1.2F;
};

/// A light besides the sun. A white surface that faces one of intensity 1 is as bright as one that faces a
/// white sun of intensity 1: of a directional light everywhere, of the others at a distance of 1 m, from
/// where it falls off by the square.
struct Light {
  enum class Kind {
    kDirectional,  ///< From far away, along `direction`.
    kPoint,        ///< From `position`, to all sides.
    kSpot,         ///< From `position`, within a cone about `direction`.
  };

  Kind kind = Kind::kPoint;
  Vec3 position = {0, 3, 0};
  Vec3 direction = {0, -1, 0};  ///< In which its light goes, of any length but zero.
  Color color = {1, 1, 1};
  float intensity = 1;
  float inner_deg = 20;  ///< Half angle of a spot within which it is as bright as in its middle.
  float outer_deg = 30;  ///< Half angle beyond which there is none of its light, at most 80.
  bool casts_shadow = true;
};

/// The sky gives the picture's background, the light from all sides, what shiny things mirror, and the color
/// of what is far away.
struct Sky {
  Color zenith = {0.30F, 0.52F, 0.80F};
  Color horizon = {0.78F, 0.87F, 0.95F};
  float brightness = 1;  ///< Of all of it, as it is seen and as it lights.
  float ambient = 0.6F;  ///< Light of the sky, relative to its own brightness.
  float clouds = 0.5F;   ///< Share of the sky that clouds cover, 0 to 1. They give no shadow.
};

/// The ground is an endless plane with a square grid; it is visible from above only.
struct Ground {
  float height = 0;
  Color color = {0.60F, 0.61F, 0.60F};
  Color line_color = {0.52F, 0.53F, 0.53F};
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

/// How light meets a surface.
enum class Shading {
  kSolid,  ///< A smooth surface, or one that is evenly rough.
  /// A sheet of threads: light falls through it, and its fibers shine at the rim.
  kCloth,
  kRope,  ///< A laid rope: three strands wind around its axis.
  kHair,  ///< A tuft of fine hairs, each of which mirrors the light as a cylinder.
};

/// A Surface is what a material looks like, but for its color.
struct Surface {
  Shading shading = Shading::kSolid;
  float metalness = 0;     ///< 0 is an insulator, 1 a metal, whose color is that of what it mirrors.
  float roughness = 0.6F;  ///< 0 is a mirror, 1 mirrors the same to all sides.
  float sheen = 0;         ///< Light that the fibers of a cloth throw at the rim, 0 to 1.
  /// Share of the light that goes through, colored by the surface, 0 to 1. Above 0 implies
  /// AlphaMode::kBlend.
  float transmission = 0;
  float threads = 0;  ///< Threads of a cloth along one unit of its texture coordinates; 0 draws none.
  float relief = 1;   ///< Strength of DrawMesh::normals; a negative one turns it inward.
};

struct DrawMesh {
  std::shared_ptr<const MeshGeometry> geometry;
  std::size_t first_index = 0;           ///< A part of the geometry, for meshes of several materials.
  std::size_t index_count = 0;           ///< 0 means all from first_index.
  Mat4 transform;                        ///< Affine; scale may be uneven or mirrored.
  std::shared_ptr<const Image> texture;  ///< Multiplies the color; null stands for white.
  /// Normals along the texture's u, v and outward, as bytes about 128; null for a smooth surface. Bytes are
  /// no colors here, as in the next.
  std::shared_ptr<const Image> normals;
  std::shared_ptr<const Image> finish;  ///< Green times roughness, blue times metalness; null for both once.
  Color color;
  float opacity = 1;  ///< Below 1 implies AlphaMode::kBlend.
  Surface surface;
  AlphaMode alpha = AlphaMode::kOpaque;
  bool two_sided =
      /// Whether back faces are drawn, with the normal turned to their side. Otherwise they are culled.
      false;
  /// The shadow of what is see-through is as pale as it lets light through.
  bool casts_shadow = true;
  /// Whether the mesh is drawn before all others, in the order of the list and of its triangles, and covers
  /// what is there (see painter.h). This is for opaque meshes only.
  bool is_in_order = false;
};

/// This is a smooth round tube through the points (Catmull-Rom), with round ends; or, if it is shaded as
/// hair, a tuft of strands of about that radius.
struct DrawRope {
  std::vector<Vec3> points;  ///< Fewer than two different points draw nothing.
  float radius = 0.02F;
  Color color = {0.72F, 0.56F, 0.36F};
  Surface surface = {Shading::kRope, 0, 0.75F, 0, 0, 0, 1};
};

struct DrawSphere {
  Vec3 center;
  float radius = 0.05F;
  Color color;
  Surface surface = {};
};

struct DrawLine {
  Vec3 from;
  Vec3 to;
  Color color = {1, 0.4F, 0.1F};
  float opacity = 1;
  float width_px = 1.5F;
  bool on_top = false;  ///< Whether it is drawn over everything, also over what stands before it.
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
  std::vector<Light> lights;  ///< Besides the sun; see frame.h for the most there may be.
  std::optional<Ground> ground = Ground{};
  std::vector<DrawMesh> meshes;
  std::vector<DrawRope> ropes;
  std::vector<DrawSphere> spheres;
  std::vector<DrawLine> lines;
  std::vector<DrawText> texts;
};

}  // namespace hooke::render
