#pragma once

#include "lab/shape/convex_solid.h"

namespace hooke::geometry {

/// Returns what a convex solid sweeps over when it is shifted by `displacement` [m] without rotation. Faces
/// that face backward stay, those that face forward move, and the silhouette between them becomes the sides
/// (the paper's 4.5.4). A point becomes a segment, a segment a parallelogram, a flat face a prism. The result
/// is exact for a finite `displacement`.
[[nodiscard]] ConvexSolid extruded(const ConvexSolid& solid, DVec3 displacement);

}  // namespace hooke::geometry
