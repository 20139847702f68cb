#pragma once

#include "hooke/math.h"

#include "solver/solid/tetrahedron_blocks.h"
#include "state/tables.h"

#include <vector>

namespace hooke::solver {

/// Counts the points of deformables that press on each body, by row of the body.
void count_pressing_points(const state::Tables& tables, std::vector<int>& shares);

/// Notes the points of solids that bodies press on, and how hard they are to move with a share of the body's
/// mass each. Otherwise stress would push them as if they were free, and reach a heavy body only as what
/// stops a light point: a jelly under 45 times its mass gained more than twice the energy of the fall.
void note_pressed_points(const state::Tables& tables, const std::vector<int>& shares,
                         TetrahedronBlocks& tetrahedra);

/// Lets go points that do not stay where they touch, by the velocity that their impulses so far would give
/// them.
void renew_pressed_points(const std::vector<int>& shares, TetrahedronBlocks& tetrahedra,
                          state::Tables& tables);

/// Gives each point that was noted the velocity that its impulses alone cause, and forgets them. Contacts
/// then share these impulses out.
void release_pressed_points(TetrahedronBlocks& tetrahedra, state::Particles& particles);

}  // namespace hooke::solver
