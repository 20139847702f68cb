#pragma once

/// \file
/// Constants of tetrahedra that decide accuracy or robustness. docs/tuning.md says how to try another value.

namespace hooke::solver {

/// Share that is added to the inertia of a tetrahedron's form, which is singular where it is pressed to a
/// line [ratio]. Larger: a solid loses spin. Chosen by hand; no measurement is recorded.
inline constexpr double kLeastSpinShare = 1e-12;

/// Share of the first residual down to which stiff solids are solved [ratio]. Larger: with 1e-3 a ball of 200
/// kg that hit a jelly at 300 m/s lost 2e-4 of its momentum; with 1e-4 a jelly of 10 GPa under 100 kg gained
/// half of its energy. Smaller: 10 to 15 % more time for ten times less.
inline constexpr double kStiffSolidError = 1e-5;

/// Most passes over the rows of a stiff solid in a substep. A cube of 125 cells takes 40 to 110 from 1 MPa to
/// 100 GPa for one set of contacts; another set is solved while half of them are left. Smaller: larger solids
/// yield. Larger: what never comes to a solution costs as much.
inline constexpr int kMostStiffSolidDirections = 800;

}  // namespace hooke::solver
