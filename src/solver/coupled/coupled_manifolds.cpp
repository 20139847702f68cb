#include "solver/coupled/coupled_manifolds.h"

#include "base/assert.h"
#include "solver/contact/contact_colors.h"

#include <algorithm>

namespace hooke::solver {

using state::ContactRoute;
using state::CoupledManifold;
using state::Manifold;

bool may_be_coupled(const Manifold& m, const state::Bodies& bodies, const Joints& joints) {
  const auto articulation = [&](std::uint32_t body) {
    return body < joints.articulation_of.size() ? joints.articulation_of[body] : Joints::kNoArticulation;
  };
  const std::uint32_t of_a = articulation(m.body_a);
  const bool same = of_a != Joints::kNoArticulation && of_a == articulation(m.body_b);
  return !same && has_contact_rows(m, bodies);
}

namespace {

/// Couples the other contacts of the joined bodies, and joins the bodies on their other side: an island that
/// solved them alone would undo what the group did.
void couple_contacts_of(const Joints& joints, state::Tables& t, std::vector<std::uint8_t>& joined) {
  for (Manifold& m : t.pairs.manifold) {
    const bool is_joined = joined[m.body_a] != 0 || joined[m.body_b] != 0;
    if (is_joined && may_be_coupled(m, t.bodies, joints)) m.route = ContactRoute::kCoupled;
  }
  for (const Manifold& m : t.pairs.manifold) {
    if (!m.is_coupled()) continue;
    for (const std::uint32_t body : {m.body_a, m.body_b}) {
      if (is_moved(t.bodies, body)) joined[body] = 1;
    }
  }
}

/// Joins what articulations hold and what hooks at points hold.
void join_hooked_bodies(const Joints& joints, const std::vector<state::Hook>& hooks,
                        std::vector<std::uint8_t>& joined) {
  const std::size_t known = std::min(joined.size(), joints.articulation_of.size());
  for (std::size_t body = 0; body < known; ++body) {
    if (joints.articulation_of[body] != Joints::kNoArticulation) joined[body] = 1;
  }
  for (const std::uint32_t row : joints.at_points) {
    for (const std::uint32_t body : {hooks[row].a.body, hooks[row].b.body}) {
      if (body < joined.size()) joined[body] = 1;
    }
  }
}

}  // namespace

void couple_neighbors(const Joints& joints, state::Tables& t, std::vector<std::uint8_t>& joined) {
  joined.assign(t.bodies.motion.size(), 0);
  for (const CoupledManifold& of : t.pairs.coupled) {
    for (const std::uint32_t body : {of.body_a, of.body_b}) joined[body] = is_moved(t.bodies, body) ? 1 : 0;
  }
  if (!t.pairs.coupled.empty()) couple_contacts_of(joints, t, joined);
  join_hooked_bodies(joints, t.hooks, joined);
}

void list_coupled_manifolds(state::Pairs& pairs, std::vector<std::uint32_t>& bearing) {
  bearing.clear();
  for (const CoupledManifold& of : pairs.coupled) bearing.push_back(of.manifold);
  HOOKE_ASSERT(std::is_sorted(bearing.begin(), bearing.end()));
  pairs.coupled.clear();
  for (std::uint32_t row = 0; row < pairs.manifold.size(); ++row) {
    const Manifold& m = pairs.manifold[row];
    if (!m.is_coupled()) continue;
    pairs.coupled.push_back({.manifold = row,
                             .body_a = m.body_a,
                             .body_b = m.body_b,
                             .bears_load = std::binary_search(bearing.begin(), bearing.end(), row)});
  }
}

void find_coupled_lanes(const BodyContacts& contacts, state::Pairs& pairs) {
  if (pairs.coupled.empty()) return;
  for (std::size_t i = 0; i < contacts.blocks.size(); ++i) {
    const ContactBlock& block = contacts.blocks[i];
    if (!block.is_coupled()) continue;
    for (int lane = 0; lane < block.count; ++lane) {
      const std::uint32_t row = contacts.manifold_of[i * kContactLanes + static_cast<std::size_t>(lane)];
      const auto at =
          std::lower_bound(pairs.coupled.begin(), pairs.coupled.end(), row,
                           [](const CoupledManifold& of, std::uint32_t r) { return of.manifold < r; });
      HOOKE_ASSERT(at != pairs.coupled.end() && at->manifold == row);
      at->block = static_cast<std::int32_t>(i);
      at->lane = lane;
    }
  }
}

}  // namespace hooke::solver
