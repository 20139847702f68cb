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

/// Adds the effect of the surroundings on the dynamic bodies among `rows`, where these are now, to
/// `bodies.force` and `bodies.torque`. With mass m, velocity v, angular velocity omega, angular momentum L:
///
/// - fields (elements/fields.h): m a at the center of mass;
/// - liquid: -rho V g at the center of the volume V that is immersed (geometry/convex/immersion.h), where g
///   is the world's gravity, across which the surface lies; drag -k m (v - flow) and torque -k L, with
///   k = drag rho V / m;
/// - air, with u = v - wind at the center of mass: -rho C_d A |u| u / 2, where A is the area shown to u, with
///   the shapes of one body added up; and C rho V omega x u (Kutta-Joukowski; C = 3/4 for a ball: Rubinow
///   and Keller 1961).
///
/// Drag of rate k is implicit: k / (1 + h k), so that no drag is too strong. The lift turns u exactly, so
/// that it does no work. Air acts between the halves of the change by all other forces (Strang splitting,
/// second order). Thus a body that is held still feels the drag of g h / 2, some 1e-6 of its weight.
void add_body_forces(std::span<const std::uint32_t> rows, const Surroundings& around, state::Bodies& bodies);

}  // namespace hooke::solver
