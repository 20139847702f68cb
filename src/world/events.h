#pragma once

#include "world/world_data.h"

#include <span>

/// \file
/// These stages gather what a step reports: contacts, hit events, visitors of sensors, and sleep.

namespace hooke::world {

/// Lists the closing pairs of bodies that ask for hit events. It is called before contacts are solved,
/// because these change the speeds.
void note_closing_pairs(WorldData& world, Real dt);

/// Fills `events` once everything has moved. Writes `touches`, `visits` and the bodies' `slept`.
void gather_events(WorldData& world);

/// Empties all lists but keeps their memory.
void clear_events(Events& events);

// What follows sums what deformables and what they touch give each other in a step, for events and forces. It
// only reads, and does nothing unless some description asks for contacts or hits.

/// Begins a step of `dt` [s].
void begin_deformable_touches(WorldData& world, double dt);

/// Notes how fast things are about to meet within a particle substep of `h` [s]. It is called when forces
/// have acted and before anything stops.
void note_closing_deformables(WorldData& world, Real h);

/// Adds what `passes` gave, which were solved in this particle substep.
void add_pass_impulses(WorldData& world, Real h, std::span<const state::ElementContact> passes);

/// Adds what all other contacts gave in this particle substep, when points have moved.
void add_touch_impulses(WorldData& world, Real h);

/// Fills the events of deformables, and what the queries of contacts tell.
void gather_deformable_events(WorldData& world);

/// Forgets what the queries of contacts tell.
void clear_deformable_contacts(LastStep& last_step);

}  // namespace hooke::world
