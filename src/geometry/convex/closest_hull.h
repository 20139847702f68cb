#pragma once

#include "geometry/closest.h"
#include "geometry/convex/convex_hull.h"

namespace hooke::geometry {

/// Surface point of a convex hull. Inside it is on the nearest face, of equally near ones on the first.
/// Outside the normal points from the surface point to `p`. Tests every face and edge.
[[nodiscard]] SurfacePoint<Real> closest_on_hull(Vec3 p, const ConvexHull& hull);

}  // namespace hooke::geometry
