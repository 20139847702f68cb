#pragma once

#include <algorithm>

namespace hooke::solver {

/// How iterative joints take errors back; see solver/joint/iterative_joints.h.
struct LockSoftness {
  double rate = 0;           ///< b [1/s]
  double mass_scale = 1;     ///< mu
  double impulse_scale = 0;  ///< gamma
};

/// The softness for substeps of length h [s].
inline LockSoftness lock_softness(double h) {
  constexpr double kHertz = 60;
  constexpr double kDampingRatio = 5;
  constexpr double kTwoPi = 6.283185307179586;
  const double omega = kTwoPi * std::min(kHertz, 0.25 / h);
  const double a = 2 * kDampingRatio + h * omega;
  const double mass_scale = h * omega * a / (1 + h * omega * a);
  return {omega / a, mass_scale, 1 - mass_scale};
}

}  // namespace hooke::solver
