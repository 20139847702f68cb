#include "world/hook_stages.h"

#include "base/assert.h"
#include "solver/body/body_motion.h"
#include "solver/contact/impacts.h"
#include "solver/routes.h"
#include "state/rope_chains.h"
#include "world/body_stages.h"
#include "world/object_edits.h"

#include <algorithm>
#include <numeric>

namespace hooke::world {

namespace {

using state::Hook;
using state::HookPlace;

std::pair<std::uint32_t, std::uint32_t> pair_of(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Sorts events by time and leaves those of one time in their order. Breaks are few, and std::stable_sort
/// would allocate, so this is an insertion sort.
template <class Event>
void sort_by_time(std::vector<Event>& events) {
  for (auto at = events.begin(); at != events.end(); ++at) {
    const auto place = std::upper_bound(events.begin(), at, at->time,
                                        [](double time, const Event& e) { return time < e.time; });
    std::rotate(place, at, at + 1);
  }
}

}  // namespace

void refresh_hooks(WorldData& world) {
  state::Tables& t = world.tables;
  world.derived.hooked.resize(t.bodies.motion.size());
  world.derived.supports.support_role.resize(t.bodies.motion.size());
  world.derived.supports.ground_load.resize(t.bodies.motion.size());
  if (world.derived.joints_revision == t.hook_revision) return;
  world.derived.joints_revision = t.hook_revision;
  solver::build_joints(t.hooks, t.bodies, solver::kArticulationBudget, world.derived.joints);
  solver::set_joint_routes(world.derived.joints, t.hooks);
  solver::find_supporting_bodies(world.derived.joints, t.bodies, t.hooks, world.derived.supports);
  std::fill(world.derived.hooked.begin(), world.derived.hooked.end(), std::uint8_t{0});
  world.derived.hooked_pairs.clear();
  for (const Hook& hook : t.hooks) {
    for (const std::uint32_t body : {hook.a.body, hook.b.body}) {
      if (body != HookPlace::kWorld) world.derived.hooked[body] = 1;
    }
    if (!hook.collide) world.derived.hooked_pairs.push_back(pair_of(hook.a.body, hook.b.body));
  }
  std::sort(world.derived.hooked_pairs.begin(), world.derived.hooked_pairs.end());
  world.derived.hooked_begin.assign(t.bodies.motion.size() + 1, 0);
  for (const auto& [body, other] : world.derived.hooked_pairs) {
    if (body != HookPlace::kWorld) ++world.derived.hooked_begin[body + 1];
  }
  std::partial_sum(world.derived.hooked_begin.begin(), world.derived.hooked_begin.end(),
                   world.derived.hooked_begin.begin());
  HOOKE_ASSERT(world.derived.hooked_begin.back() <= world.derived.hooked_pairs.size());
}

bool are_hooked(const WorldData& world, std::uint32_t body_a, std::uint32_t body_b) {
  const auto pair = pair_of(body_a, body_b);
  if (pair.first + 1 >= world.derived.hooked_begin.size()) return false;
  const auto begin = world.derived.hooked_pairs.begin();
  HOOKE_ASSERT(world.derived.hooked_begin[pair.first] <= world.derived.hooked_begin[pair.first + 1]);
  return std::binary_search(begin + world.derived.hooked_begin[pair.first],
                            begin + world.derived.hooked_begin[pair.first + 1], pair);
}

void prepare_joints(WorldData& world, Real h) {
  state::Tables& t = world.tables;
  for_bodies(world, [&](auto rows) { solver::prepare_bodies(rows, t.bodies); });
  solver::prepare_joints(*world.pool, h, t.hooks, t.bodies, world.derived.joints);
  solver::choose_joint_routes(world.derived.joints, t.hooks);
}

void solve_joints(WorldData& world, Real h) {
  state::Tables& t = world.tables;
  solver::solve_joints(*world.pool, h, t.hooks, t.bodies, world.derived.joints);
  solver::propagate_impacts(t.bodies, world.frame.impacts);
}

void relax_joints(WorldData& world, Real h) {
  solver::relax_joints(*world.pool, h, world.tables.hooks, world.tables.bodies, world.derived.joints);
}

void drop_broken_hooks(WorldData& world) {
  state::Tables& t = world.tables;
  std::vector<BreakEvent>& breaks = world.last_step.events.breaks;
  world.last_step.broken_hooks.clear();
  breaks.clear();
  for (const Hook& hook : t.hooks) {
    if (!hook.broken) continue;
    world.last_step.broken_hooks.push_back(t.hook_slots.id_of(hook.slot));
    breaks.push_back(
        {world.last_step.broken_hooks.back(), hook.needed_force, hook.needed_torque, t.time + hook.held});
  }
  sort_by_time(breaks);
  for (const HookId id : world.last_step.broken_hooks) remove_row(t.hook_slots, id, t.hooks);
  if (!world.last_step.broken_hooks.empty()) ++t.hook_revision;
}

namespace {

/// Removes the hooks for which `goes` is true and wakes what they held. The others keep their order.
template <class Goes>
void remove_hooks_if(state::Tables& t, Goes&& goes) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < t.hooks.size(); ++i) {
    Hook& hook = t.hooks[i];
    if (goes(hook)) {
      wake_ends(hook, t.bodies);
      t.hook_slots.move(hook.slot, t.hook_slots.kNone);
      continue;
    }
    if (kept != i) {
      t.hook_slots.move(hook.slot, kept);
      t.hooks[kept] = std::move(hook);
    }
    ++kept;
  }
  if (kept == t.hooks.size()) return;
  t.hooks.resize(kept);
  ++t.hook_revision;
}

/// Removes the hooks with an end for which `holds` is true.
template <class Holds>
void remove_hooks(state::Tables& t, Holds&& holds) {
  remove_hooks_if(t, [&](const Hook& hook) { return holds(hook.a) || holds(hook.b); });
}

/// Puts a hook that slides along a rope back onto a segment that holds, and returns whether there is one.
bool stay_on_rope(const state::Tables& t, HookPlace& place) {
  const state::Deformable& rope = t.objects[place.object];
  const std::uint32_t node = place.particle[0] - rope.particles.first;
  const auto goes_on = [&](std::uint32_t i) { return state::goes_on(rope, t.segments, i); };
  if (goes_on(node)) return true;
  const bool before = node > 0 && goes_on(node - 1);
  const bool behind = goes_on(node + 1);
  if (!before && !behind) return false;
  const bool back = before && (!behind || place.weight[0] >= place.weight[1]);
  place.particle[0] = rope.particles.first + (back ? node - 1 : node + 1);
  place.particle[1] = place.particle[0] + 1;
  place.weight[0] = back ? Real(0) : Real(1);
  place.weight[1] = back ? Real(1) : Real(0);
  return true;
}

/// Gives the hooks of a rope places that its parts have.
void move_hooks_off_gaps(std::uint32_t object, state::Tables& t) {
  const state::Deformable& rope = t.objects[object];
  for (Hook& hook : t.hooks) {
    for (HookPlace* end : {&hook.a, &hook.b}) {
      if (!end->is_point() || end->object != object) continue;
      if (hook.kind != HookKind::kRopeSlide || end != &hook.a) {
        state::leave_gap(rope, t.segments, *end);
      } else if (!stay_on_rope(t, *end)) {
        end->particle_count = 1;  // A single point is nothing to slide along: the hook goes, below.
      }
    }
  }
  const auto is_lost = [&](const Hook& hook) {
    return hook.kind == HookKind::kRopeSlide && hook.a.object == object && hook.a.particle_count == 1;
  };
  remove_hooks_if(t, is_lost);
  ++t.hook_revision;
}

/// Notes that a segment of a rope is gone, so that the rope goes on as two.
void open_gap(state::Deformable& rope, std::uint32_t segment, state::Segments& segments) {
  const std::uint32_t row = rope.segments.first + segment;
  segments.hold[row] = state::SegmentHold::kGone;
  segments.tension[row] = Real(0);
  segments.limited[row] = 0;
  rope.has_gaps = true;
}

/// Notes a segment that broke.
void divide(std::uint32_t object, std::uint32_t segment, state::Tables& t,
            std::vector<RopeBreakEvent>& breaks) {
  state::Deformable& rope = t.objects[object];
  const std::uint32_t row = rope.segments.first + segment;
  const std::uint32_t particle = rope.particles.first + segment;
  const DVec3 ends = vector_cast<double>(t.particles.position[particle].x) +
                     vector_cast<double>(t.particles.position[particle + 1].x);
  breaks.push_back({.rope = t.rope_slots.id_of(rope.slot),
                    .segment = segment,
                    .point = rope.origin + 0.5 * ends,
                    .force = t.segments.needed_force[row],
                    .time = t.segments.broke_at[row]});
  open_gap(rope, segment, t.segments);
}

}  // namespace

