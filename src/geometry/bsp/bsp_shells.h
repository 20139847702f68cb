#pragma once

#include "hooke/result.h"

#include "geometry/bsp/bsp_seams.h"
#include "geometry/bsp/bsp_space.h"

#include <span>

namespace hooke::geometry {

/// Whether each shell of a closed surface, pieces that are joined by edges, has nothing but empty space
/// before it: a shell in the empty inside of another is fine, one wound the same way in the solid inside is
/// not. By the signed crossings of a ray from one piece of each. Pieces are whole triangles. The error names
/// one.
Result<void> check_shells(const BspSpace& space, std::span<const BspPiece> pieces,
                          const SeamedPieces& seamed);

}  // namespace hooke::geometry
