#include "collision/deformable/contact_frames.h"

#include "base/assert.h"
#include "collision/deformable/deformable_tuning.h"
#include "collision/distance/shape_gap.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

Frame frame_of(const state::Tables& t, std::uint32_t collider, const state::Deformable& object) {
  HOOKE_ASSERT(t.colliders.body[collider] < t.bodies.center.size());
  const Pose body = state::pose_now(t.bodies, t.colliders.body[collider]);
  const DVec3 arm = vector_cast<double>(rotate(body.rotation, t.colliders.position[collider]));
  const std::uint32_t row = t.colliders.body[collider];
  const geometry::Box& bounds = t.colliders.bounds[collider];
  const Vec3 rounding = {kBoxRounding, kBoxRounding, kBoxRounding};
  return {.shape = &t.colliders.shape[collider],
          .rotation = body.rotation * t.colliders.rotation[collider],
          .offset = vector_cast<Real>(body.position + arm - object.origin),
          .center = vector_cast<Real>(body.position - object.origin),
          .belt_velocity = rotate(body.rotation, t.colliders.surface[collider].surface_velocity),
          .speed = length(t.bodies.motion[row].v) +
                   length(t.bodies.angular_velocity[row]) * t.bodies.traits[row].radius,
          .box = {vector_cast<Real>(vector_cast<double>(bounds.lower) - object.origin) - rounding,
                  vector_cast<Real>(vector_cast<double>(bounds.upper) - object.origin) + rounding}};
}

Real distance_to(const Frame& frame, Vec3 place, Real reach) {
  const Vec3 x = frame.to_shape(place);
  const bool mesh = frame.shape->shape.kind == ShapeKind::kMesh;
  return mesh ? distance_to_mesh(*frame.shape->mesh, x, reach) : gap_to_shape(*frame.shape, x).distance;
}

bool is_solid(const state::Tables& t, std::uint32_t body) {
  return t.bodies.traits[body].collides && !t.bodies.traits[body].sensor;
}

void list_solid_colliders(const state::Tables& t, std::vector<std::uint32_t>& rows) {
  rows.clear();
  if (t.objects.empty()) return;
  for (std::uint32_t c = 0; c < t.colliders.body.size(); ++c) {
    const std::uint32_t body = t.colliders.body[c];
    if (body != state::Colliders::kNoBody && is_solid(t, body)) rows.push_back(c);
  }
}

void list_near_colliders(const state::Tables& t, std::span<const std::uint32_t> colliders,
                         const state::Deformable& object, Real reach, std::vector<std::uint32_t>& near) {
  DVec3 lower = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
  DVec3 upper = -lower;
  for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
    const DVec3 x = vector_cast<double>(t.particles.position[p].x);
    lower = geometry::min_of(lower, x);
    upper = geometry::max_of(upper, x);
  }
  const auto margin = static_cast<double>(reach);
  const geometry::Box3<double> box = {object.origin + lower - DVec3{margin, margin, margin},
                                      object.origin + upper + DVec3{margin, margin, margin}};
  near.clear();
  for (const std::uint32_t c : colliders) {
    const geometry::Box& bounds = t.colliders.bounds[c];
    if (overlap(box, {vector_cast<double>(bounds.lower), vector_cast<double>(bounds.upper)}))
      near.push_back(c);
  }
}

void make_frames(const state::Tables& t, std::span<const std::uint32_t> colliders,
                 const state::Deformable& object, std::vector<Frame>& frames) {
  frames.clear();
  for (const std::uint32_t c : colliders) frames.push_back(frame_of(t, c, object));
}

void list_hooked_near(const state::Tables& t, std::vector<HookedNear>& near) {
  near.clear();
  if (t.objects.empty()) return;
  for (const state::Hook& hook : t.hooks) {
    if (!hook.collide || hook.broken || hook.kind != HookKind::kBall || !hook.holds_point()) continue;
    const std::uint32_t object = hook.point_end().object;
    const std::uint32_t body = hook.other_end().body;
    if (body != state::HookPlace::kWorld && t.objects[object].tetrahedra.count > 0)
      near.push_back({object, body, hook.rest_distance});
  }
}

