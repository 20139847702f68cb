#pragma once

#include "lab/rigid/rigid_body.h"

#include <array>
#include <optional>

/// \file
/// Tells where a body is within a step, by cubic Hermite interpolation of its coordinates between the ends,
/// which needs no more forces. Its error is of order dt^4. Where only gravity acts it is exact for methods
/// that are. Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I", II.6.

namespace hooke::lab {

/// A DenseMotion is the motion of one body over a step.
class DenseMotion {
 public:
  /// Makes the motion of a body that stands.
  explicit DenseMotion(const BodyMotion& still) : start_(still) { rates_.fill(still.velocity); }
  /// Makes the motion of a body that keeps its velocity and spin for `seconds`.
  DenseMotion(const BodyMotion& start, double seconds);
  /// Makes the motion from y0 at t to y1 at t + h. The system must outlive this.
  DenseMotion(const System& system, double t, double h, const State& y0, const State& y1);

  /// Returns the motion at `share` of the step, in [0, 1].
  [[nodiscard]] BodyMotion at(double share) const;
  [[nodiscard]] double seconds() const { return h_; }

  /// Control points of the velocity of the center [m/s]; at every time the velocity is a weighted mean of
  /// them. For a kinematic body these are its velocities at three times.
  [[nodiscard]] const std::array<DVec3, 3>& velocities() const { return rates_; }
  /// Returns a bound of the angular velocity [rad/s].
  [[nodiscard]] double fastest_spin() const { return spin_; }
  /// Returns a bound of the angle between the start and any time of the step [rad].
  [[nodiscard]] double largest_rotation() const { return spin_ * h_; }
  /// Returns control points of the center, which stays within their hull [m].
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

/// A DensePair is two bodies over the same step.
struct DensePair {
  const RigidBody& a;
  const DenseMotion& motion_a;
  const RigidBody& b;
  const DenseMotion& motion_b;
  ContactSearch contact_search = {};

  [[nodiscard]] BodyGap gap(double share) const;
  /// Returns a bound of how fast their distance along `n` shrinks [m/s]. For bodies that are not a single
  /// convex shape, or for n = 0, it bounds the speed in any direction.
  [[nodiscard]] double closing(DVec3 n) const;
};

/// Returns the share of the step at which the bodies first overlap by `allowance` [m] (positive) more than at
/// the start, or nothing. This is conservative advancement (Mirtich 1996, "Impulse-based dynamic
/// simulation"). Along the normal of their gap the bodies approach no faster than closing(), so that no
/// contact is missed and none is found late. After 1000 rounds they count as being in contact.
[[nodiscard]] std::optional<double> first_contact(const DensePair& pair, double allowance);

/// Returns the share at which the bodies first touch, where the distance changes its sign between two of 17
/// sampled times, or nothing. The root is found to rounding by regula falsi in the form of Illinois (Dowell,
/// Jarratt 1971).
[[nodiscard]] std::optional<double> contact_root(const DensePair& pair, double epsilon);

/// Tests extruded silhouettes (the paper's 4.5.4; extruded() in lab/shape/extrusion.h). Returns false only if
/// the bodies cannot have come nearer than `reach` [m] within the step. It is exact for translation; a
/// rotating body gets a skin as thick as its points may leave the extrusion.
[[nodiscard]] bool may_collide(const DensePair& pair, double reach);

}  // namespace hooke::lab
