#pragma once

#include "build/point_splits.h"
#include "state/tables.h"

#include <cstdint>
#include <span>

namespace hooke::build {

/// Parts a solid between pairs of neighbors, with the splits that find_splits gave for them: tetrahedra and
/// hooks get their new points, and what still holds together is scored. The skin follows its tetrahedra: a
/// triangle of it stays on one side of the crack, and the faces that have come open become part of it. Rows
/// of later objects move. `mesh` is the solid before it.
void part_solid(std::uint32_t object, const ElementMesh<4>& mesh, std::span<const PointSplit> splits,
                std::span<const ElementPair> parted, state::Tables& tables);

}  // namespace hooke::build
