#pragma once

#include "parallel/thread_pool.h"
#include "solver/surface/surface_groups.h"

/// \file
/// The contact of deformables with each other and with themselves. In each particle substep rows of velocity
/// keep surfaces apart, and the last writer of positions sees to it that none crosses another.
/// docs/decisions/0040-contact-of-surfaces.md.

namespace hooke::solver {

/// Begins a step of `substeps` particle substeps. What the step before found is forgotten, so that nothing of
/// it must be in a snapshot.
void begin_surface_step(const state::Tables& tables, int substeps, SurfaceContacts& contacts);

/// Notes where vertices begin a particle substep; before anything moves one.
void begin_surface_substep(const state::Tables& tables, SurfaceContacts& contacts);

/// Solves the rows that were found, for the first time in a substep or once more after contacts with bodies.
void solve_surfaces(parallel::ThreadPool& pool, Real h, bool again, SurfaceContacts& contacts,
                    state::Tables& tables);

/// Finds contacts anew where the step begins and where vertices are about to leave their cages, and solves
/// the rows of those groups. Returns whether there were any: then contacts with bodies are to be solved once
/// more.
bool refresh_surface_contacts(parallel::ThreadPool& pool, Real h, SurfaceContacts& contacts,
                              state::Tables& tables);

/// Finds contacts of groups with stiff solids, ropes or cloths that solids may load, before these are solved,
/// as refresh_surface_contacts does.
void find_contacts_before_solutions(parallel::ThreadPool& pool, Real h, SurfaceContacts& contacts,
                                    const state::Tables& tables);

/// Largest amount by which parts of surfaces whose contacts the last step found are nearer now than the
/// distance that they keep [m]; 0 if rows have changed since.
[[nodiscard]] Real largest_overlap(const state::Tables& tables, const SurfaceContacts& contacts);

/// Ends a particle substep, after everything else has moved particles: see truncate_group.
void truncate_surfaces(parallel::ThreadPool& pool, Real h, SurfaceContacts& contacts, state::Tables& tables);

}  // namespace hooke::solver
