#pragma once

#include "lab/shape/convex_solid.h"

namespace hooke::geometry {

/// What a convex solid sweeps over as it is shifted by `way` [m], without turning: the faces that look back
/// stay, those that look ahead move on, and the silhouette between them becomes the sides (the
/// paper's 4.5.4). A point becomes a segment, a segment a plate, a plate a prism. Exact; `way` finite.
[[nodiscard]] ConvexSolid extruded(const ConvexSolid& solid, DVec3 displacement);

}  // namespace hooke::geometry
