#pragma once

#include "hooke/world.h"

#include "parallel/thread_pool.h"
#include "world/world_data.h"

#include <cstdint>
#include <span>

/// \file
/// The stages of the step that concern bodies as a whole.

namespace hooke::world {

// Sizes below which a job stays on one thread.
inline constexpr int kBodyGrain = 128;
inline constexpr int kContactBlockGrain = 4;

/// Calls `kernel(rows)` for parts of the list of awake bodies.
template <class Kernel>
void for_bodies(WorldData& w, Kernel&& kernel) {
  parallel::for_ranges(
      *w.pool, static_cast<int>(w.frame.awake.size()), kBodyGrain, [&](parallel::Range part) {
        kernel(std::span<const std::uint32_t>(w.frame.awake).subspan(part.begin, part.count()));
      });
}

/// Calls `kernel(blocks)` for each color of the contacts; blocks of one color share no body that moves.
template <class Kernel>
void for_contact_colors(WorldData& w, Kernel&& kernel) {
  for (int c = 0; c < w.frame.body_contacts.color_count(); ++c) {
    const int first = w.frame.body_contacts.color_begin[c];
    parallel::for_ranges(*w.pool, w.frame.body_contacts.color_begin[c + 1] - first, kContactBlockGrain,
                         [&](parallel::Range blocks) {
                           kernel(parallel::Range{first + blocks.begin, first + blocks.end});
                         });
  }
}

/// Whether some body that may move was asleep when `awake` was filled.
[[nodiscard]] inline bool any_sleeps(const WorldData& world) {
  return world.frame.awake.size() < world.tables.moving_bodies.size();
}

/// Whether the bodies of two colliders may push each other, or report each other.
[[nodiscard]] bool may_collide(const WorldData& world, collision::ColliderPair pair);

/// Tells the broad phase the bounds of a body's colliders.
void enter_broad_phase(WorldData& world, std::uint32_t body);

/// Lists who is awake; boxes of all colliders that move, the pairs they make, and their manifolds. Wakes who
/// sleeps and is touched.
void find_body_contacts(WorldData& world, Real dt);

/// The broad phase with the boxes of all bodies where they are now, for queries between steps. Any number of
/// threads may ask for it at once: the first brings it up to date.
[[nodiscard]] const collision::BroadPhase& boxes_for_queries(WorldData& world);

/// How contacts are solved in this step, with substeps of length `h`; their rows, soft or of direct islands.
void prepare_body_contacts(WorldData& world, Real h);

/// Start of the substep of length `h` that begins at `time`: velocities of bodies on paths; forces, gravity
/// and gyroscopic turn of all others; contacts repeat what they did in the substep before, but in the
/// `first`.
void accelerate_bodies(WorldData& world, double time, Real h, bool first);

/// Impacts that bounce within the substep of length `h` that begins, in the order of their times.
void resolve_impacts(WorldData& world, Real h);

/// Contacts with bias: soft ones color after color, direct islands as a whole.
void solve_body_contacts(WorldData& world, Real h, bool first);

/// Moves bodies by a part of length `h` of a substep.
void move_bodies(WorldData& world, Real h);

/// After bodies have moved by a substep of length `h`: rows of refreshed contacts from where bodies are now.
void refresh_contacts(WorldData& world, Real h);

/// Contacts without bias, with friction.
void relax_body_contacts(WorldData& world);

/// End of a step of length `dt`: poses of bodies, and forces of hooks. Contacts and hooks of bodies in
/// quarantine carry nothing over that is not finite.
void finish_bodies(WorldData& world, Real dt);

/// After the last substep: what contacts did, for the next step and for those who ask.
void finish_body_contacts(WorldData& world);

/// Puts bodies whose state is not finite back to where the step began, at rest. Returns their number.
std::uint32_t quarantine_bodies(WorldData& world);

}  // namespace hooke::world
