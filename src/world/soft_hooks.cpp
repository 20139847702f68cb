#include "world/soft_hooks.h"

#include "base/assert.h"
#include "build/hook_ends.h"
#include "collision/deformable/particle_contacts.h"
#include "math/rotation.h"
#include "math/trig.h"
#include "state/body_frames.h"
#include "world/hook_stages.h"
#include "world/object_edits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace hooke::world {

namespace {

using state::Hook;
using state::HookPlace;
using state::Tables;
using DQuat = Quaternion<double>;
using math::in_double;
using math::in_real;

/// A helper is this share of the body's radius away from the place of its hook, or nearer where the body
/// ends.
constexpr double kHelperReach = 0.5;

/// Rotation of the frame that the axes of an end are given in.
DQuat frame_rotation(const HookPlace& end, const Tables& t) {
  if (end.is_point() || end.body == HookPlace::kWorld) return {0, 0, 0, 1};
  return in_double(t.bodies.rotation[end.body]);
}

/// Where an end is in the world [m].
DVec3 place_of(const HookPlace& end, const Tables& t) {
  if (end.is_point()) {
    DVec3 place = t.objects[end.object].origin;
    for (std::uint32_t i = 0; i < end.particle_count; ++i) {
      place +=
          static_cast<double>(end.weight[i]) * vector_cast<double>(t.particles.position[end.particle[i]].x);
    }
    return place;
  }
  if (end.body == HookPlace::kWorld) return end.anchor;
  return t.bodies.center[end.body] + rotate(frame_rotation(end, t), end.anchor);
}

/// Puts the anchor of an end that is no point at a place in the world.
void put_anchor(DVec3 place, const Tables& t, HookPlace& end) {
  end.anchor = place;
  if (end.body == HookPlace::kWorld) return;
  end.anchor = rotate(conjugate(frame_rotation(end, t)), place - t.bodies.center[end.body]);
}

/// An end at the place of a solid that is nearest to `place`.
HookPlace end_at(std::uint32_t object, DVec3 place, const Tables& t) {
  HookPlace end = build::nearest_place(t, t.objects[object], place);
  end.object = object;
  return end;
}

/// Makes a hook hold a place and nothing else, and lets it forget all impulses.
void make_ball(Hook& hook) {
  const HookFreedom locked = {.locked = true};
  hook.kind = HookKind::kBall;
  hook.freedom = {locked, locked, locked, {}, {}, {}};
  hook.cone = kRigid;
  hook.value = {};
}

/// What the solver remembers of a hook counts for its rows alone, and these are new.
void forget_impulses(Hook& hook) {
  const Hook fresh = {};
  hook.impulse = hook.impulse_sum = hook.angular_impulse = hook.angular_impulse_sum = {};
  hook.row_impulse = fresh.row_impulse;
  hook.last_impulse = hook.last_angular_impulse = Real(0);
  hook.energy_debt = fresh.energy_debt;
  hook.spring_energy = fresh.spring_energy;
  hook.giving = fresh.giving;
}

/// Lets no point of the solid touch the body at the other end, as two bodies on a hook do not, unless the
/// hook says so.
void exclude_all(Hook& hook, const Tables& t) {
  if (hook.collide) return collision::note_hooked_points(t, hook);
  hook.inside.clear();
  const std::uint32_t body = hook.other_end().body;
  if (body == HookPlace::kWorld || (hook.a.is_point() && hook.b.is_point())) return;
  hook.inside.resize(t.objects[hook.point_end().object].particles.count);
  std::iota(hook.inside.begin(), hook.inside.end(), 0U);
}

/// Adds a ball beside a hook, in the direction in which the solid is nearer. Returns its slot.
std::uint32_t add_helper(const Hook& hook, bool at_a, DVec3 direction, Real radius, Tables& t) {
  const std::uint32_t object = (at_a ? hook.a : hook.b).object;
  const DVec3 place = place_of(at_a ? hook.a : hook.b, t);
  const DVec3 arm = kHelperReach * static_cast<double>(radius) * direction;
  HookPlace best;
  double farthest = -1;
  for (const double sign : {1.0, -1.0}) {
    const HookPlace end = end_at(object, place + sign * arm, t);
    const double reached = sign * dot(place_of(end, t) - place, direction);
    if (reached <= farthest) continue;
    farthest = reached;
    best = end;
  }
  Hook helper = {.collide = hook.collide, .a = hook.a, .b = hook.b};
  make_ball(helper);
  (at_a ? helper.a : helper.b) = best;
  put_anchor(place_of(best, t), t, at_a ? helper.b : helper.a);
  exclude_all(helper, t);
  helper.slot = t.hook_slots.add(static_cast<std::uint32_t>(t.hooks.size())).slot;
  t.hooks.push_back(helper);
  return helper.slot;
}

/// Directions in which a hook needs helpers: a hinge along its axis, a fixed hook across each other.
std::vector<DVec3> helper_directions(HookKind kind, DQuat axes) {
  if (kind == HookKind::kHinge) return {rotate(axes, DVec3{1, 0, 0})};
  if (kind == HookKind::kFixed) return {rotate(axes, DVec3{1, 0, 0}), rotate(axes, DVec3{0, 1, 0})};
  return {};
}

void move_to_solid(std::uint32_t row, bool at_a, std::uint32_t object, Tables& t) {
  Hook& hook = t.hooks[row];
  HookPlace& end = at_a ? hook.a : hook.b;
  HookPlace& other = at_a ? hook.b : hook.a;
  const std::uint32_t body = end.body;
  state::HeldHook held = {.hook = hook};
  const DQuat axes = frame_rotation(end, t) * in_double(end.axes);
  const HookKind kind = hook.kind;
  end = end_at(object, place_of(end, t), t);
  end.axes = in_real(axes);
  if (kind != HookKind::kDistance && kind != HookKind::kRopeSlide) {
    if (!other.is_point()) put_anchor(place_of(end, t), t, other);
    make_ball(hook);
  }
  forget_impulses(hook);
  exclude_all(hook, t);
  const Hook moved = hook;
  std::size_t count = 0;
  for (const DVec3 direction : helper_directions(kind, axes))
    held.helpers[count++] = add_helper(moved, at_a, direction, t.bodies.traits[body].radius, t);
  const auto same = [&](const state::HeldHook& one) { return one.hook.slot == moved.slot; };
  if (std::none_of(t.held_hooks.begin(), t.held_hooks.end(), same)) t.held_hooks.push_back(std::move(held));
}

/// Removes hooks by their slots; 0 and slots of hooks that are gone are passed over.
void remove_helpers(const std::array<std::uint32_t, 2>& slots, Tables& t) {
  for (const std::uint32_t slot : slots) {
    if (slot != 0) remove_row(t.hook_slots, t.hook_slots.id_of(slot), t.hooks);
  }
}

/// The part of a rotation that a kind leaves free.
DQuat free_part(HookKind kind, DQuat turn) {
  if (kind == HookKind::kFixed) return {0, 0, 0, 1};
  if (kind != HookKind::kHinge) return turn;
  const double size = std::sqrt(turn.x * turn.x + turn.w * turn.w);
  if (!(size > 0)) return {0, 0, 0, 1};
  return {turn.x / size, 0, 0, turn.w / size};
}

/// Gives a hook back what it was, between bodies that have been soft. Its axes are those that it left, turned
/// by what its kind leaves free, so that nothing jumps.
void restore(const Hook& before, std::uint32_t body, Hook& hook, const Tables& t) {
  const HookPlace a = hook.a;
  const HookPlace b = hook.b;
  const Real needed = hook.needed_force;
  hook = before;
  forget_impulses(hook);
  hook.needed_force = needed;
  hook.inside.clear();
  hook.a = a;
  hook.b = b;
  if (hook.holds_point()) {
    collision::note_hooked_points(t, hook);
    return;
  }
  if (before.a.body != HookPlace::kWorld) hook.a.axes = before.a.axes;
  if (before.b.body != HookPlace::kWorld) hook.b.axes = before.b.axes;
  if (hook.kind == HookKind::kDistance) return;
  const DQuat axes_a = frame_rotation(hook.a, t) * in_double(hook.a.axes);
  const DQuat axes_b = frame_rotation(hook.b, t) * in_double(hook.b.axes);
  const DQuat turn = free_part(hook.kind, normalize(conjugate(axes_a) * axes_b));
  if (hook.b.body == body) {
    hook.b.axes = in_real(normalize(conjugate(frame_rotation(hook.b, t)) * axes_a * turn));
    put_anchor(place_of(hook.a, t), t, hook.b);
  } else {
    hook.a.axes = in_real(normalize(conjugate(frame_rotation(hook.a, t)) * axes_b * conjugate(turn)));
    put_anchor(place_of(hook.b, t), t, hook.a);
  }
  if (hook.kind != HookKind::kHinge) return;
  const double turn_whole = 2 * std::numbers::pi;
  const double angle = 2 * math::atan2(turn.x, turn.w);
  hook.value[3] = angle + turn_whole * std::floor((before.value[3] - angle) / turn_whole + 0.5);
}

}  // namespace

