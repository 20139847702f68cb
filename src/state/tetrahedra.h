#pragma once

#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <vector>

/// \file
/// Rows of solids: tetrahedra that resist change of shape and of volume.

namespace hooke::state {

struct Tetrahedra {
  struct Corners {
    std::uint32_t a, b, c, d;  ///< b, c, d are counter-clockwise seen from a at rest: the volume is positive.
  };
  std::vector<Corners> corners;
  std::vector<std::array<Vec3, 3>> shape_gradient;  ///< Gradients of b, c, d at rest [1/m]; see
                                                    ///< elements/tetrahedron.h.
  std::vector<Real> volume;                         ///< Volume V at rest [m^3].
  std::vector<Real> shear_modulus;                  ///< Shear modulus mu [Pa].
  std::vector<Real> volume_modulus;                 ///< lambda of elements::NeoHookean [Pa].
  std::vector<Real> damping_time;                   ///< Viscosity over stiffness [s].

  [[nodiscard]] int count() const { return static_cast<int>(corners.size()); }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.corners);
    visit(self.shape_gradient);
    visit(self.volume);
    visit(self.shear_modulus);
    visit(self.volume_modulus);
    visit(self.damping_time);
  }
};

}  // namespace hooke::state
