#pragma once

#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <vector>

namespace hooke::solver {

/// The volume inside the triangles of a closed cloth [m^3], and its gradient by the places of the particles
/// [m^2], indexed by particle from the object's first one.
struct GasVolume {
  double volume = 0;
  std::vector<DVec3> gradient;
};

/// Refills `out`. Sums in the order of the table, in double: differences of volumes are small.
void measure_gas(const state::Deformable& object, const state::Triangles& triangles,
                 const state::Particles& particles, GasVolume& out);

/// Pressure above that of the air around [Pa], of a gas that keeps its temperature: gas / V - p_0. Below a
/// thousandth of the volume it was filled at, it grows no more.
[[nodiscard]] double gas_pressure(const state::Deformable& object, double volume);

/// Pushes the cloth outward by one row for the whole volume, implicit, so that no gas is too stiff. With A_i
/// the gradient of V by x_i, k = gas / V^2 and S = sum w_i |A_i|^2:
///
///     L = h (p - h k sum A_i . v_i) / (1 + h^2 k S),   v_i += w_i L A_i
///
/// The gas law rather than a volume that is kept (V = p V_0, Macklin and Mueller): a ball has a pressure in
/// pascals, which is what a gauge reads and what decides how far it gives way. `scratch` is refilled.
void press_gas(const state::Deformable& object, const state::Triangles& triangles, double h,
               GasVolume& scratch, state::Particles& particles);

}  // namespace hooke::solver