void cut_segments(std::uint32_t object, std::span<const std::uint32_t> segments, state::Tables& t) {
  state::Deformable& rope = t.objects[object];
  for (const std::uint32_t segment : segments) open_gap(rope, segment, t.segments);
  move_hooks_off_gaps(object, t);
  state::note_change(t, rope);
}

void drop_broken_segments(WorldData& world) {
  state::Tables& t = world.tables;
  std::vector<RopeBreakEvent>& breaks = world.last_step.events.rope_breaks;
  breaks.clear();
  for (std::uint32_t object = 0; object < t.objects.size(); ++object) {
    state::Deformable& rope = t.objects[object];
    if (rope.kind != PointRef::Kind::kRope || !(rope.strength < kRigid)) continue;
    const std::size_t before = breaks.size();
    for (std::uint32_t i = 0; i < rope.segments.count; ++i) {
      if (t.segments.hold[rope.segments.first + i] == state::SegmentHold::kBroken)
        divide(object, i, t, breaks);
    }
    if (breaks.size() == before) continue;
    move_hooks_off_gaps(object, t);
    state::note_change(t, rope);
  }
  sort_by_time(breaks);
}

void remove_hooks_of(const std::vector<std::uint8_t>& goes, state::Tables& t) {
  HOOKE_ASSERT(goes.size() == t.bodies.traits.size());
  remove_hooks(t, [&](const HookPlace& end) { return end.body != HookPlace::kWorld && goes[end.body] != 0; });
}

void remove_hooks_of_object(std::uint32_t object, state::Tables& t) {
  remove_hooks(t, [&](const HookPlace& end) { return end.is_point() && end.object == object; });
}

void wake_ends(const Hook& hook, state::Bodies& bodies) {
  for (const std::uint32_t body : {hook.a.body, hook.b.body}) {
    if (body != HookPlace::kWorld) state::wake(bodies, body);
  }
}

double gap_of(const Hook& hook, const state::Tables& t) {
  solver::JointBody a = solver::joint_end(t, hook.a);
  if (hook.kind == HookKind::kRopeSlide) a.rotation = solver::slide_rotation(t, hook);
  return solver::joint_gap(hook, a, solver::joint_end(t, hook.b));
}

}  // namespace hooke::world
