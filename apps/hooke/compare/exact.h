#pragma once

#include "hooke/compare/stage.h"

#include <functional>
#include <optional>
#include <string>

namespace hooke::app {

/// This is a motion that is known in closed form.
struct ExactMotion {
  std::string title;
  std::function<DVec3(double time)> position;  ///< Position of the watched point [m].
  std::function<Energy(double time)> energy;
};

/// Returns the exact motion of the watched point, for a free mass without air on one linear spring that stays
/// on one line. It is the damped oscillator y'' = -omega^2 y - 2 zeta omega y' about its rest.
std::optional<ExactMotion> exact_motion(const Stage& stage);

/// Returns the motion that a rigid rod in place of the spring would give, for a mass that starts at rest and
/// swings: sin(theta/2) = k sn(K - omega t, k) with omega^2 = g/L and k = sin(theta_0/2). It is not the
/// motion of the scene, but near to it if the spring is stiff. Abramowitz and Stegun, 16.4.
std::optional<ExactMotion> rigid_pendulum(const Stage& stage);

}  // namespace hooke::app
