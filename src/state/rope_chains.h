#pragma once

#include "state/hooks.h"
#include "state/objects.h"
#include "state/springs.h"

#include <algorithm>
#include <cstdint>

/// \file
/// Chains of ropes: the parts between segments that are gone. A rope of which none is gone is one chain. A
/// chain may be a single node.

namespace hooke::state {

/// Whether a node of a rope and the next one belong to one chain.
[[nodiscard]] inline bool goes_on(const Deformable& rope, const Segments& segments, std::uint32_t node) {
  return node < rope.segments.count && segments.hold[rope.segments.first + node] != SegmentHold::kGone;
}

/// Calls visit(first, count) with the nodes of each chain, counted along the rope.
template <class Visit>
void for_each_chain(const Deformable& rope, const Segments& segments, Visit&& visit) {
  std::uint32_t first = 0;
  for (std::uint32_t i = 0; rope.has_gaps && i < rope.segments.count; ++i) {
    if (goes_on(rope, segments, i)) continue;
    visit(first, i + 1 - first);
    first = i + 1;
  }
  visit(first, rope.particles.count - first);
}

/// The first particle of the chain that a particle of a rope belongs to.
[[nodiscard]] inline std::uint32_t first_of_chain(const Deformable& rope, const Segments& segments,
                                                  std::uint32_t particle) {
  if (!rope.has_gaps) return rope.particles.first;
  std::uint32_t node = particle - rope.particles.first;
  while (node > 0 && goes_on(rope, segments, node - 1)) --node;
  return rope.particles.first + node;
}

/// A place within a segment that is gone belongs to the node that has the larger share of it.
inline void leave_gap(const Deformable& rope, const Segments& segments, HookPlace& place) {
  if (!rope.has_gaps || place.particle_count != 2) return;
  const std::uint32_t node = std::min(place.particle[0], place.particle[1]) - rope.particles.first;
  if (node >= rope.segments.count || segments.joins(rope.segments.first + node)) return;
  if (place.weight[1] > place.weight[0]) place.particle[0] = place.particle[1];
  place.particle_count = 1;
  place.weight = {Real(1)};
}

}  // namespace hooke::state
