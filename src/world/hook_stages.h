#pragma once

#include "state/tables.h"
#include "world/world_data.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// These stages of the step concern hooks as a whole. The functions after them remove hooks together with
/// what they hold.

namespace hooke::world {

/// Groups hooks for the solver again, and lists the pairs that do not collide, if hooks came, went or
/// changed.
void refresh_hooks(WorldData& world);

/// Whether a hook joins two bodies and keeps them from colliding. It is valid after refresh_hooks.
[[nodiscard]] bool are_hooked(const WorldData& world, std::uint32_t body_a, std::uint32_t body_b);

/// Starts a step of substeps of length `h` [s] for bodies and hooks, and chooses how each hook is solved.
void prepare_joints(WorldData& world, Real h);

/// Solves hooks between bodies in a substep of length `h` [s], and removes their errors. Bodies on hooks that
/// had impacts are then moved by the velocity that their hooks left them.
void solve_joints(WorldData& world, Real h);

/// Removes the velocity that the removal of errors has added, sums impulses, and marks hooks that break. It
/// is called after bodies have moved.
void relax_joints(WorldData& world, Real h);

/// Removes the hooks that broke in this step, and lists them in order of time.
void drop_broken_hooks(WorldData& world);

/// Divides the ropes of which segments broke in this step, and lists these in order of time. Hooks within
/// such a segment go to the point at which they had the larger share; one that slides along the rope stays on
/// the part there, and goes if that part is a single point.
void drop_broken_segments(WorldData& world);

/// Divides a rope at segments, which hold no more. Hooks within them go where drop_broken_segments says.
void cut_segments(std::uint32_t object, std::span<const std::uint32_t> segments, state::Tables& tables);

/// Removes the hooks of bodies before the bodies themselves are removed. `goes` says by body row which are.
void remove_hooks_of(const std::vector<std::uint8_t>& goes, state::Tables& tables);

/// Does the same for the hooks of a rope, cloth, solid or group of particles, given by its row.
void remove_hooks_of_object(std::uint32_t object, state::Tables& tables);

/// Wakes the bodies at both ends of a hook.
void wake_ends(const state::Hook& hook, state::Bodies& bodies);

/// Distance of the ends of a hook from where it holds them [m]; see World::hook_gap.
[[nodiscard]] double gap_of(const state::Hook& hook, const state::Tables& tables);

}  // namespace hooke::world
