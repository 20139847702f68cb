#pragma once

#include "hooke/shape.h"

namespace hooke::state {

/// Triangles that bodies and cloths share; never changes after it was made.
struct Mesh {
  MeshDesc desc;
};

}  // namespace hooke::state
