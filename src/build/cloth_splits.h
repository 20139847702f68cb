#pragma once

#include "build/point_splits.h"
#include "state/tables.h"

#include <cstdint>
#include <span>

namespace hooke::build {

/// Splits points of a cloth, with all that follows from it: springs along the crack are shared out between
/// its two sides by their mass, and those across it go, as do bends about it and tethers whose way it cuts.
/// Hooks follow their triangles. Gas is lost. Rows of later objects move. `mesh` is the cloth before it.
void split_cloth(std::uint32_t object, const ElementMesh<3>& mesh, std::span<const PointSplit> splits,
                 state::Tables& tables);

}  // namespace hooke::build
