#pragma once

#include "hooke/math.h"

#include "geometry/convex/convex_hull.h"
#include "geometry/solid/tetrahedral_mesh.h"

#include <memory>
#include <span>
#include <vector>

namespace hooke::geometry {

/// The convex hulls of parts of a solid, so many that no point of its surface is deeper in its hull than a
/// thousandth of the solid's diagonal, but 64 at most. It halves the worst part until that holds, which takes
/// milliseconds where decompose_convex takes a second. Parts thinner than a hull may be are left out.
[[nodiscard]] std::vector<std::shared_ptr<const ConvexHull>> hulls_of(
    std::span<const Vec3> points, std::span<const Tetrahedron> tetrahedra);

}  // namespace hooke::geometry
