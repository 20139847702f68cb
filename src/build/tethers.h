#pragma once

#include "hooke/math.h"

#include "geometry/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::build {

struct Tether {
  std::uint32_t point = 0;
  std::uint32_t pin = 0;
  Real length = Real(0);  ///< Distance along the surface at rest [m].
};

/// A surface at rest. `is_flat` promises that straight distances are distances along the surface.
struct TetherSurface {
  std::span<const DVec3> points;
  std::span<const geometry::Triangle> triangles;
  const geometry::MeshTopology& topology;
  bool is_flat = false;
};

/// Finds two tethers for each point that is no pin: one to its nearest pin, and one to a second pin. Points
/// that no pin holds have none. All nearest pins come first, then the second ones. For up to 8 pins the
/// second is the next nearest. For more it is the nearest on the other side of the point, because cloth that
/// hangs between two sides must not slip to one of them.
[[nodiscard]] std::vector<Tether> find_tethers(const TetherSurface& surface,
                                               std::span<const std::uint32_t> pins);

}  // namespace hooke::build
