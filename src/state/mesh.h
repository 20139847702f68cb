#pragma once

#include "hooke/bsp.h"
#include "hooke/shape.h"

#include "geometry/mesh/bvh.h"
#include "geometry/mesh/protrusions.h"

#include <cstdint>

namespace hooke::state {

/// Triangles that bodies and cloths share; never changes after it was made.
struct Mesh {
  MeshDesc desc;
  geometry::Bvh bvh;  ///< Over `desc.triangles`.
  BspTree planes;     ///< With MeshTree::kPlanes; else without nodes.
  geometry::Protrusions protrusions;
  std::uint64_t hash = 0;  ///< Of `desc`.

  [[nodiscard]] bool is_solid() const { return !planes.nodes.empty(); }
};

}  // namespace hooke::state
