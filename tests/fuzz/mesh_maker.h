#pragma once

#include "hooke/shape.h"

#include "fuzz/random.h"

namespace hooke::fuzz {

/// A closed convex or concave solid of a few dozen triangles: a box, a prism, a star, a ring, two boxes
/// apart.
[[nodiscard]] MeshDesc make_solid(Random& random, double size);

/// Any triangles: a soup, a sheet, a strip; or a solid with some of it spoiled: corners moved, merged or far
/// away, triangles gone, doubled, turned, made flat, with indices out of range.
[[nodiscard]] MeshDesc make_hostile_mesh(Random& random, double size);

}  // namespace hooke::fuzz
