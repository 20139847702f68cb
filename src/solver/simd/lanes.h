#pragma once

#include <span>

/// \file
/// How many rows kernels take side by side.

namespace hooke::solver {

/// Rows in a block. Floats of the widest instruction set fill one vector with them; other sets take several
/// vectors.
inline constexpr int kLanes = 16;

namespace wide {

/// Systems in double that are solved side by side, ropes and trees, and rows of tetrahedra. They fill one
/// vector of the widest set.
inline constexpr int kDoubleLanes = 8;

/// Blocks that share no particle which is written; the last block holds `last_count` rows.
template <class Block>
struct Run {
  std::span<const Block> blocks;
  int last_count = kLanes;
};

}  // namespace wide

}  // namespace hooke::solver
