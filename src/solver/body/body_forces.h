#pragma once

#include "hooke/desc.h"

#include "state/bodies.h"
#include "state/colliders.h"
#include "state/objects.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// What surrounds the bodies in a substep of length h [s] that begins at `time` [s].
struct Surroundings {
  const std::vector<state::Field>& fields;
  const state::Colliders& colliders;
  const WorldDesc& desc;   ///< Gravity and wind.
  std::uint64_t step = 0;  ///< For WindDesc::Gusts::kPaper.
  double time = 0;
  Real h = Real(0);
};

/// Adds to `bodies.force` and `bodies.torque` what the surroundings do to the dynamic bodies among `rows`,
/// where these are now. With mass m, velocity v, angular velocity omega, angular momentum L:
///
/// - fields (elements/fields.h): m a at the center of mass;
/// - liquid: -rho V g at the center of the volume V that is immersed (geometry/convex/immersion.h), g the
/// world's
///   gravity, across which its surface lies; drag -k m (v - flow) and torque -k L, k = drag rho V / m;
/// - air, with u = v - wind at the center of mass: -rho C_d A |u| u / 2, A the area shown to u, shapes of one
///   body added up; and C rho V omega x u (Kutta-Joukowski; C = 3/4 for a ball: Rubinow and Keller 1961).
///
/// Drag of rate k is implicit: k / (1 + h k), so that no drag is too strong. The lift turns u exactly, so
/// that it does no work. Air acts between the halves of the change by all other forces (Strang splitting,
/// second order); a body held still so feels the drag of g h / 2, some 1e-6 of its weight.
void add_body_forces(std::span<const std::uint32_t> rows, const Surroundings& around, state::Bodies& bodies);

}  // namespace hooke::solver
