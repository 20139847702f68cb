#pragma once

#include "render/draw_list.h"
#include "render/gl/gl_objects.h"

#include <map>
#include <unordered_map>
#include <utility>

/// \file
/// Keeps copies of geometry and textures on the graphics card while their owners live.

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
  /// Brings the copy up to date and returns it. `where` names the mesh in the error for indices beyond the
  /// vertices.
  Result<const GpuMesh*> update(const std::shared_ptr<const MeshGeometry>& geometry,
                                const std::string& where);

  /// Uploads the texture once and returns it; an image that is shown must not change. `is_color` says whether
  /// its bytes are colors, or figures that are read as they are.
  Result<GLuint> update(const std::shared_ptr<const Image>& image, bool is_color, const std::string& where);

  /// Frees copies whose owners are gone.
  void remove_orphans();

 private:
  std::unordered_map<const MeshGeometry*, GpuMesh> meshes_;
  std::map<std::pair<const Image*, bool>, GpuTexture> textures_;
};

}  // namespace hooke::render
