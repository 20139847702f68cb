#pragma once

#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Clamps of ropes: two or more neighboring points that one thing holds, by pins, by ball hooks to the world
/// or by ball hooks to the same body. The rope neither bends nor twists between them.

namespace hooke::solver {

/// What holds a particle.
struct Holder {
  bool holds = false;
  std::uint32_t body = state::HookPlace::kWorld;  ///< Row of the body.
};

/// Lists the holder of every particle. Where there are several the first counts, pins before hooks.
[[nodiscard]] std::vector<Holder> list_holders(const state::Tables& tables);

/// Calls visit(first, last, holder) for the nodes of each clamp of a rope.
template <class Visit>
void for_each_clamp(const state::Deformable& rope, const std::vector<Holder>& holders, Visit&& visit) {
  const Holder* of = &holders[rope.particles.first];
  const std::uint32_t count = rope.particles.count;
  for (std::uint32_t first = 0, next = 0; first < count; first = next) {
    next = first + 1;
    while (of[first].holds && next < count && of[next].holds && of[next].body == of[first].body) ++next;
    if (next - first > 1) visit(first, next - 1, of[first]);
  }
}

/// Notes in Segments::clamped which segments lie within clamps.
void note_clamps(const std::vector<Holder>& holders, state::Tables& tables);

}  // namespace hooke::solver
