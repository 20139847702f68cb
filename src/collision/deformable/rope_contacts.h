#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "collision/broad_phase/broad_phase.h"
#include "parallel/thread_pool.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Contacts of ropes with ropes and with themselves: segment against segment, as capsules.
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
  BroadPhase broad_phase;  ///< Boxes of segments, by their rows.
  std::uint64_t revision = 0;
  std::vector<ColliderPair> pairs;
  std::vector<state::RopeContact> contacts;  ///< The contacts found; then those of the step before.
  std::vector<std::uint32_t> ropes;          ///< Rows of objects that touch ropes.
  // These columns are indexed by the row of a segment.
  std::vector<std::uint32_t> object_of;
  std::vector<Real> arc;  ///< Rest length along the rope to the segment's start [m].
  // These columns are indexed by the row of a particle and belong to the last search.
  std::vector<Vec3> start;   ///< Position at that search [m].
  std::vector<Real> margin;  ///< Distance from there within which the rows found are complete [m].
  base::DisjointSets zones;  ///< Sets of points that stop_rope_passes moves as one.
  std::vector<Zone> zone;    ///< Data of each zone, at its root.
  Vec3 drift = {};           ///< Mean velocity of all; displacements are relative to it [m/s].
  Real elapsed = Real(0);    ///< Time since that search [s].
};

/// Replaces `rope_contacts` by a row for each two segments of ropes that touch ropes and may meet within `dt`
/// [s]. Their boxes overlap, each grown by the radius, once more as a margin, and by the displacements at its
/// speed and by gravity. What was known of a pair is kept. Segments that follow each other have no row. Other
/// neighbors along one rope, up to an arc of pi radius between them, have an `adjacent` row, because a rope
/// in its tightest bend comes as near to itself as that.
void find_rope_contacts(parallel::ThreadPool& pool, Real dt, RopeContactFinder& finder,
                        state::Tables& tables);

/// Finds the nearest points, normal and gap of each row from where the segments are now. If they meet within
/// the next `h` [s], it uses the positions at that time. A row acts where no neighbor along either rope is
/// nearer. Otherwise it hands its forces over to that neighbor: a contact slides along a rope from segment to
/// segment. The rows are searched again if something left its margin.
void update_rope_contacts(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder,
                          state::Tables& tables);

/// Searches the rows again if something may, within `h` [s], get to where its rows are not known. Returns
/// whether it did.
bool renew_rope_contacts(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder,
                         state::Tables& tables);

}  // namespace hooke::collision
