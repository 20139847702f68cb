#pragma once

#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hooke::check {

/// A HingedSheet is a flat sheet of triangles in the plane of x and z whose edges resist bending as those of
/// a cloth do. An edge of length e between triangles of areas A1 and A2 has the energy B e^2 theta^2 / 2 (A1
/// + A2).
struct HingedSheet {
  std::vector<DVec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> is_fixed;  ///< One for each point.
  double rigidity = 0;                 ///< B [N m]
};

/// Returns how far each point is down under a small load [N/m^2] on all of the sheet, which is where the
/// energy is least. Angles are linear in the heights of points.
[[nodiscard]] std::vector<double> sag_of(const HingedSheet& sheet, double load);

}  // namespace hooke::check
