#pragma once

#include "hooke/math.h"

#include <cstdint>
#include <vector>

namespace hooke::state {

/// Particles near shapes, found by detect. Rows stand in order of particle, then collider, then feature.
struct Contacts {
  std::vector<std::uint32_t> particle;
  std::vector<std::uint32_t> collider;  ///< Row of the collider table.
  std::vector<std::uint32_t> feature;   ///< Triangle of a mesh; 0 otherwise.
  std::vector<std::uint32_t> object;    ///< Row of the deformable.
  std::vector<std::uint32_t> body;      ///< Row of the body touched.
  std::vector<Real> friction;           ///< Of the pair.
  std::vector<Vec3> normal;             ///< From the shape to the particle; written by update_contacts.
  std::vector<Real> separation;         ///< Gap less the particle's radius [m]; written by update_contacts.
  std::vector<Vec3> lever;              ///< From the body's center of mass to the particle [m]; written by
                                        ///< update_contacts.
  std::vector<Vec3> belt_velocity;      ///< Of a conveyor's surface against its body [m/s]; written by
                                        ///< update_contacts.
  std::vector<Vec3> surface_velocity;   ///< Of the body there, with that of conveyors [m/s]; written by
                                        ///< update_contacts.
  std::vector<Real> normal_force;       ///< [N], 0 or more; carried from substep to substep.
  std::vector<Vec3> friction_force;     ///< [N]; carried for ropes.

  [[nodiscard]] int count() const { return static_cast<int>(particle.size()); }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.particle);
    visit(self.collider);
    visit(self.feature);
    visit(self.object);
    visit(self.body);
    visit(self.friction);
    visit(self.normal);
    visit(self.separation);
    visit(self.lever);
    visit(self.belt_velocity);
    visit(self.surface_velocity);
    visit(self.normal_force);
    visit(self.friction_force);
  }
};

}  // namespace hooke::state
