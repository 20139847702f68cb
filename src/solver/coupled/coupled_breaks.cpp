/// Hooks and segments of ropes of a coupled group that give way, because they need more than they can take.

#include "base/assert.h"
#include "solver/coupled/coupled_group_solution.h"
#include "solver/coupled/coupled_tuning.h"
#include "solver/joint/hook_breaks.h"
#include "solver/rope/segment_breaks.h"

#include <algorithm>

namespace hooke::solver {

namespace {

/// Calls visit(row, index) for each segment of the group: its row, and its number in the group.
template <class Visit>
void for_each_segment(const CoupledGroup& group, const std::vector<RopeSystem>& rope_systems, Visit&& visit) {
  std::uint32_t index = 0;
  for (const std::uint32_t c : group.rope_systems) {
    const RopeSystem& rope_system = rope_systems[c];
    for (std::uint32_t i = 0; i + 1 < rope_system.node_count; ++i)
      visit(rope_system.first_segment + i, index++);
  }
  HOOKE_ASSERT(index == group.ropes.segments.size());
}

/// The segment of this row, if it gives way.
template <class List>
auto* find_giving(std::uint32_t row, List& giving) {
  const auto at =
      std::find_if(giving.begin(), giving.end(), [row](const GivingSegment& g) { return g.row == row; });
  return at != giving.end() ? &*at : nullptr;
}

bool gives_way_somewhere(const RopeSystem& rope_system, const std::vector<GivingSegment>& giving) {
  return std::any_of(giving.begin(), giving.end(), [&](const GivingSegment& g) {
    return g.row >= rope_system.first_segment &&
           g.row + 1 < rope_system.first_segment + rope_system.node_count;
  });
}

}  // namespace

void CoupledGroupSolution::apply_dashpots(const std::vector<RopeSystem>& rope_systems) {
  if (b_.giving.empty()) return;
  for_each_segment(b_, rope_systems, [&](std::uint32_t row, std::uint32_t index) {
    const GivingSegment* giving = find_giving(row, b_.giving);
    if (giving == nullptr) return;
    RopeSegment& segment = b_.ropes.segments[index];
    apply_dashpot(*giving, segment);
    for (RopeBend& bend : b_.ropes.bends) {
      if (bend.node == segment.a || bend.node == segment.a + 1) bend.stiffness = bend.damping = 0;
    }
  });
}

bool CoupledGroupSolution::set_segment_dashpots(const std::vector<RopeSystem>& rope_systems) {
  if (b_.giving.empty()) return false;
  bool set = false;
  for_each_segment(b_, rope_systems, [&](std::uint32_t row, std::uint32_t index) {
    GivingSegment* giving = find_giving(row, b_.giving);
    if (giving == nullptr) return;
    const RopeSegment& segment = b_.ropes.segments[index];
    const DVec3 parting = b_.ropes.nodes[segment.a + 1].u - b_.ropes.nodes[segment.a].u;
    set = set_dashpot(dot(segment.n, parting), dot(segment.n, segment.q), *giving) || set;
  });
  return set;
}

/// The segment that holds and needs most over what it can take, of equals the first. What breaks passes on
/// its strength while it does, so the rest of its rope may need a little more than that, and is spared.
WeakestSegment CoupledGroupSolution::weakest_segment(const std::vector<RopeSystem>& rope_systems) const {
  WeakestSegment weakest;
  if (b_.giving.size() >= kMostSegmentBreaks) return weakest;
  std::uint32_t index = 0;
  for (const std::uint32_t c : b_.rope_systems) {
    const RopeSystem& rope_system = rope_systems[c];
    const double most = h_ * static_cast<double>(t_.objects[rope_system.object].strength);
    const double spared = gives_way_somewhere(rope_system, b_.giving) ? kSparedNeed : 1;
    for (std::uint32_t i = 0; i + 1 < rope_system.node_count; ++i, ++index) {
      const RopeSegment& segment = b_.ropes.segments[index];
      const std::uint32_t row = rope_system.first_segment + i;
      const double impulse = dot(segment.n, segment.q);
      const double need = impulse / (spared * most);
      if (!(need > weakest.need) || !t_.segments.joins(row) || find_giving(row, b_.giving) != nullptr)
        continue;
      weakest.need = need;
      weakest.segment = {.row = row, .most = most, .needed_force = impulse / h_};
    }
  }
  return weakest;
}

bool CoupledGroupSolution::gives_way(int round, const std::vector<RopeSystem>& rope_systems) {
  b_.breakable.clear();
  for (const std::uint32_t row : b_.hooks) {
    if (t_.hooks[row].can_break() && !t_.hooks[row].broken) b_.breakable.push_back(row);
  }
  const bool can_snap = std::any_of(b_.rope_systems.begin(), b_.rope_systems.end(), [&](std::uint32_t c) {
    return t_.objects[rope_systems[c].object].strength < kRigid;
  });
  if ((b_.breakable.empty() && !can_snap) || !is_sound()) return false;
  const auto load_of = [&](std::uint32_t hook) -> HookLoad {
    const auto i = std::lower_bound(b_.hooks.begin(), b_.hooks.end(), hook) - b_.hooks.begin();
    HOOKE_ASSERT(i < std::ssize(b_.hooks) && b_.hooks[static_cast<std::size_t>(i)] == hook);
    DVec3 linear;
    DVec3 angular;
    for (std::uint32_t row = b_.first_row[i]; row < b_.first_row[i + 1]; ++row) {
      linear += b_.lambda[row] * b_.rows[row].n;
      angular += b_.lambda[row] * b_.rows[row].axis;
    }
    return {length(linear), length(angular)};
  };
  if (!can_snap) return give_way(h_, b_.breakable, round, t_.hooks, load_of);
  const bool set_hooks = set_dashpots(b_.breakable, t_.hooks, load_of);
  if (set_segment_dashpots(rope_systems) || set_hooks) return true;
  const double of_hooks = most_need(h_, b_.breakable, t_.hooks, load_of);
  const WeakestSegment weakest = weakest_segment(rope_systems);
  if (weakest.need > 1 && weakest.need >= of_hooks) {
    b_.giving.push_back(weakest.segment);
    return true;
  }
  if (!(of_hooks > 1)) return false;
  let_most_go(h_, b_.breakable, round, of_hooks, t_.hooks, load_of);
  return true;
}

void CoupledGroupSolution::break_segments(double time) {
  for (const GivingSegment& giving : b_.giving) {
    t_.segments.hold[giving.row] = state::SegmentHold::kBroken;
    t_.segments.needed_force[giving.row] = static_cast<Real>(giving.needed_force);
    t_.segments.broke_at[giving.row] = time;
  }
}

}  // namespace hooke::solver
