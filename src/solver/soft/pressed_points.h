#pragma once

#include "hooke/math.h"

#include "solver/solid/tetrahedron_blocks.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// Counts the points of objects that `solved_whole` marks which press on each body, or are about to in a
/// substep of `h` [s], by row of the body. Points of others do not count: with a share of its mass for those
/// of a cloth that lay between, a ball of 8 kg was driven into a plate and gained 60 times all energy.
void count_pressing_points(const state::Tables& tables, std::span<const std::uint8_t> solved_whole, Real h,
                           std::vector<int>& shares);

/// Notes the points of solids that bodies press on, the bodies that hold them with their shares of mass, and
/// what contacts do to each object as a whole, with which the solution begins. Otherwise stress would push
/// points as if they were free, and reach a heavy body only as what stops a light point: a jelly under 45
/// times its mass gained more than twice the energy of the fall. Call it after begin_stiff_solution.
void note_pressed_points(const state::Tables& tables, const std::vector<int>& shares, Real h,
                         TetrahedronBlocks& tetrahedra);

/// Lets go points that do not stay where they touch, and finds friction where they slide. Takes hold of those
/// that would pass if `may_hold`; otherwise it comes to an end. Returns whether any point changed.
[[nodiscard]] bool renew_pressed_points(const std::vector<int>& shares, const state::Tables& tables, Real h,
                                        bool may_hold, TetrahedronBlocks& tetrahedra);

/// Gives each point that was noted the velocity of the solution, and bodies the impulses with which they hold
/// it. Contacts that the solution let go do not act in this substep. Overlaps count as at most what stress
/// lets leave at once: a move of one point strains what is stiff. It changes bodies: call it for one group
/// after the other.
void release_pressed_points(Real h, TetrahedronBlocks& tetrahedra, state::Tables& tables);

/// Adds the impulses of the solution to the forces of contacts, gives points that a body holds the velocity
/// of its surface, which others may have pushed since, and forgets them. Momentum stays. Call it after
/// contacts, for one group after the other.
void settle_pressed_points(Real h, TetrahedronBlocks& tetrahedra, state::Tables& tables);

}  // namespace hooke::solver
