#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "collision/broad_phase/broad_phase.h"
#include "parallel/thread_pool.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Where ropes touch ropes and themselves: segment against segment, as capsules.
/// docs/decisions/0024-ropes-that-touch.md.

namespace hooke::collision {

/// Memory of find_rope_contacts and update_rope_contacts.
struct RopeContactFinder {
  struct Zone {
    DVec3 momentum = {};
    double mass = 0;
    std::uint32_t count = 0;
    bool held = false;
  };
  BroadPhase broad_phase;  ///< Of segments, by their rows.
  std::uint64_t revision = 0;
  std::vector<ColliderPair> pairs;
  std::vector<state::RopeContact> contacts;  ///< Those found; then those of the step before.
  std::vector<std::uint32_t> ropes;          ///< Rows of objects that touch ropes.
  // Of each segment's row.
  std::vector<std::uint32_t> object_of;
  std::vector<Real> arc;  ///< Along its rope to its start, at rest [m].
  // Of each particle's row, when contacts were found.
  std::vector<Vec3> start;   ///< Where it was [m].
  std::vector<Real> margin;  ///< How far from there the rows found are all there are [m].
  base::DisjointSets zones;  ///< Points that stop_rope_passes lets go on as one.
  std::vector<Zone> zone;    ///< At the root of each.
  Vec3 drift = {};           ///< Mean velocity of all; ways are against it [m/s].
  Real elapsed = Real(0);    ///< Since then [s].
};

/// Replaces `rope_contacts` by a row for each two segments of ropes that touch ropes which may meet within
/// `dt` [s]: whose boxes overlap, each grown by the radius, once more as a margin, the way at its speed and
/// that of gravity. What was known of a pair is kept. Neighbors along one rope have none, up to an arc of pi
/// radius between them: as near as that a rope comes to itself in the tightest bend.
void find_rope_contacts(parallel::ThreadPool& pool, Real dt, RopeContactFinder& finder,
                        state::Tables& tables);

/// Places, normal and gap of each row, where the segments are now; where they meet within the next `h` [s],
/// those of then. A row holds where no neighbor along either rope is nearer, and hands its forces over to
/// that one otherwise: a contact slides along a rope from segment to segment. Finds rows anew where something
/// left its margin.
void update_rope_contacts(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder,
                          state::Tables& tables);

/// Finds rows anew if something may be by `h` [s] from now where its rows are not known. True if it did.
bool renew_rope_contacts(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder,
                         state::Tables& tables);

}  // namespace hooke::collision
