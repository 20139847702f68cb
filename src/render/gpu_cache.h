#pragma once

#include "render/draw_list.h"
#include "render/gl/gl_objects.h"

#include <unordered_map>

/// \file
/// Copies of geometry and textures on the graphics card, kept while their owners live.

namespace hooke::render {

struct GpuMesh {
  std::weak_ptr<const MeshGeometry> owner;
  GlName vertex_array;
  GlName vertices;
  GlName indices;
  std::uint64_t vertex_revision = 0;
  std::uint64_t topology_revision = 0;
  std::size_t vertex_count = 0;
  std::size_t index_count = 0;
  std::uint32_t max_index = 0;
};

struct GpuTexture {
  std::weak_ptr<const Image> owner;
  GlName texture;
};

class GpuCache {
 public:
  /// The copy, brought up to date. `where` names the mesh in the error for indices beyond the vertices.
  Result<const GpuMesh*> update(const std::shared_ptr<const MeshGeometry>& geometry,
                                const std::string& where);

  /// The texture, uploaded once: an image that is shown must not change.
  Result<GLuint> update(const std::shared_ptr<const Image>& image, const std::string& where);

  /// Frees what nobody owns any more.
  void remove_orphans();

 private:
  std::unordered_map<const MeshGeometry*, GpuMesh> meshes_;
  std::unordered_map<const Image*, GpuTexture> textures_;
};

}  // namespace hooke::render
