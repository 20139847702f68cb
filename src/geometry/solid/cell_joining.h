#pragma once

#include "geometry/solid/tetrahedral_mesh.h"

namespace hooke::geometry {

/// Adds cells to those of which half is inside the mesh, so that a solid of them holds together: first those
/// that thin parts pass through, away from all filled cells, then the fewest that join all pieces by faces.
/// A way through cells that the mesh touches is preferred; one through empty space costs four times as much.
[[nodiscard]] CellAdditions join_cells(const MeshDesc& mesh, CellGrid& grid);

}  // namespace hooke::geometry
