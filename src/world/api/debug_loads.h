#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <array>
#include <vector>

/// \file
/// How much each part of a deformable is loaded, for debug pictures.

namespace hooke::world {

/// A segment of a rope or a spring, with its tension [N] or strain.
struct LoadedLine {
  DVec3 from = {};  ///< In the world [m].
  DVec3 to = {};
  double load = 0;
};

/// A triangle of a cloth or of the surface of a solid, with its strain.
struct LoadedTriangle {
  std::array<DVec3, 3> corners = {};  ///< In the world [m].
  double load = 0;
};

/// The loads of one deformable. A rope has tensions; all others have strains: of each principal strain of a
/// triangle or a tetrahedron that which is largest by size.
struct Loads {
  std::vector<LoadedLine> lines;
  std::vector<LoadedTriangle> triangles;
};

/// Returns the loads of an object as it is now.
[[nodiscard]] Loads loads_of(const state::Tables& tables, const state::Deformable& object);

}  // namespace hooke::world
