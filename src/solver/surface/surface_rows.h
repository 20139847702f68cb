#pragma once

#include "solver/surface/surface_groups.h"

namespace hooke::solver {

/// Solves the rows of a group for a particle substep of `h` [s]: with s the gap less the distance that is
/// kept, at the start of the substep,
///
///     apart (s > 0)       n.v >= -s / h
///     overlapping         n.v >= min(0.3 (-s) / h, 1 m/s)
///     friction            |v_t| falls by at most mu times the change of n.v
///
/// with v = sum weight v of the four vertices. An impulse p changes v_i by weight_i w_i p.
void solve_surface_rows(Real h, const SurfaceContacts& contacts, SurfaceGroup& group,
                        state::Particles& particles);

}  // namespace hooke::solver
