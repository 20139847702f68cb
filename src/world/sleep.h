#pragma once

#include "hooke/math.h"

#include "world/world_data.h"

namespace hooke::world {

/// Wakes the sleeping bodies that a moving body touches, or will touch within `dt` [s], and through these all
/// that they touch or hang together with. Particles that hit a sleeping body wake it, too, and so do
/// deformables that push it with more than a tenth of its weight. Returns whether any woke; `awake` is then
/// out of date.
bool wake_touched(WorldData& world, Real dt);

/// Puts islands to sleep: bodies that touch each other or are hooked to each other, and have all been slower
/// than 5 cm/s for half a second. Bodies hooked to deformables never sleep, nor do those that deformables
/// push with more than a tenth of their weight. `dt` [s] is the length of the step.
void put_to_sleep(WorldData& world, Real dt);

/// Wakes the sleeping bodies within a box [m]. It is called when something else there comes, goes, or is
/// pinned or unpinned.
void wake_within(const geometry::Box& box, state::Tables& tables);

/// Wakes the sleeping bodies near the points of an object.
void wake_near_points(const state::Deformable& object, state::Tables& tables);

/// Wakes the sleeping bodies near a static or kinematic body that was added or placed. A dynamic one needs no
/// call, because its contacts wake what it touches.
void wake_near_body(std::uint32_t body, state::Tables& tables);

}  // namespace hooke::world
