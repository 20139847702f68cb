#pragma once

#include "hooke/world.h"

#include "parallel/thread_pool.h"
#include "world/world_data.h"

#include <cstdint>
#include <span>

/// \file
/// These stages of the step concern bodies as a whole; docs/step.md lists them in the order of their calls.

namespace hooke::world {

// Jobs of fewer bodies, or blocks of contacts, stay on one thread.
inline constexpr int kBodyGrain = 128;
inline constexpr int kContactBlockGrain = 4;

/// Calls `kernel(rows)` for parts of the list of awake bodies, on several threads.
template <class Kernel>
void for_bodies(WorldData& w, Kernel&& kernel) {
  parallel::for_ranges(
      *w.pool, static_cast<int>(w.frame.awake.size()), kBodyGrain, [&](parallel::Range part) {
        kernel(std::span<const std::uint32_t>(w.frame.awake).subspan(part.begin, part.count()));
      });
}

/// Calls `kernel(blocks)` for each color of the contacts. Blocks of one color share no body that they write.
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

/// Whether some body that is not static was asleep when `awake` was filled.
[[nodiscard]] inline bool any_sleeps(const WorldData& world) {
  return world.frame.awake.size() < world.tables.moving_bodies.size();
}

/// Whether the bodies of two colliders may push each other, or one may see the other as a sensor.
[[nodiscard]] bool may_collide(const WorldData& world, collision::ColliderPair pair);

/// Enters the boxes of a body's colliders into the broad phase.
void enter_broad_phase(WorldData& world, std::uint32_t body);

/// Lists the bodies that are awake, finds the pairs of colliders that may meet within `dt` [s], and makes
/// their manifolds. Sleeping bodies that are touched wake.
void find_body_contacts(WorldData& world, Real dt);

/// Returns the broad phase with the boxes of all bodies where they are now, for queries between steps. Any
/// number of threads may call it at once; the first call after a change updates the boxes.
[[nodiscard]] const collision::BroadPhase& boxes_for_queries(WorldData& world);

/// Chooses how contacts are solved in this step of substeps of length `h` [s], and makes the rows of soft and
/// direct contacts.
void prepare_body_contacts(WorldData& world, Real h);

/// Starts the substep of length `h` [s] that begins at `time` [s]. Bodies on paths get the velocity of their
/// path. Forces, gravity and free rotation act on all others, and so do the impulses of contacts of the
/// substep before. In the `first` substep of a step these impulses are those that the step before stored.
void accelerate_bodies(WorldData& world, double time, Real h, bool first);

/// Solves the impacts with restitution within the coming substep of length `h` [s], in order of time.
void resolve_impacts(WorldData& world, Real h);

/// Solves contacts with bias: soft ones color by color, direct islands as a whole.
void solve_body_contacts(WorldData& world, Real h, bool first);

/// Moves bodies by `h` [s]. It is called after each particle substep, with its length.
void move_bodies(WorldData& world, Real h);

/// Makes the rows of refreshed and load-bearing contacts again where bodies are now. It is called when bodies
/// have moved by the whole substep of length `h` [s].
void refresh_contacts(WorldData& world, Real h);

/// Solves soft contacts again, without bias and with friction.
void relax_body_contacts(WorldData& world);

/// Ends a step of length `dt` [s]: poses of bodies follow their motion, and hooks get their mean forces. If
/// some body was quarantined, contacts and hooks lose impulses that are not finite. Returns how many bodies
/// turn so fast that their angular momentum is not finite; they are stopped.
std::uint32_t finish_bodies(WorldData& world, Real dt);

/// Stores the impulses of contacts after the last substep, for the warm start of the next step and for
/// reports. Decides which islands are direct in the next step.
void finish_body_contacts(WorldData& world);

/// Puts bodies whose state is not finite back to where the step began, at rest. Returns how many.
std::uint32_t quarantine_bodies(WorldData& world);

}  // namespace hooke::world
