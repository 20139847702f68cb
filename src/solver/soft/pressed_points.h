#pragma once

#include "hooke/math.h"

#include "solver/solid/tetrahedron_blocks.h"
#include "state/tables.h"

#include <vector>

namespace hooke::solver {

/// Counts the points of deformables that press on each body, or are about to in a substep of `h` [s], by row
/// of the body.
void count_pressing_points(const state::Tables& tables, Real h, std::vector<int>& shares);

/// Notes the points of solids that bodies press on, and how hard they are to move with a share of the body's
/// mass each. Otherwise stress would push them as if they were free, and reach a heavy body only as what
/// stops a light point: a jelly under 45 times its mass gained more than twice the energy of the fall.
void note_pressed_points(const state::Tables& tables, const std::vector<int>& shares, Real h,
                         TetrahedronBlocks& tetrahedra);

/// Lets go points that do not stay where they touch, by the velocity that their impulses alone would give
/// them, takes hold of those that would pass, and finds friction where they slide.
/// Returns whether any point changed.
[[nodiscard]] bool renew_pressed_points(const std::vector<int>& shares, const state::Tables& tables, Real h,
                                        TetrahedronBlocks& tetrahedra);

/// Gives each point that was noted the velocity that its impulses alone cause where contacts hold it, which
/// then share these impulses out. Overlaps count as at most what stress lets leave at once: a move of one
/// point strains what is stiff. It changes bodies: call it for one group after the other.
void release_pressed_points(Real h, TetrahedronBlocks& tetrahedra, state::Tables& tables);

/// Gives points that a body holds the velocity of its surface, and forgets them: contacts yield a little to
/// the impulses of what is stiff, which would then be strained. Momentum stays. Call it after contacts, for
/// one group after the other.
void settle_pressed_points(Real h, TetrahedronBlocks& tetrahedra, state::Tables& tables);

}  // namespace hooke::solver
