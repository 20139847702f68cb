#pragma once

#include "solver/rope/rope_systems.h"
#include "solver/surface/surface_groups.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// A point of a rope that a hook holds to a body or to the world.
struct HeldRopePoint {
  std::uint32_t particle = 0;  ///< Row of the point.
  std::uint32_t body = 0;      ///< Row of the body; state::HookPlace::kWorld for the world.
  DVec3 anchor = {};           ///< Offset from the body's center in its frame [m].
};

/// Memory of a RopeSpread.
struct RopeSpreadScratch {
  std::vector<state::VelocityRecord> solved;  ///< By particle: velocities with which ropes were solved.
  std::vector<std::uint32_t> ropes;           ///< Rope systems that have rows of surfaces.
  std::vector<HeldRopePoint> held;            ///< In order of particles.
  std::vector<DVec3> change;                  ///< By node of one rope: change of velocity [m/s].
  std::vector<DVec3> direction;               ///< By segment: unit vectors.
  std::vector<double> inverse_mass;           ///< By node; 0 where it is held [1/kg].
  std::vector<double> pivot, tension;         ///< By segment: of the tridiagonal system.
};

/// Notes the velocities with which ropes were solved, and which of them have rows of surfaces:
/// those in coupled groups. docs/decisions/0040-contact-of-surfaces.md says why not others.
void begin_rope_spread(std::span<const RopeSystem> rope_systems, const SurfaceContacts& surfaces,
                       const state::Tables& tables, RopeSpreadScratch& scratch);

/// Gives to whole ropes what rows of surfaces gave to their points since they were solved. A row knows the
/// mass of a point alone, and would stretch a taut rope by it. With d the directions of segments, w the
/// inverse masses of points and gamma = 1 / (h (c + h k)) as in RopeSystem, segments answer with impulses
/// lambda such that
///
///   d_s . (dv_(s+1) - dv_s) = gamma_s lambda_s,    dv_s = dv0_s + w_s (lambda_s d_s - lambda_(s-1) d_(s-1))
///
/// which is tridiagonal. Without gamma it is the projection of the points' change of velocity dv0 on what
/// leaves each length as it was solved: momentum stays, and no energy comes of it. A point that a hook holds
/// to a body moves with it: both have one mass, and the body gets its share.
void spread_over_ropes(Real h, std::span<const RopeSystem> rope_systems, RopeSpreadScratch& scratch,
                       state::Tables& tables);

}  // namespace hooke::solver
