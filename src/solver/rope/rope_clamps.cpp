#include "solver/rope/rope_clamps.h"

#include "base/assert.h"

#include <algorithm>

namespace hooke::solver {

using state::HookPlace;

std::vector<Holder> list_holders(const state::Tables& t) {
  std::vector<Holder> holders(static_cast<std::size_t>(t.particles.count()));
  for (const state::Pin& pin : t.pins) holders[pin.particle] = {true, HookPlace::kWorld};
  for (const state::Hook& hook : t.hooks) {
    const HookPlace& point = hook.point_end();
    const HookPlace& other = hook.other_end();
    if (hook.kind != HookKind::kBall || hook.broken || point.particle_count != 1 || other.is_point())
      continue;
    Holder& holder = holders[point.particle[0]];
    if (!holder.holds) holder = {true, other.body};
  }
  return holders;
}

void note_clamps(const std::vector<Holder>& holders, state::Tables& t) {
  HOOKE_ASSERT(holders.size() == t.particles.position.size());
  std::fill(t.segments.clamped.begin(), t.segments.clamped.end(), std::uint8_t{0});
  for (const state::Deformable& rope : t.objects) {
    if (rope.kind != PointRef::Kind::kRope) continue;
    for_each_clamp(rope, holders, [&](std::uint32_t from, std::uint32_t to, const Holder&) {
      for (std::uint32_t i = from; i < to; ++i) t.segments.clamped[rope.segments.first + i] = 1;
    });
  }
}

}  // namespace hooke::solver
