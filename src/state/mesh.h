#pragma once

#include "hooke/bsp.h"
#include "hooke/shape.h"

#include "geometry/mesh/bvh.h"
#include "geometry/mesh/protrusions.h"

#include <cstdint>

namespace hooke::state {

/// Triangles that bodies and cloths share. A Mesh never changes after it was made.
struct Mesh {
  MeshDesc desc;
  geometry::Bvh bvh;  ///< Tree of boxes over `desc.triangles`.
  BspTree planes;     ///< BSP tree with MeshTree::kPlanes; otherwise it has no nodes.
  geometry::Protrusions protrusions;
  std::uint64_t hash = 0;  ///< Hash of `desc`.

  [[nodiscard]] bool is_solid() const { return !planes.nodes.empty(); }
};

}  // namespace hooke::state
