#pragma once

#include "hooke/math.h"

#include <cstdint>
#include <vector>

/// \file
/// All point masses of a World: ropes, cloth and loose particles differ only in their constraints.

namespace hooke::state {

/// Position and contact radius of a particle, in one load.
struct alignas(4 * sizeof(Real)) PositionRecord {
  Vec3 x = {};            ///< Position [m], an offset from the origin of the owning object.
  Real radius = Real(0);  ///< Contact radius [m].
};

/// Velocity and inverse mass of a particle, in one load and store. The inverse mass stands beside the
/// velocity, because it turns impulses into velocity. Of positions the solver then needs only differences
/// (docs/decisions/0003-spring-kernel.md).
struct alignas(4 * sizeof(Real)) VelocityRecord {
  Vec3 v = {};                  ///< Velocity [m/s].
  Real inverse_mass = Real(0);  ///< w [1/kg]; 0 holds the particle still.
};

/// Columns of equal length; row i describes particle i. An object owns one contiguous range of rows.
struct Particles {
  std::vector<PositionRecord> position;
  std::vector<VelocityRecord> velocity;
  std::vector<Real> mass;          ///< Mass [kg], also of pinned particles.
  std::vector<Real> charge;        ///< [C]
  std::vector<Real> viscous_drag;  ///< The particle's share of the object's air friction [N s/m].
  std::vector<Real> drag_area;     ///< Cd A / 2 of the particle as a sphere [m^2].
  std::vector<Vec3> force;         ///< External force for the current step [N]; cleared by finish.
  std::vector<std::uint32_t>
      row_of;  ///< Maps the maker's order to rows, both relative to the object's first row.

  [[nodiscard]] int count() const { return static_cast<int>(position.size()); }

  /// Calls `visit(column)` for each column.
  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.position);
    visit(self.velocity);
    visit(self.mass);
    visit(self.charge);
    visit(self.viscous_drag);
    visit(self.drag_area);
    visit(self.force);
    visit(self.row_of);
  }
};

}  // namespace hooke::state
