#include "hooke/statics.h"

#include "base/float_environment.h"
#include "math/rotation.h"
#include "math/trig.h"

#include <cmath>
#include <numbers>

namespace hooke {

namespace {

/// An arm or a pull across the axis below this share of what it is a part of counts as none.
constexpr double kNoShare = 1e-9;

Result<void> check_axle(const AxleSolid& solid) {
  const auto refuse = [](const char* where, const char* what) {
    return Error{ErrorCode::kOutOfRange, where, what};
  };
  if (!is_finite(solid.center)) return refuse("center", "a coordinate is not finite");
  if (!is_finite(solid.point)) return refuse("point", "a coordinate is not finite");
  const double size = length(solid.axis);
  if (!(size > 0) || !std::isfinite(size)) return refuse("axis", "must have a length");
  if (!(solid.mass > 0) || !std::isfinite(solid.mass)) return refuse("mass", "must be positive and finite");
  if (!(solid.gravity > 0) || !std::isfinite(solid.gravity)) {
    return refuse("gravity", "must be positive and finite");
  }
  if (!(solid.friction_torque >= 0)) return refuse("friction_torque", "must be 0 or more");
  return {};
}

/// Turned by half a turn, from -pi to pi.
double opposite(double angle) {
  return angle > 0 ? angle - std::numbers::pi : angle + std::numbers::pi;
}

}  // namespace

Result<AxleRest> find_axle_rest(const AxleSolid& solid) {
  const base::FloatEnvironment environment;
  if (auto checked = check_axle(solid); !checked) return checked.error();
  const DVec3 axis = normalize(solid.axis);
  const DVec3 from_point = solid.center - solid.point;
  const DVec3 arm = from_point - dot(axis, from_point) * axis;
  const DVec3 pull = DVec3{0, -1, 0} + axis.y * axis;  // The part of gravity across the axis.
  AxleRest rest = {.arm = length(arm)};
  const double weight = solid.mass * solid.gravity;
  rest.largest_torque = weight * rest.arm * length(pull);
  rest.is_indifferent = !(rest.arm > kNoShare * length(from_point)) || !(length(pull) > kNoShare);
  if (rest.is_indifferent) {
    rest.largest_torque = 0;
    rest.held_within = std::numbers::pi;
    rest.stays = true;
    return rest;
  }
  const double across = dot(axis, cross(arm, pull));
  rest.stable_angle = math::atan2(across, dot(arm, pull));
  rest.unstable_angle = opposite(rest.stable_angle);
  rest.torque = weight * across;
  const double share = solid.friction_torque / rest.largest_torque;
  rest.held_within = share >= 1 ? std::numbers::pi : math::atan2(share, std::sqrt(1 - share * share));
  rest.stays = std::abs(rest.torque) <= solid.friction_torque || std::abs(rest.stable_angle) < kNoShare;
  rest.rotation = math::quaternion_of(rest.stable_angle * axis);
  rest.position = solid.point - rotate(rest.rotation, solid.point);
  return rest;
}

}  // namespace hooke
