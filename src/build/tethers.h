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

/// Finds up to four tethers for each point that is no pin: one to its nearest pin, and others to pins that
/// lie in other directions from it, because cloth that hangs between its pins must not slip to one of them.
/// Points that edges join to no pin have none. Of more than 256 pins those that lie far apart count, of a
/// curved surface of more than 32. Tethers of one pin follow each other.
[[nodiscard]] std::vector<Tether> find_tethers(const TetherSurface& surface,
                                               std::span<const std::uint32_t> pins);

}  // namespace hooke::build
