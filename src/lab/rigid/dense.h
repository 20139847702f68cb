#pragma once

#include "lab/rigid/rigid_body.h"

#include <array>
#include <optional>

/// \file
/// Where a body is within a step: cubic Hermite interpolation of its coordinates between the ends, which
/// needs no more forces. Its error is of order dt^4; where only gravity acts it is exact for methods that
/// are. Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I", II.6.

namespace hooke::lab {

/// One body over a step.
class DenseMotion {
 public:
  /// A body that stands.
  explicit DenseMotion(const BodyMotion& still) : start_(still) { rates_.fill(still.velocity); }
  /// A body that moves evenly, by its velocity and spin, for `seconds`.
  DenseMotion(const BodyMotion& start, double seconds);
  /// From y0 at t to y1 at t + h. The system must outlive this.
  DenseMotion(const System& system, double t, double h, const State& y0, const State& y1);

  /// At `share` of the step, in [0, 1].
  [[nodiscard]] BodyMotion at(double share) const;
  [[nodiscard]] double seconds() const { return h_; }

  /// Control points of the velocity of the center: at every time it is a mean of them [m/s]. Of a body that
  /// moves as told: its velocity at three times.
  [[nodiscard]] const std::array<DVec3, 3>& velocities() const { return rates_; }
  /// Bound of the angular velocity [rad/s].
  [[nodiscard]] double fastest_spin() const { return spin_; }
  /// Bound of the angle turned through since the start [rad].
  [[nodiscard]] double largest_rotation() const { return spin_ * h_; }
  /// Control points of the center: it stays within their hull [m].
  [[nodiscard]] std::array<DVec3, 4> centers() const;

 private:
  struct Cubic {
    DVec3 from = {}, to = {}, rate_from = {}, rate_to = {};
    [[nodiscard]] DVec3 at(double s, double h) const;
    [[nodiscard]] DVec3 rate_at(double s, double h) const;
    [[nodiscard]] std::array<DVec3, 3> rates(double h) const;
  };

  const System* system_ = nullptr;
  bool told_ = false;
  double t_ = 0, h_ = 0, spin_ = 0;
  BodyMotion start_ = {};
  Cubic center_, rotation_;
  std::array<DVec3, 3> rates_ = {};
};

/// Two bodies over the same step.
struct DensePair {
  const RigidBody& a;
  const DenseMotion& motion_a;
  const RigidBody& b;
  const DenseMotion& motion_b;
  ContactSearch contact_search = {};

  [[nodiscard]] BodyGap gap(double share) const;
  /// Bound of how fast their distance along `n` shrinks [m/s]; of any direction, where they are not convex.
  [[nodiscard]] double closing(DVec3 n) const;
};

/// Share of the step at which the bodies first overlap by `allowance` [m], positive, more than at the start;
/// nothing if they do not. Conservative advancement (Mirtich 1996, "Impulse-based dynamic simulation"): along
/// the direction that holds them farthest apart they come together no faster than closing(), so nothing is
/// missed, and it is never late. After 1000 rounds they count as having met.
[[nodiscard]] std::optional<double> first_contact(const DensePair& pair, double allowance);

/// Share at which the bodies first touch, the distance changing its sign between two of 17 times; nothing if
/// it does not. Regula falsi in the form of Illinois (Dowell, Jarratt 1971), to rounding.
[[nodiscard]] std::optional<double> contact_root(const DensePair& pair, double epsilon);

/// Extruded silhouettes (the paper's 4.5.4; extruded() in lab/shape/extrusion.h): false if the bodies cannot
/// have come nearer than `reach` [m] within the step. Exact for translation; what turns has a skin as thick
/// as its points may leave the extrusion.
[[nodiscard]] bool may_collide(const DensePair& pair, double reach);

}  // namespace hooke::lab
