#pragma once

#include "hooke/math.h"

#include "parallel/range.h"

#include <cstdint>

namespace hooke::solver::wide {

/// The air on triangles, with the starts of columns as numbers. Particles, wind and impulses are records of
/// four.
struct TriangleAir {
  const std::uint32_t* corners;  ///< Three particles for each triangle.
  const Real* mass;              ///< Mass of each triangle [kg].
  const Real* position;
  const Real* velocity;
  const Real* wind;
  Real* corner_impulse;
  Real drag, lift;  ///< Coefficients.
  Real density, h;  ///< Density of the air [kg/m^3]; substep [s].
};

/// Finds what the air does to a corner of each triangle of the range. Formula: solver/air/air.h.
void load_triangles(const TriangleAir& air, parallel::Range rows);
void load_triangles_scalar(const TriangleAir& air, parallel::Range rows);

/// The air on the segments of one rope, with columns as above.
struct SegmentAir {
  std::uint32_t first_particle, count;  ///< First node; number of segments.
  const Real* rest_length;              ///< Rest length of the first segment [m].
  const Real* position;                 ///< The fourth number is the radius [m].
  const Real* wind;
  Real* velocity;  ///< The fourth number is the inverse mass [1/kg].
  Real strength;   ///< h rho C_d [kg s/m^3]
};

/// Adds what the air does to the velocities of the rope's nodes. Formula: solver/air/air.h.
void push_segments(const SegmentAir& air);
void push_segments_scalar(const SegmentAir& air);

}  // namespace hooke::solver::wide
