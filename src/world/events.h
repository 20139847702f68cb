#pragma once

#include "world/world_data.h"

/// \file
/// What users are told about a step: contacts, hits and visitors of the bodies that ask, and sleep.

namespace hooke::world {

/// Before contacts are solved: how fast the bodies that ask for hits come together, where they are near.
void note_closing_pairs(WorldData& world, Real dt);

/// Fills `events`, once everything has moved; writes `touches`, `visits` and the bodies' `slept`.
void gather_events(WorldData& world);

/// Nothing has happened. Keeps the memory.
void clear_events(Events& events);

}  // namespace hooke::world