void move_hooks_to_solid(std::uint32_t body, std::uint32_t object, Tables& t) {
  const std::size_t count = t.hooks.size();
  for (std::uint32_t row = 0; row < count; ++row) {
    for (const bool at_a : {true, false}) {
      if ((at_a ? t.hooks[row].a : t.hooks[row].b).body != body) continue;
      wake_ends(t.hooks[row], t.bodies);
      move_to_solid(row, at_a, object, t);
      ++t.hook_revision;
    }
  }
}

void move_hooks_to_body(std::uint32_t object, std::uint32_t body, Tables& t) {
  const DQuat back = conjugate(in_double(t.bodies.rotation[body]));
  const auto move = [&](HookPlace& end) {
    const DVec3 place = place_of(end, t);
    const DQuat axes = back * in_double(end.axes);
    end = {.body = body, .axes = in_real(axes)};
    put_anchor(place, t, end);
  };
  for (Hook& hook : t.hooks) {
    bool moved = false;
    for (HookPlace* end : {&hook.a, &hook.b}) {
      if (!end->is_point() || end->object != object) continue;
      move(*end);
      moved = true;
    }
    if (!moved) continue;
    forget_impulses(hook);
    hook.inside.clear();
    if (hook.holds_point()) collision::note_hooked_points(t, hook);
    wake_ends(hook, t.bodies);
    ++t.hook_revision;
  }
  const auto is_soft_solid = [&](const HookPlace& end) {
    return end.is_point() && std::any_of(t.yielding.begin(), t.yielding.end(), [&](const auto& yielding) {
             return yielding.body != body && soft_object(t, yielding) == end.object;
           });
  };
  std::erase_if(t.held_hooks, [&](const state::HeldHook& held) {
    const std::uint32_t row = t.hook_slots.find(t.hook_slots.id_of(held.hook.slot));
    if (row == t.hook_slots.kNone) return false;
    Hook& hook = t.hooks[row];
    if (hook.a.body != body && hook.b.body != body) return false;
    if (is_soft_solid(hook.a) || is_soft_solid(hook.b)) return false;
    restore(held.hook, body, hook, t);
    remove_helpers(held.helpers, t);
    return true;
  });
}

void drop_orphaned_helpers(Tables& t) {
  std::erase_if(t.held_hooks, [&](const state::HeldHook& held) {
    if (t.hook_slots.find(t.hook_slots.id_of(held.hook.slot)) != t.hook_slots.kNone) return false;
    remove_helpers(held.helpers, t);
    ++t.hook_revision;
    return true;
  });
}

}  // namespace hooke::world
