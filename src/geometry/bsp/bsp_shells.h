#pragma once

#include "hooke/result.h"

#include "geometry/bsp/bsp_seams.h"
#include "geometry/bsp/bsp_space.h"

#include <span>

namespace hooke::geometry {

/// Checks that each shell of a closed surface, which is a set of pieces joined by edges, has only empty space
/// in front of it. A shell in the empty inside of another is fine; one wound the same way in the solid inside
/// is not. The check counts the signed crossings of a ray from one piece of each shell. Pieces are whole
/// triangles. The error names one.
Result<void> check_shells(const BspSpace& space, std::span<const BspPiece> pieces,
                          const SeamedPieces& seamed);

}  // namespace hooke::geometry
