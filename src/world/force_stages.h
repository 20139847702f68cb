#pragma once

#include "world/world_data.h"

namespace hooke::world {

/// Changes the velocities of what explosions reach whose time lies within the `dt` [s] that begins now.
/// Sleeping bodies that they reach wake.
void set_off_explosions(WorldData& world, double dt);

/// Begins a step: finds out whether bodies need new forces in each substep, and stores the forces that the
/// user gave for the whole step.
void begin_body_forces(WorldData& world);

/// Sets the force and torque on bodies for the substep of length `h` [s] that begins at `time` [s]: those of
/// the user for the step, of fields, air and dipoles, and of the user's force laws. Twisted ropes turn the
/// bodies that clamp them by an impulse.
void force_bodies(WorldData& world, double time, Real h);

}  // namespace hooke::world
