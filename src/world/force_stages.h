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

/// Reads the wind at each particle that feels air, at `time` [s].
void read_wind(WorldData& world, double time);

/// Applies the forces of a particle substep of length `h` [s] that ends at `time` [s]: wind on triangles and
/// segments; fields, drag, liquids and external forces; gravity; the user's force laws. It pushes points of
/// ropes with repulsion apart, and gives pinned particles the velocity that brings them to where their pins
/// are at `time`. The wind's load on triangles is computed in the `first` particle substep of a substep, and
/// the same force acts in all of them.
void accelerate_particles(WorldData& world, double time, Real h, bool first);

}  // namespace hooke::world
