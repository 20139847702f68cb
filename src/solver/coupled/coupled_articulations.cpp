#include "solver/coupled/coupled_articulations.h"

#include "base/assert.h"
#include "solver/soft/element_contact_solve.h"

#include <algorithm>

namespace hooke::solver {

namespace {

using state::Hook;
using state::Tables;

/// Marks the bodies that a coupled group holds by other rows than those of hooks between bodies. True if
/// there are any.
bool mark_held_bodies(const Tables& t, const Joints& joints, std::vector<std::uint8_t>& body_marks) {
  body_marks.assign(t.bodies.motion.size(), 0);
  bool any = false;
  const auto mark = [&](std::uint32_t body) {
    if (!gives_way(t.bodies, body)) return;
    body_marks[body] = 1;
    any = true;
  };
  for (const std::uint32_t row : joints.at_points) {
    mark(t.hooks[row].a.body);
    mark(t.hooks[row].b.body);
  }
  for (const std::uint32_t body : t.contacts.body) mark(body);
  for (const state::ElementContact& element_contact : t.element_contacts) {
    if (is_coupled(t, element_contact)) mark(element_contact.body);
  }
  for (const state::CoupledManifold& manifold : t.pairs.coupled) {
    mark(manifold.body_a);
    mark(manifold.body_b);
  }
  return any;
}

}  // namespace

void couple_articulations(const Joints& joints, std::vector<std::uint8_t>& body_marks, Tables& t) {
  if (joints.order.empty() || !mark_held_bodies(t, joints, body_marks)) return;
  const auto is_marked = [&](std::uint32_t body) {
    return body < body_marks.size() && body_marks[body] != 0;
  };
  for (const std::uint32_t i : joints.order) {
    const Articulation& art = joints.articulations[i];
    if (std::none_of(art.bodies.begin(), art.bodies.end(), is_marked)) continue;
    for (const Articulation::Joint& joint : art.joints) {
      if (joint.is_weld()) continue;
      HOOKE_ASSERT(joint.hook < t.hooks.size() && !t.hooks[joint.hook].holds_point());
      Hook& hook = t.hooks[joint.hook];
      // A hook between bodies that are both asleep or driven moves nothing and belongs to no coupled group.
      if (gives_way(t.bodies, hook.a.body) || gives_way(t.bodies, hook.b.body))
        hook.route = state::JointRoute::kCoupled;
    }
  }
}

}  // namespace hooke::solver
