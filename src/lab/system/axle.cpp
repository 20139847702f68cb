#include "lab/system/axle.h"

#include "math/rotation.h"

#include <algorithm>

namespace hooke::lab {

namespace {

constexpr double kOffCenter = 1e-4;  ///< Share of the radius; anchors are given in float.

bool holds(const state::Hook& hook, std::uint32_t body) {
  return !hook.broken && (hook.a.body == body || hook.b.body == body);
}

DVec3 squares(DVec3 v) {
  return {v.x * v.x, v.y * v.y, v.z * v.z};
}

}  // namespace

bool is_hooked(const state::Tables& tables, std::uint32_t body) {
  return std::any_of(tables.hooks.begin(), tables.hooks.end(),
                     [&](const state::Hook& hook) { return holds(hook, body); });
}

std::optional<Axle> axle_of(const state::Tables& tables, std::uint32_t body) {
  const auto is_held = [&](const state::Hook& hook) { return holds(hook, body); };
  const auto hook = std::find_if(tables.hooks.begin(), tables.hooks.end(), is_held);
  if (tables.bodies.traits[body].kind != BodyKind::kDynamic || hook == tables.hooks.end()) return {};
  if (std::any_of(hook + 1, tables.hooks.end(), is_held)) return {};
  const state::HookPlace& world = hook->a.body == body ? hook->b : hook->a;
  const bool is_free = hook->freedom[3] == HookFreedom{};  // The freedom of the angle about the axis.
  if (hook->kind != HookKind::kHinge || world.body != state::HookPlace::kWorld || world.is_point() ||
      !is_free)
    return {};
  const DVec3 axis = normalize(rotate(math::in_double(world.axes), DVec3{1, 0, 0}));
  const DVec3 aside = cross(world.anchor - tables.bodies.center[body], axis);
  if (!(length(aside) <= kOffCenter * static_cast<double>(tables.bodies.traits[body].radius))) return {};
  const state::BodyMass& mass = tables.bodies.mass[body];
  const Quaternion<double> principal =
      normalize(math::in_double(tables.bodies.rotation[body]) * math::in_double(mass.principal));
  const DVec3 own = rotate(conjugate(principal), axis);
  return Axle{axis, dot(vector_cast<double>(mass.inertia), squares(own))};
}

}  // namespace hooke::lab
