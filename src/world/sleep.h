#pragma once

#include "hooke/math.h"

#include "world/world_data.h"

namespace hooke::world {

/// Wakes the bodies that sleep and are touched, or will be within `dt`, by one that moves, and with each all
/// that it touches. Returns whether any woke; `awake` is then out of date.
bool wake_touched(WorldData& world, Real dt);

/// Puts to sleep the islands (bodies that touch each other or are hooked to each other) all of whose bodies
/// have been slower than 5 cm/s for half a second.
void put_to_sleep(WorldData& world, Real dt);

/// Wakes the bodies that sleep within a box [m], when something else there comes, goes or is let go.
void wake_within(const geometry::Box& box, state::Tables& tables);

/// Those near the points of an object.
void wake_near_points(const state::Deformable& object, state::Tables& tables);

/// Those near a body that nothing moves; who touches one that moves wakes by that.
void wake_near_body(std::uint32_t body, state::Tables& tables);

}  // namespace hooke::world