Real touching_radius(const std::vector<HookedNear>& near, std::uint32_t object, std::uint32_t body,
                     Real radius) {
  for (const HookedNear& one : near) {
    if (one.object == object && one.body == body) radius = std::min(radius, one.distance);
  }
  return radius;
}

namespace {

bool is_before(const Hooked& a, const Hooked& b) {
  return std::pair{a.second, a.first} < std::pair{b.second, b.first};
}

/// Lists the points that hooks hold at a place of a body.
void list_held(const state::Tables& t, std::vector<Hooked>& held) {
  for (const state::Hook& hook : t.hooks) {
    if (hook.kind != HookKind::kBall || hook.collide || hook.broken || !hook.holds_point()) continue;
    const state::HookPlace& point = hook.point_end();
    const std::uint32_t body = hook.other_end().body;
    if (body == state::HookPlace::kWorld || hook.other_end().is_point()) continue;
    for (std::uint32_t i = 0; i < point.particle_count; ++i) held.emplace_back(point.particle[i], body);
  }
}

/// Adds the points that the first `known` pairs, which are sorted, have with body `from`, as pairs with `to`.
void add_points_of(std::uint32_t from, std::uint32_t to, std::size_t known, std::vector<Hooked>& held) {
  const auto end_of_known = [&] { return held.begin() + static_cast<std::ptrdiff_t>(known); };
  const auto first = std::lower_bound(held.begin(), end_of_known(), Hooked{0, from}, is_before);
  for (auto i = static_cast<std::size_t>(first - held.begin()); i < known && held[i].second == from; ++i) {
    const Hooked reached = {held[i].first, to};
    if (!std::binary_search(held.begin(), end_of_known(), reached, is_before)) held.push_back(reached);
  }
}

/// Adds the bodies that a body which holds a point is hooked to and so passes through, and then all that is
/// fixed to them. Its place may lie in one of them, where hook and contact would strain against each other
/// without bound.
void add_bodies_hooked_to_these(const state::Tables& t, std::vector<Hooked>& held) {
  const auto body_of = [](const state::HookPlace& end) {
    return end.is_point() ? state::HookPlace::kWorld : end.body;
  };
  bool only_fixed = false;
  for (std::size_t known = 0; known != held.size(); only_fixed = true) {
    std::sort(held.begin(), held.end(), is_before);
    held.erase(std::unique(held.begin(), held.end()), held.end());
    known = held.size();
    for (const state::Hook& hook : t.hooks) {
      if (hook.collide || hook.broken || (only_fixed && hook.kind != HookKind::kFixed)) continue;
      const std::uint32_t a = body_of(hook.a);
      const std::uint32_t b = body_of(hook.b);
      if (a == state::HookPlace::kWorld || b == state::HookPlace::kWorld) continue;
      add_points_of(a, b, known, held);
      add_points_of(b, a, known, held);
    }
  }
}

}  // namespace

void list_hooked(const state::Tables& t, std::vector<Hooked>& hooked) {
  hooked.clear();
  if (t.objects.empty()) return;
  list_held(t, hooked);
  add_bodies_hooked_to_these(t, hooked);
  const auto add = [&](const state::Hook& hook, const state::HookPlace& point, std::uint32_t body) {
    if (!point.is_point() || body == state::HookPlace::kWorld) return;
    const state::Rows object = t.objects[point.object].particles;
    for (const std::uint32_t i : hook.inside) hooked.emplace_back(object.first + i, body);
    if (hook.collide) return;
    for (std::uint32_t i = 0; i < point.particle_count; ++i) hooked.emplace_back(point.particle[i], body);
    if (hook.kind != HookKind::kRopeSlide) return;
    for (std::uint32_t p = object.first; p < object.end(); ++p) hooked.emplace_back(p, body);
  };
  for (const state::Hook& hook : t.hooks) {
    add(hook, hook.a, hook.b.body);
    add(hook, hook.b, hook.a.body);
  }
  std::sort(hooked.begin(), hooked.end());
}

bool is_hooked(const std::vector<Hooked>& hooked, std::uint32_t particle, std::uint32_t body) {
  return std::binary_search(hooked.begin(), hooked.end(), Hooked{particle, body});
}

}  // namespace hooke::collision
