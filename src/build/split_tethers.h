#pragma once

#include "build/point_splits.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>

namespace hooke::build {

/// Removes the tethers of a cloth whose way along it is cut by splits that are about to be made. On a grid
/// that way is straight in the form at rest; a point that splits keeps a tether on each side from which it is
/// free. On a mesh the way is not known: a tether goes if a crack lies so near that it may lead across.
/// `after` are the triangles after the splits.
void split_tethers(std::uint32_t object, const ElementMesh<3>& mesh,
                   std::span<const std::array<std::uint32_t, 3>> after, std::span<const PointSplit> splits,
                   state::Tables& tables);

}  // namespace hooke::build
