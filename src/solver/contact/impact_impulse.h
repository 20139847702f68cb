#pragma once

#include "solver/contact/body_contacts.h"
#include "state/bodies.h"
#include "state/manifolds.h"

#include <span>
#include <vector>

namespace hooke::solver {

/// The bodies of one impact.
struct ImpactLanes {
  std::span<const ContactLane> lanes;  ///< Lanes of the pair's manifolds.
  /// Bounces from kLeastImpactSpeedInPile on, and is iterated less.
  bool in_dense_pile = false;
  bool a_is_backed = false;  ///< A gives way across the normal only; the ground takes the rest.
  bool b_is_backed = false;
};

/// Solves the impact of two bodies at all points where they meet `time` [s] from now, in a substep of length
/// step.h. Manifolds are those of that time, with anchors of A and B at one position. Points that come
/// together leave with -e times their speed, or faster; impulses only push. Friction acts at the middle of
/// the load of a manifold's points: it sticks within static friction times their impulses, and slides with
/// friction times them. Friction can add energy beside Newton's restitution (Kane and Levinson 1985). Then
/// only a half, a quarter or nothing of it is kept, so that it does not.
///
/// Velocities, angular momenta and free motion change. Positions change so that the straight motion of the
/// whole substep continues from the impact on, and lanes note what pushed them. Returns false, and changes
/// nothing, if no point comes together faster than kLeastImpactSpeed.
bool apply_impact(const ImpactLanes& pair, const std::vector<state::Manifold>& manifolds, Real time,
                  const ContactStep& step, BodyContacts& contacts, state::Bodies& bodies);

}  // namespace hooke::solver
