#pragma once

#include "parallel/range.h"
#include "state/contacts.h"
#include "state/objects.h"
#include "state/particles.h"

#include <vector>

namespace hooke::solver {

constexpr double kPushOutSpeed = 1;  ///< Overlap of particles leaves no faster than this [m/s].

/// Contacts of cloth and loose particles with static shapes; those of ropes are solved inside the rope.
///
///   apart (s > 0)   n.v >= -s/h: the particle reaches the surface in this substep and no farther
///   overlapping     n.v >= 0, and the position is moved out by at most kPushOutSpeed h: overlap never
///   becomes speed friction        the tangential velocity is reduced by at most mu times the normal change
///
/// Rows of one particle are solved in order, twice when there are several. Ranges may begin anywhere: a
/// particle's rows belong to the range that holds the first of them.
void solve_contacts(const std::vector<state::Deformable>& objects, parallel::Range range, Real h,
                    state::Contacts& contacts, state::Particles& particles);

}  // namespace hooke::solver
