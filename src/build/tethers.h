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
  Real length = Real(0);  ///< Distance at rest along the surface [m].
};

/// A surface at rest. `is_flat` promises that straight distances are distances along it.
struct TetherSurface {
  std::span<const DVec3> points;
  std::span<const geometry::Triangle> triangles;
  const geometry::MeshTopology& topology;
  bool is_flat = false;
};

/// Tethers each point to its nearest pin and to a second one, except pins themselves and points that no pin
/// holds. All nearest ones come first, then the others. For up to 8 pins the second is the next nearest; for
/// more it is the nearest of those on the other side of the point: what hangs between two sides must not
/// slip to one of them.
[[nodiscard]] std::vector<Tether> find_tethers(const TetherSurface& surface,
                                               std::span<const std::uint32_t> pins);

}  // namespace hooke::build
