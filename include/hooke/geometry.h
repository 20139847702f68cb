#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <span>

/// \file
/// Makes meshes for bodies. Needs no world.

namespace hooke {

/// A landscape: point (column, row) lies at (column cell, heights[row * columns + column], row cell) in the
/// mesh's frame [m]; the upper side is outside. Each cell is cut from (column, row) to (column + 1, row + 1).
///
/// Errors: columns and rows outside [2, 4096], a cell that is not positive and finite, another number of
/// heights than columns x rows, a height that is not finite.
[[nodiscard]] Result<MeshDesc> make_height_field(int columns, int rows, Real cell,
                                                 std::span<const Real> heights);

}  // namespace hooke
