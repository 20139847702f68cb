#pragma once

#include "solver/joint_rows/joint_rows_tuning.h"

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
  constexpr double kTwoPi = 6.283185307179586;
  const double omega = kTwoPi * std::min(kLockHertz, kLockSubstepShare / h);
  const double a = 2 * kLockDampingRatio + h * omega;
  const double mass_scale = h * omega * a / (1 + h * omega * a);
  return {omega / a, mass_scale, 1 - mass_scale};
}

}  // namespace hooke::solver
