#pragma once

#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

namespace hooke::solver {

/// The volume inside the triangles of a closed cloth [m^3], and its gradient by the places of the particles
/// [m^2], indexed by particle from the object's first one.
struct GasVolume {
  double volume = 0;
  std::vector<DVec3> gradient;

  /// The push of the gas on a body through the particles that touch it, for each unit of impulse.
  struct Push {
    std::uint32_t body = 0;
    DVec3 force;   ///< [m^2]
    DVec3 torque;  ///< [m^3]
  };
  std::vector<Push> pushes;  ///< Scratch of press_gas.
};

/// Measures the gas into `out`. Sums are taken in the order of the table, in double: differences of volumes
/// are small.
void measure_gas(const state::Deformable& object, const state::Triangles& triangles,
                 const state::Particles& particles, GasVolume& out);

/// Pressure above that of the air around [Pa], of a gas that keeps its temperature: gas / V - p_0. Below a
/// thousandth of the volume at which it was filled, the pressure grows no more.
[[nodiscard]] double gas_pressure(const state::Deformable& object, double volume);

/// Pushes the cloth outward by one row for the whole volume, implicit, so that no gas is too stiff. With A_i
/// the gradient of V by x_i, k = gas / V^2 and S = sum w_i |A_i|^2:
///
///     L = h (p - h k sum A_i . v_i) / (1 + h^2 k S),   v_i += w_i L A_i
///
/// A particle that is pressed against a shape does not give way along the normal n. There the shape's
/// velocity counts, and in S its inverse mass and inertia (those of a particle's first contact). If the
/// particle counted as free, a gas under a load would be softer than its law by up to the pressed part of S:
/// the light skin would give way to the gas first, and then be pushed back.
///
/// The gas law is used rather than a constant volume (V = p V_0, Macklin and Mueller): a ball has a pressure
/// in pascals, which a gauge reads and which decides how far it gives way. `scratch` is refilled.
void press_gas(const state::Deformable& object, double h, GasVolume& scratch, state::Tables& tables);

}  // namespace hooke::solver
