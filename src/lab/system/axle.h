#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <cstdint>
#include <optional>

/// \file
/// Describes bodies that only rotate about a fixed axis: wheels.

namespace hooke::lab {

/// An axle is what a hinge between a body and the world leaves of the body's motion, if the axis goes through
/// its center of mass. With the moment of inertia I about the unit axis a, and a torque M,
///
/// center = const,   omega = s a,   I s' = a.M
///
/// whatever the other moments are. The bearing takes them and all forces.
struct Axle {
  DVec3 axis = {};     ///< Unit vector, in the world.
  double inertia = 0;  ///< Moment about the axis [kg m^2].
};

/// Returns the axle of a dynamic body, or nothing. A hinge makes no axle if it has limits, a motor or a
/// spring, if it is farther than 1e-4 of the body's radius from the center of mass, if another body is at its
/// other end, or if the body has several hooks.
[[nodiscard]] std::optional<Axle> axle_of(const state::Tables& tables, std::uint32_t body);

/// Tells whether any hook holds the body.
[[nodiscard]] bool is_hooked(const state::Tables& tables, std::uint32_t body);

}  // namespace hooke::lab
