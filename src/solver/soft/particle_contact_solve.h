#pragma once

#include "parallel/range.h"
#include "solver/soft/soft_tuning.h"
#include "state/bodies.h"
#include "state/contacts.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// Solves contacts of cloth, solids and loose particles with bodies; contacts of ropes are solved inside the
/// rope system. With v the velocity of the particle relative to the surface that it touches:
///
///   apart (s > 0)   n.v >= -s/h: the particle reaches the surface in this substep and no farther
///   overlapping     n.v >= 0, and the position is moved out by at most kParticlePushOutSpeed h: overlap
///   never
///                   becomes speed
///   friction        the tangential velocity is reduced by at most mu times the normal change
///
/// Rows of one particle are solved in order, twice when there are several. Ranges may begin anywhere: a
/// particle's rows belong to the range that holds the first of them. Particles that touch a body which gives
/// way, or hang on a hook, are solved in a coupled group instead (solver/coupled/coupled_groups.h); here they
/// are only stopped where they would pass what does not give way.
void solve_contacts(const std::vector<state::Deformable>& objects, parallel::Range range, Real h,
                    const state::Bodies& bodies, state::Contacts& contacts, state::Particles& particles);

/// Moves a particle by `by` [m], but no deeper into what does not give way, and notes it in its contacts:
/// where a body presses a cloth on the ground, points would be pushed through it.
void displace(std::uint32_t particle, Vec3 by, const state::Bodies& bodies, state::Contacts& contacts,
              state::Particles& particles);

/// Takes the speed with which a particle would pass what does not give way, after something else has pushed
/// it.
void stop_at_ground(std::uint32_t particle, Real h, state::Tables& tables);

/// Moves the particle of a row out of the body that it overlaps.
void push_out(std::size_t row, Real h, const state::Bodies& bodies, state::Contacts& contacts,
              state::Particles& particles);

/// Solves the rows of marked objects once more after something else has changed velocities: forces add up,
/// and nothing is moved out. Points of ropes are stopped as those of coupled groups are.
void solve_contacts_again(const state::Tables& tables, std::span<const std::uint8_t> marked,
                          parallel::Range range, Real h, state::Contacts& contacts,
                          state::Particles& particles);

}  // namespace hooke::solver
