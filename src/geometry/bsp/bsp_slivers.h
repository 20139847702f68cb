#pragma once

#include "geometry/bsp/bsp_solid.h"

namespace hooke::geometry {

/// A closed manifold without what a format in float cannot hold: edges shorter than `distance` [m] are
/// collapsed, and the longest edge of a triangle that is lower than that over it is flipped, as long as the
/// mesh stays a manifold. Where neither can be done, the corner over that edge is moved away from it. The
/// surface moves by about `distance`; shells that small stay. Bounded work: at most 32 times over all
/// triangles.
[[nodiscard]] SolidMesh without_slivers(const SolidMesh& mesh, double distance);

}  // namespace hooke::geometry
