#pragma once

#include "solver/surface/surface_mesh.h"

#include <span>
#include <vector>

namespace hooke::solver {

/// Makes a tree over cells whose centers at rest are given: each set of cells is split in the middle along
/// the longest side of the box around their centers, and both halves again, which makes a node of four.
[[nodiscard]] std::vector<SurfaceNode> build_surface_tree(std::span<const Vec3> centers);

}  // namespace hooke::solver
