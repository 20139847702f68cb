#pragma once

#include "hooke/result.h"

#include "render/view.h"

#include <array>
#include <span>
#include <vector>

/// \file
/// Turns a draw list into few draw calls: ropes become one mesh, spheres instances of one sphere, equal
/// meshes one batch.

namespace hooke::render {

/// What the vertex shader knows of one copy of a mesh.
struct Instance {
  std::array<float, 12> rows = {};  ///< The affine matrix by rows.
  std::array<float, 4> color = {};  ///< Linear; the last is the opacity.
  std::array<float, 4> gloss = {};  ///< Exponent, strength, two unused.
};

constexpr std::size_t kNoMesh = static_cast<std::size_t>(-1);

/// One draw call.
struct Batch {
  std::shared_ptr<const MeshGeometry> geometry;
  std::shared_ptr<const Image> texture;
  std::size_t first_index = 0;
  std::size_t index_count = 0;
  std::size_t first_instance = 0;
  std::size_t instance_count = 0;
  AlphaMode alpha = AlphaMode::kOpaque;
  bool two_sided = false;
  bool mirrored = false;
  bool casts_shadow = true;
  bool is_in_order = false;
  std::size_t mesh = kNoMesh;  ///< Its first entry in DrawList::meshes, to name it in errors.
};

struct Batches {
  std::vector<Batch>
      batches;  ///< What is in order first, then solid, holed, and see-through from far to near.
  std::vector<Instance> instances;
  std::vector<Bounds> objects;  ///< One box for each drawn thing, for near and far.
  Bounds casters;               ///< Around everything that casts a shadow.
};

/// Meshes that the list does not bring but every frame needs; kept by the renderer.
struct SharedMeshes {
  std::array<std::shared_ptr<const MeshGeometry>, 3> spheres;  ///< From coarse to fine.
  std::shared_ptr<MeshGeometry> ropes;                         ///< Filled by make_batches.
};

SharedMeshes make_shared_meshes();

/// kOutOfRange, naming the mesh, for index ranges outside the geometry.
Result<Batches> make_batches(const DrawList& list, int height_px, SharedMeshes& shared);

/// The linear light of an sRGB color.
std::array<float, 3> linear_of(Color color);

}  // namespace hooke::render
