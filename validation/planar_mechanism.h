#pragma once

#include "hooke/math.h"

#include <functional>
#include <vector>

/// \file
/// Describes rods and sliders in a plane that one angle moves, as an ordinary differential equation. The
/// engine's hooks are compared with it.

namespace hooke::check {

/// This is the center of a body and its angle about z.
struct PlanarPose {
  double x = 0;  ///< [m]
  double y = 0;  ///< [m]
  double angle = 0;
};

/// The energies T = J(q) q'^2 / 2 and V(q) give q'' = -(J'(q) q'^2 / 2 + V'(q)) / J(q) (Lagrange), which the
/// classical Runge-Kutta method integrates.
class PlanarMechanism {
 public:
  struct Body {
    double mass = 1;     ///< [kg]
    double inertia = 1;  ///< Moment about z [kg m^2].
  };
  using PosesOf = std::function<std::vector<PlanarPose>(double q)>;

  PlanarMechanism(std::vector<Body> bodies, PosesOf poses)
      : bodies_(std::move(bodies)), poses_(std::move(poses)) {}

  [[nodiscard]] std::vector<PlanarPose> poses(double q) const { return poses_(q); }
  /// Returns the change of each pose per q.
  [[nodiscard]] std::vector<PlanarPose> slopes(double q) const;
  [[nodiscard]] double acceleration(double q, double speed) const;
  /// Returns q, `seconds` after rest at `start`.
  [[nodiscard]] double run(double start, double seconds) const;

 private:
  [[nodiscard]] double inertia(double q) const;
  [[nodiscard]] double potential(double q) const;

  std::vector<Body> bodies_;
  PosesOf poses_;
};

/// This is a crank of `crank` m at the origin, then the coupler, then a rocker at (ground, 0).
struct FourBar {
  double crank = 0.5;
  double coupler = 1.2;
  double rocker = 0.9;
  double ground = 1.1;

  /// Returns where coupler and rocker are joined.
  [[nodiscard]] DVec3 pin(double q) const;
  [[nodiscard]] std::vector<PlanarPose> poses(double q) const;
};

/// This is a crank at the origin, a rod, and a slider on the x axis.
struct SliderCrank {
  double crank = 0.4;
  double rod = 1.0;

  [[nodiscard]] std::vector<PlanarPose> poses(double q) const;
};

}  // namespace hooke::check
