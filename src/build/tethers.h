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

/// From each point to its nearest pin and to its second nearest; none for pins themselves and for points that
/// no pin holds. First all nearest ones, then the others. A surface with more than 8 pins gets nearest ones
/// only.
[[nodiscard]] std::vector<Tether> find_tethers(const TetherSurface& surface,
                                               std::span<const std::uint32_t> pins);

}  // namespace hooke::build
