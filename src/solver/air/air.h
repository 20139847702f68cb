#pragma once

#include "parallel/range.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// A vector that is loaded at once, as particles are.
struct alignas(4 * sizeof(Real)) AirRecord {
  Vec3 v = {};
  Real unused = Real(0);
};

/// The triangles of each particle of some objects, and what the air does to each triangle. All lists count
/// from the objects' first particle and first triangle.
struct AirLoads {
  std::uint32_t first_particle = 0;     ///< Row of that particle.
  std::uint32_t first_triangle = 0;     ///< Row of that triangle.
  std::vector<std::uint32_t> first_of;  ///< By particle, its start in `triangle_of`; one end marker.
  std::vector<std::uint32_t> triangle_of;
  std::vector<AirRecord>
      corner_impulse;             ///< A third of each triangle's impulse [N s]; written by load_triangles.
  std::vector<AirRecord> change;  ///< Change of each particle's velocity [m/s]; written by gather_loads.
};

/// What acts in one substep.
struct Air {
  const std::vector<AirRecord>& wind;  ///< Velocity of the air at each particle [m/s].
  Real density = Real(0);              ///< Density of the air [kg/m^3].
  Real h = Real(0);                    ///< Length of the substep [s].
};

/// Lists the triangles of each particle of these objects.
void build_air_loads(std::span<const state::Deformable> objects, const state::Triangles& triangles,
                     AirLoads& loads);

/// Applies drag and lift to the triangles of one cloth, in air of density rho with the velocity u relative
/// to them:
///
///     F = rho A |u| cos(a) (C_d u + C_l |u| e) / 2,   cos(a) = |n . u| / |u|,  e = n - (n . u) u / |u|^2
///
/// with n turned to the side on which the air comes out. Let m be the mass of the triangle. Where h F / (m
/// |u|) > 1, F is divided by that: within a substep no wind does more than to carry a light cloth along.
/// Below that F is not weakened: what is held against the wind feels all of it. `range` counts the triangles
/// of `object`.
void load_triangles(const state::Deformable& object, const state::Triangles& triangles, const Air& air,
                    const state::Particles& particles, parallel::Range range, AirLoads& loads);

/// Finds the change of each particle's velocity: `share` of the impulses of its triangles, added in the
/// order of the table. `range` counts particles of the world.
void gather_loads(const state::Particles& particles, Real share, parallel::Range range, AirLoads& loads);

/// Adds the changes that gather_loads found. `range` counts particles of the world.
void push_particles(const AirLoads& loads, parallel::Range range, state::Particles& particles);

/// Applies drag to the segments of one rope that are not gone: F = rho C_d d L |u_t| u_t / 2, where u_t is u
/// across the segment. Half of it goes to each end, limited as above.
void push_segments(const state::Deformable& object, const state::Segments& segments, const Air& air,
                   state::Particles& particles);

}  // namespace hooke::solver
