#pragma once

#include "collision/deformable/rope_contacts.h"

namespace hooke::collision {

/// Changes velocities so that no two lines of ropes that touch ropes pass through each other within the next
/// `h` [s], whatever their solution has left: nothing comes nearer than half the thickness, or than it is.
/// Pair after pair gets the impulse that leaves it at that distance where the two would have come so near;
/// after eight passes what still would pass goes on as one, with the mean velocity of its points (rigid
/// impact zones after Provot 1997, "Collision and self-collision handling in cloth model dedicated to design
/// garments"). Both keep momentum and take energy. What ropes are stretched by is taken back in the next
/// substep.
void stop_rope_passes(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder, state::Tables& tables);

}  // namespace hooke::collision
