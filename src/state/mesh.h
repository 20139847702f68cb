#pragma once

#include "hooke/shape.h"

#include "geometry/bvh.h"

namespace hooke::state {

/// Triangles that bodies and cloths share; never changes after it was made.
struct Mesh {
  MeshDesc desc;
  geometry::Bvh bvh;  ///< Over `desc.triangles`.
};

}  // namespace hooke::state
