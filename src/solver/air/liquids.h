#pragma once

#include "hooke/desc.h"

#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"
#include "state/tetrahedra.h"

#include <vector>

namespace hooke::solver {

/// The surface of a liquid. It lies across gravity, `height` above the origin, or across y where there is no
/// gravity.
struct LiquidSurface {
  DVec3 up = {0, 1, 0};  ///< Unit vector against gravity.
  double height = 0;     ///< Height above the origin [m].
  double gravity = 0;    ///< Size of gravity [m/s^2].

  LiquidSurface(const FieldDesc& liquid, Vec3 gravity_of_world);

  /// How deep x is below the surface [m]; negative above it.
  [[nodiscard]] double depth(DVec3 x) const { return height - dot(up, x); }
};

/// What a liquid does to a particle of an object, for each unit of rho g.
struct LiquidLoad {
  double volume = 0;  ///< Volume of the liquid that is displaced there [m^3].
  DVec3 push = {};    ///< Lift [m^3].
  double area = 0;    ///< Growth of the lift with depth, or more [m^2].
};

/// The tables that say what volume the particles of an object enclose.
struct LiquidRows {
  const state::Segments& segments;
  const state::Triangles& triangles;
  const state::Tetrahedra& tetrahedra;
};

/// Refills `loads`, one for each particle of the object. What an object displaces depends on its kind:
///
/// - a solid of tetrahedra: the part of each tetrahedron below the surface, at the center of that part;
/// - a closed cloth with gas: what it encloses. The pressure rho g d at depth d acts on its triangles from
///   outside, integrated with the corners' shape functions over the part below the surface;
/// - a rope, and any other cloth: as much as it is thick, with the radius r of its points: pi r^2 for each
///   length of a segment at rest, 2 r for each area of a triangle, shared out evenly to its points;
/// - a solid that is matched to its form: its volume, shared out by mass;
/// - loose particles, and points that are matched: the balls that they are.
///
/// The share of a point is immersed over its thickness, as a ball is.
void find_liquid_loads(const state::Deformable& object, const LiquidRows& rows, const LiquidSurface& surface,
                       const state::Particles& particles, std::vector<LiquidLoad>& loads);

/// Lifts and drags the particles of an object in a substep of h. Let V be the volume displaced at a particle
/// and m its mass. Drag acts on v - flow at the rate drag rho V / m, implicit; then v += h rho g push / m.
/// Where h^2 rho g area / m exceeds 1, the lift of a light particle would outrun the particle, and is damped
/// by the excess.
void apply_liquid(const FieldDesc& liquid, const LiquidSurface& surface, const state::Deformable& object,
                  const std::vector<LiquidLoad>& loads, Real h, state::Particles& particles);

}  // namespace hooke::solver
