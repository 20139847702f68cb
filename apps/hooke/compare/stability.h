#pragma once

#include "hooke/compare/stage.h"

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace hooke::app {

/// This is what the watched scene can do near its start, seen by a step: its eigenvalues.
struct SystemMotion {
  /// Eigenvalues times the step, h lambda, the largest first, without their conjugates and doubles. Empty if
  /// the laboratory refuses the scene or nothing in it pulls.
  std::vector<std::complex<double>> z;
  bool bounded = false;  ///< Whether they are upper bounds; see lab::Spectrum.
  std::string stiffest;  ///< What makes the first one fast.
  double omega = 0;      ///< Size of the largest eigenvalue [1/s].
  double zeta = 0;       ///< Its damping ratio.
  bool grows = false;    ///< Whether some motion grows by itself, as from an unstable equilibrium.
  /// What the laboratory leaves out of the scene or replaces, one sentence for each.
  std::vector<std::string> left_out;
};

/// The factor by which a step multiplies an undamped oscillation.
struct GrowthPoint {
  double omega_dt = 0;
  double growth = 1;
};

/// The part of a horizontal line in the plane of h lambda on which a method is stable.
struct StableSpan {
  double imaginary = 0;  ///< Imaginary part of the line; it stands for a band of kBandHeight about it.
  double from = 0;       ///< Smallest real part.
  double to = 0;         ///< Largest real part.
};

/// Part of the plane of h lambda that is searched; the lower half is the mirror image of the upper.
struct StabilityWindow {
  static constexpr double kLeft = -4.5;
  static constexpr double kRight = 2.5;
  static constexpr double kTop = 4;
  static constexpr double kBandHeight = 0.05;
};

/// This is how one method treats oscillations, as its own steps show.
struct MethodGrowth {
  lab::StepperInfo info;
  std::vector<GrowthPoint> curve = {};  ///< Measured, undamped; empty for adaptive methods.
  std::optional<double> undamped = {};  ///< Measured at the largest omega h of the scene, without damping.
  /// Eigenvalue of the scene times the step that the method lets grow most, or fade least.
  std::optional<std::complex<double>> worst = {};
  double worst_growth = 1;              ///< The factor there, measured where that can be.
  std::vector<StableSpan> stable = {};  ///< Where the method is stable.
  std::string consequence = {};         ///< What this means for the scene, as a part of a sentence.
};

/// This is everything that theory says about methods and a scene.
struct Stability {
  SystemMotion system;
  std::vector<MethodGrowth> methods;  ///< Without the solver, which is no such method.

  /// Returns null for the solver, and for what a declared accuracy chose.
  [[nodiscard]] const MethodGrowth* find(const std::string& name) const;
};

/// Studies methods on the stage. Names that are no methods of the laboratory are passed over.
Stability study_stability(const Stage& stage, const std::vector<std::string>& names);

/// Says in words what a growth of `growth` per step of `dt` seconds means for a motion h lambda = z, in a run
/// of `seconds`.
std::string consequence_of(double growth, std::complex<double> z, double dt, double seconds);

/// Says in one sentence how fast the scene is.
std::string text_of_motion(const SystemMotion& system, double dt);

}  // namespace hooke::app
