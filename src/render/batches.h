#pragma once

#include "hooke/result.h"

#include "render/view.h"

#include <array>
#include <span>
#include <vector>

/// \file
/// Turns a draw list into few draw calls: all ropes become one mesh, spheres instances of one sphere, equal
/// meshes one batch.

namespace hooke::render {

/// An Instance is what the vertex shader knows of one copy of a mesh.
struct Instance {
  std::array<float, 12> rows = {};    ///< Rows of the affine matrix.
  std::array<float, 4> color = {};    ///< Linear color; the last is the opacity.
  std::array<float, 4> surface = {};  ///< Metalness, roughness, sheen, threads.
  std::array<float, 4> clear = {};    ///< Transmission, strength of the relief, two unused.
};

constexpr std::size_t kNoMesh = static_cast<std::size_t>(-1);

/// A Batch is one draw call.
struct Batch {
  std::shared_ptr<const MeshGeometry> geometry;
  std::shared_ptr<const Image> texture;
  std::shared_ptr<const Image> normals;
  std::shared_ptr<const Image> finish;
  std::size_t first_index = 0;
  std::size_t index_count = 0;
  std::size_t first_instance = 0;
  std::size_t instance_count = 0;
  AlphaMode alpha = AlphaMode::kOpaque;
  Shading shading = Shading::kSolid;
  float density = 1;  ///< Share of the sun's light that the shadow takes.
  bool two_sided = false;
  bool mirrored = false;
  bool casts_shadow = true;
  bool is_in_order = false;
  std::size_t mesh = kNoMesh;  ///< Index of its first entry in DrawList::meshes, to name it in errors.
};

struct Batches {
  std::vector<Batch> batches;  ///< First meshes that are drawn in order, then solid, holed, and see-through
                               ///< ones from far to near.
  std::vector<Instance> instances;
  std::vector<Bounds> objects;  ///< One box for each drawn thing, for near and far distances.
  Bounds casters;               ///< Box around everything that casts a shadow.
};

/// These are meshes that every frame needs but no list brings; the renderer keeps them.
struct SharedMeshes {
  std::array<std::shared_ptr<const MeshGeometry>, 3> spheres;  ///< From coarse to fine.
  std::shared_ptr<MeshGeometry> ropes;                         ///< Filled by make_batches, as the next.
  std::shared_ptr<MeshGeometry> hairs;
};

SharedMeshes make_shared_meshes();

/// Makes the batches. The Error kOutOfRange names a mesh whose index range is outside of its geometry.
/// `fast` draws fewer hairs.
Result<Batches> make_batches(const DrawList& list, int height_px, bool fast, SharedMeshes& shared);

/// Returns the linear light of an sRGB color.
std::array<float, 3> linear_of(Color color);

}  // namespace hooke::render
