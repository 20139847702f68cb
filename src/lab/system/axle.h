#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <cstdint>
#include <optional>

/// \file
/// Bodies that only turn about an axis: wheels.

namespace hooke::lab {

/// What a hinge between a body and the world leaves of the body's motion, where the axis goes through its
/// center of mass: with the moment of inertia I about the unit axis a, and a torque M,
///
///     center = const,   omega = s a,   I s' = a.M
///
/// whatever the other moments are; they and all forces go into the bearing.
struct Axle {
  DVec3 axis = {};     ///< Unit, in the world.
  double inertia = 0;  ///< About it [kg m^2].
};

/// The axle of a dynamic body; nothing without one. A hinge is none that has limits, a motor or a spring, or
/// is farther than 1e-4 of the body's radius from its center of mass, or has a body on its other side; nor is
/// one of several hooks of a body.
[[nodiscard]] std::optional<Axle> axle_of(const state::Tables& tables, std::uint32_t body);

/// Whether any hook holds the body.
[[nodiscard]] bool is_hooked(const state::Tables& tables, std::uint32_t body);

}  // namespace hooke::lab
