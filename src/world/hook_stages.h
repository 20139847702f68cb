#pragma once

#include "state/tables.h"
#include "world/world_data.h"

#include <cstdint>
#include <vector>

/// \file
/// The stages of the step that concern hooks as a whole, and what happens to hooks when bodies go.

namespace hooke::world {

/// Groups of hooks for the solver, and the pairs that do not collide, if hooks or their bodies changed.
void refresh_hooks(WorldData& world);

/// Whether a hook that keeps them apart joins two bodies. Valid after refresh_hooks.
[[nodiscard]] bool are_hooked(const WorldData& world, std::uint32_t body_a, std::uint32_t body_b);

/// Bodies and hooks at the start of a step of substeps of length `h` [s]; which way each hook is solved.
void prepare_joints(WorldData& world, Real h);

/// Rows of hooks between bodies for a substep of length `h` [s], with their errors removed. What impacts did
/// to hooked bodies reaches those that they are hooked to.
void solve_joints(WorldData& world, Real h);

/// After bodies have moved: takes back the velocity that removing errors has added.
void relax_joints(WorldData& world, Real h);

/// Takes the hooks that broke in this step out of the world and lists them.
void drop_broken_hooks(WorldData& world);

/// Takes the hooks of bodies out of the world, before the bodies go. `goes` says which bodies do, by row.
void remove_hooks_of(const std::vector<std::uint8_t>& goes, state::Tables& tables);

/// The same of a rope, cloth, solid or group of particles, by its row.
void remove_hooks_of_object(std::uint32_t object, state::Tables& tables);

/// Wakes the bodies at both ends.
void wake_ends(const state::Hook& hook, state::Bodies& bodies);

/// How far the ends of a hook are from where it holds them [m]; see World::hook_gap.
[[nodiscard]] double gap_of(const state::Hook& hook, const state::Tables& tables);

}  // namespace hooke::world
