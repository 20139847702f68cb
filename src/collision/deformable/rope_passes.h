#pragma once

#include "collision/deformable/rope_contacts.h"

namespace hooke::collision {

/// Changes velocities so that no two center lines of ropes that touch ropes pass through each other within
/// the next `h` [s], whatever the solver has left. Nothing comes nearer than half the thickness, or than it
/// is now. Each pair that would come nearer gets the impulse that leaves it at that distance. What would
/// still pass after eight passes moves on as one, with the mean velocity of its points (rigid impact zones
/// after Provot 1997, "Collision and self-collision handling in cloth model dedicated to design garments").
/// Both keep momentum and take energy. The next substep removes the stretch of ropes that this causes.
void stop_rope_passes(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder, state::Tables& tables);

}  // namespace hooke::collision
