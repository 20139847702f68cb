#pragma once

/// \file
/// Constants of tetrahedra that decide accuracy or robustness. docs/tuning.md says how to try another value.

namespace hooke::solver {

/// Share that is added to the inertia of a tetrahedron's form, which is singular where it is pressed to a
/// line [ratio]. Larger: a solid loses spin. Chosen by hand; no measurement is recorded.
inline constexpr double kLeastSpinShare = 1e-12;

}  // namespace hooke::solver
