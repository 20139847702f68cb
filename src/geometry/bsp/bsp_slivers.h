#pragma once

#include "geometry/bsp/bsp_solid.h"

namespace hooke::geometry {

/// Makes a closed manifold without anything that a format in float cannot hold. Edges shorter than `distance`
/// [m] are collapsed. If a triangle is lower than that over its longest edge, this edge is flipped, as long
/// as the mesh stays a manifold. Where neither can be done, the corner over that edge is moved away from it.
/// The surface moves by about `distance`; shells that small stay. The work is bounded: at most 32 times over
/// all triangles.
[[nodiscard]] SolidMesh without_slivers(const SolidMesh& mesh, double distance);

}  // namespace hooke::geometry
