#pragma once

#include "solver/solid/backed_bodies.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Finds what backs the bodies that touch stiff solids, and passes on what solids give them.

namespace hooke::solver {

/// Sums up what stiff solids pressed bodies with in the last particle substep. `stiff` says which objects
/// are stiff.
void list_carried_forces(const state::Tables& tables, const std::vector<std::uint8_t>& stiff,
                         std::vector<CarriedForce>& carried);

/// Gives bodies the impulses of these forces in a substep of `h` [s], before contacts and hooks of bodies are
/// solved, which so bear what solids pressed with.
void push_carried(std::span<const CarriedForce> carried, Real h, state::Bodies& bodies);

/// Lists the bodies that touch stiff solids or are hooked to them, with what backs them, in a particle
/// substep of `h` [s]. `hooked` are bodies of hooks at stiff solids.
void find_backing(const state::Tables& tables, const std::vector<std::uint8_t>& stiff,
                  std::span<const CarriedForce> carried, std::span<const std::uint32_t> hooked, Real h,
                  BackedBodies& backed);

/// Moves bodies by the difference between the impulses that solids give and those that were expected, with
/// what backs them.
void spread_impulses(BackedBodies& backed, state::Bodies& bodies);

}  // namespace hooke::solver
