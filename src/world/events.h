#pragma once

#include "world/world_data.h"

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

}  // namespace hooke::world
