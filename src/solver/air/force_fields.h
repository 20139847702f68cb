#pragma once

#include "hooke/desc.h"

#include "parallel/range.h"
#include "solver/air/air.h"
#include "state/objects.h"
#include "state/particles.h"

#include <vector>

namespace hooke::solver {

/// Forces on single particles: drag, then v += h (fields + w force), then the rotation by a magnetic field.
///
/// Viscous drag c and quadratic drag k = rho C_d A / 2 act on v - wind implicitly: v - wind is divided by
/// 1 + h w (c + k |v - wind|). They act on the velocity before it is accelerated. So a rope that holds a
/// particle still carries m g, not m g / (1 + h w c). A magnetic field turns v by exactly -(q/m) |B| h about
/// B: the speed does not change. Liquids are in solver/air/liquids.h. `range` counts the particles of
/// `object`. Gravity is not among these forces: it is added to all particles at once.
struct ForceInputs {
  const std::vector<state::Field>& fields;
  const std::vector<AirRecord>& wind;
  Real air_density = Real(0);
  bool any_force = false;  ///< Whether some external force is set.
};

void apply_forces(const state::Deformable& object, const ForceInputs& inputs, Real h, parallel::Range range,
                  state::Particles& particles);

/// Displacement of a given motion `t` seconds after its start [m].
[[nodiscard]] DVec3 motion_offset(const MotionDesc& motion, double t);

/// Gives each pinned particle the velocity that brings it to where its motion wants it at `time`, `h` from
/// now.
void drive_pins(const std::vector<state::Pin>& pins, const std::vector<state::Deformable>& objects,
                double time, Real h, state::Particles& particles);

}  // namespace hooke::solver
