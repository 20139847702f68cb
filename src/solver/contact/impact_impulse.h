#pragma once

#include "solver/contact/body_contacts.h"
#include "state/bodies.h"
#include "state/manifolds.h"

#include <span>
#include <vector>

namespace hooke::solver {

/// Who strikes whom.
struct ImpactLanes {
  std::span<const ContactLane> lanes;  ///< Of the pair's manifolds.
  bool in_dense_pile = false;          ///< Bounces from kLeastHitInCrowd on, and is iterated less.
  bool a_is_backed = false;            ///< A gives way across the normal only; the ground takes the rest.
  bool b_is_backed = false;
};

/// The impact of two bodies at all points where they meet `time` [s] from now, in a substep that step.h is
/// the length of; manifolds are those of that time, with anchors of A and B at one place. Points that come
/// together leave with -e times their speed, or faster; impulses only push. Friction acts at the middle of
/// what a manifold's points carry: it sticks within static friction times their impulses, and slides with
/// friction times them. Of friction that would add energy, as it can beside Newton's restitution (Kane and
/// Levinson 1985), only so much is left that it does not: a half, a quarter or nothing.
///
/// Velocities, angular momenta and free motion change, and positions so that the line of the whole substep
/// leads from the hit on; lanes note what pushed them. False, and nothing changes, if no point comes together
/// faster than kLeastHit.
bool apply_impact(const ImpactLanes& pair, const std::vector<state::Manifold>& manifolds, Real time,
                  const ContactStep& step, BodyContacts& contacts, state::Bodies& bodies);

}  // namespace hooke::solver
