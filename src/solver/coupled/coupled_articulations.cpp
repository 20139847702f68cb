#include "solver/coupled/coupled_articulations.h"

#include "solver/soft/element_contact_solve.h"

#include <algorithm>

namespace hooke::solver {

namespace {

using state::Hook;
using state::Tables;

/// Notes the bodies that a bundle holds by other rows than those of hooks between bodies. True if any.
bool find_touched(const Tables& t, std::vector<std::uint8_t>& touched) {
  touched.assign(t.bodies.motion.size(), 0);
  bool any = false;
  const auto touch = [&](std::uint32_t body) {
    if (!gives_way(t.bodies, body)) return;
    touched[body] = 1;
    any = true;
  };
  for (const Hook& hook : t.hooks) {
    if (!hook.holds_point()) continue;
    touch(hook.a.body);
    touch(hook.b.body);
  }
  for (const std::uint32_t body : t.contacts.body) touch(body);
  for (const state::InnerContact& inner : t.inner_contacts) {
    if (is_tied(t, inner)) touch(inner.body);
  }
  for (const state::BorneContact& borne : t.pairs.borne) {
    touch(borne.body_a);
    touch(borne.body_b);
  }
  return any;
}

}  // namespace

void couple_articulations(const Joints& joints, std::vector<std::uint8_t>& touched, Tables& t) {
  if (joints.order.empty() || !find_touched(t, touched)) return;
  const auto is_touched = [&](std::uint32_t body) { return body < touched.size() && touched[body] != 0; };
  for (const std::uint32_t i : joints.order) {
    const Articulation& art = joints.articulations[i];
    if (std::none_of(art.bodies.begin(), art.bodies.end(), is_touched)) continue;
    for (const Articulation::Joint& joint : art.joints) {
      if (joint.is_weld()) continue;
      Hook& hook = t.hooks[joint.hook];
      // One between bodies that are both asleep or driven moves nothing, and is of no bundle.
      hook.coupled = gives_way(t.bodies, hook.a.body) || gives_way(t.bodies, hook.b.body);
    }
  }
}

}  // namespace hooke::solver
