#pragma once

#include "hooke/math.h"

#include "parallel/range.h"

#include <cstdint>

namespace hooke::solver::wide {

/// The air on triangles: where the columns begin, as numbers. Particles, wind and impulses are lines of four.
struct TriangleAir {
  const std::uint32_t* corners;  ///< Three particles a triangle.
  const Real* mass;              ///< [kg]
  const Real* position;
  const Real* velocity;
  const Real* wind;
  Real* corner_impulse;
  Real drag, lift;  ///< Coefficients.
  Real density, h;  ///< Of the air [kg/m^3]; [s].
};

/// Writes what the air does to a corner of each triangle of the range. Formula: solver/air.h.
void load_triangles(const TriangleAir& air, parallel::Range rows);
void load_triangles_scalar(const TriangleAir& air, parallel::Range rows);

}  // namespace hooke::solver::wide
