#pragma once

#include "hooke/desc.h"

#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"
#include "state/tetrahedra.h"

#include <vector>

namespace hooke::solver {

/// Where a liquid ends: across gravity, `height` above the origin; across y where there is no gravity.
struct LiquidSurface {
  DVec3 up = {0, 1, 0};  ///< Unit.
  double height = 0;     ///< [m]
  double gravity = 0;    ///< [m/s^2]

  LiquidSurface(const FieldDesc& liquid, Vec3 gravity_of_world);

  /// How deep x is below the surface [m]; negative above it.
  [[nodiscard]] double depth(DVec3 x) const { return height - dot(up, x); }
};

/// What a liquid does to the particle of an object, for each unit of rho g.
struct LiquidLoad {
  double volume = 0;  ///< What of the liquid is displaced there [m^3].
  DVec3 push = {};    ///< The lift [m^3].
  double area = 0;    ///< By which the lift grows with depth, or more [m^2].
};

/// The tables that say what the particles of an object enclose.
struct LiquidRows {
  const state::Segments& segments;
  const state::Triangles& triangles;
  const state::Tetrahedra& tetrahedra;
};

/// Refills `loads`, one for each particle of the object. It displaces
///
/// - a solid of tetrahedra: what of each lies below the surface, at the center of that part;
/// - a closed cloth with gas: what it encloses. The pressure rho g d at depth d acts on its triangles from
///   outside, integrated with the corners' shape functions over the part below the surface;
/// - a rope, and any other cloth: as much as it is thick, with the radius r of its points: pi r^2 for each
///   length of a segment at rest, 2 r for each area of a triangle, shared out evenly to its points;
/// - a solid that is matched to its form: its volume, shared out by mass;
/// - loose particles, and points that are matched: the balls they are.
///
/// What belongs to a point is immersed over its thickness, as a ball is.
void find_liquid_loads(const state::Deformable& object, const LiquidRows& rows, const LiquidSurface& surface,
                       const state::Particles& particles, std::vector<LiquidLoad>& loads);

/// Lifts and drags the particles of an object in a substep of h. With V the volume displaced at a particle, m
/// its mass: drag of v - flow at the rate drag rho V / m, implicit, then v += h rho g push / m. Where h^2 rho
/// g area / m exceeds 1, the lift of a light particle would outrun it, and is damped by the excess.
void apply_liquid(const FieldDesc& liquid, const LiquidSurface& surface, const state::Deformable& object,
                  const std::vector<LiquidLoad>& loads, Real h, state::Particles& particles);

}  // namespace hooke::solver
