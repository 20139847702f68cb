#pragma once

/// \file
/// Constants of tetrahedra, and of stiff solids that are solved as a whole, that decide accuracy or
/// robustness. docs/tuning.md says how to try another value.

namespace hooke::solver {

/// Share that is added to the inertia of a tetrahedron's form, which is singular where it is pressed to a
/// line [ratio]. Larger: a solid loses spin. Chosen by hand; no measurement is recorded.
inline constexpr double kLeastSpinShare = 1e-12;

/// Share of the first residual down to which stiff solids are solved [ratio]. Larger: with 1e-3 a ball of 200
/// kg that hit a jelly at 300 m/s lost 2e-4 of its momentum; with 1e-4 a jelly of 10 GPa under 100 kg gained
/// half of its energy. Smaller: 10 to 15 % more time for ten times less.
inline constexpr double kStiffSolidError = 1e-5;

/// The same in the first round of contacts, and what it is multiplied with in each further one [ratio]. Most
/// of what holds is found while the error is large. With 1e-5 from the first round on four cubes of 10 GPa
/// that fell on each other spent all directions on the first set of contacts and gained a third of their
/// energy; it took 1.6 to 3.5 times as long. With 0.03 or 0.3 as the second one the time is about the same.
inline constexpr double kFirstStiffSolidError = 0.1;
inline constexpr double kStiffSolidErrorFall = 0.1;

/// Share of its change to which the motion of a body that holds points is found, and that of a stiff solid as
/// a whole that nothing else holds [ratio]. Without it 10 kg on 100 GPa gained up to 370 % of all energy, and
/// two cubes of 10 GPa that met lost 3 % of their momentum.
inline constexpr double kMotionError = 1e-4;

/// Most passes over the rows of a stiff solid in a substep. A cube of 125 cells takes 40 to 110 from 1 MPa to
/// 100 GPa for one set of contacts; another set is solved while half of them are left. Smaller: larger solids
/// yield; with 800 two yielding balls of 300 MPa to 1 GPa that met were not solved in two substeps. Larger:
/// what never comes to a solution costs as much.
inline constexpr int kMostStiffSolidDirections = 1600;

/// Stiffness of the contact of two solids in their solution, over the mass with which their points resist
/// [ratio]. Smaller: more rounds until contacts keep their speed. With 20 and 100 two cubes of 100 MPa on
/// each other took 1.3 and 2 times the directions.
inline constexpr double kStiffRowShare = 5;

/// Error of a solution from which on impulses and friction of contacts of solids are taken from it [ratio].
/// What is solved roughly says which of them push, but not how hard: with 1e-1 a cube of 1 GPa that slid on a
/// slab lost up to five times the speed that friction takes, and needed twice the directions.
inline constexpr double kStiffRowsFrom = 1e-4;

/// Share of the impulse of a contact of solids that may change when it is solved again, and the same of its
/// friction [ratio]. With 0.1 for friction the cube above lost 3 % too little.
inline constexpr double kStiffRowError = 0.01;
inline constexpr double kRowFrictionError = 0.02;

}  // namespace hooke::solver
