#pragma once

#include "hooke/math.h"

#include "solver/rope/rope_clamps.h"
#include "state/tables.h"

#include <vector>

/// \file
/// Ropes that resist twist. Twist waves are faster than bending waves by the length over the radius. So
/// twist is taken to be even between the places that hold a rope against it, and points need no rotation of
/// their own.

namespace hooke::solver {

/// Sorts ropes that resist twist into spans between clamps (solver/rope/rope_clamps.h). Spans that were there
/// before keep their state; new ones get the twist that their segments had.
void find_twist_spans(const std::vector<Holder>& holders, state::Tables& tables);

/// Turns the vector v, which is across the unit vector t, by the rotation about t x u that takes t to the
/// unit vector u. Where u points back along t, v stays.
[[nodiscard]] DVec3 transport(DVec3 t, DVec3 u, DVec3 v);

/// The present twist of a span [rad], with the whole turns that come nearest to what is expected. It is
/// positive where b has turned right-handed about the direction from a to b, and NaN if a place is not
/// finite.
[[nodiscard]] double twist_now(const state::Tables& tables, const state::TwistSpan& span);

/// The twist of a span and how it changes.
struct TwistRow {
  double angle = 0;              ///< Twist as twist_now gives it [rad].
  std::vector<DVec3> gradients;  ///< Gradients by the nodes from `span.a.segment` on [rad/m].
  DVec3 t_a, t_b;  ///< Along the segments of the clamps: how much a rotation of the holders counts.
};
void load_twist(const state::Tables& tables, const state::TwistSpan& span, TwistRow& row);

/// GJ over the length of the span [N m].
[[nodiscard]] double twist_stiffness(const state::Tables& tables, const state::TwistSpan& span);

/// Finds the torque of each span as impulses of a substep of length h [s], and applies the share of the
/// bodies. It runs before hooks and contacts of bodies, which have to hold them. The two functions below
/// take its `rows`. t_a and t_b are the unit vectors along the segments of the clamps. C is the twist: the
/// angle at b from a's director, carried along the segments by `transport`, to b's:
///
///   C' = t_b.omega_b - t_a.omega_a + sum G_i.v_i
///   gradients       node i-1: -b_i / |e_{i-1}|,   node i+1: b_i / |e_i|,   node i: minus both,
///                   b_i = t_{i-1} x t_i / (1 + t_{i-1}.t_i), half the curvature there
///   impulse         lambda = -h k (C + s h (C' + w lambda + r))
///
/// Bodies get lambda t_b and -lambda t_a. Sum x_i x G_i = t_a - t_b for any shape, so that the angular
/// momentum is complete. k = GJ / L, w = sum w_i |G_i|^2 + t S^2 t. The impulse is explicit, s = 0, while
/// h^2 k w <= 1: it makes and takes no energy. Above that s = 1 - 1 / (h^2 k w). r is what everything else
/// made of C' in the last substep: at rest lambda = -h k C.
///
/// Source: Bergou, Wardetzky, Robinson, Audoly, Grinspun 2008, "Discrete elastic rods".
void twist_bodies(double h, state::Tables& tables, std::vector<TwistRow>& rows);

/// Applies the same impulses to the nodes of ropes, before those are solved.
void twist_nodes(const std::vector<TwistRow>& rows, state::Tables& tables);

/// Runs after ropes have been solved. It stores what else changed C' in the substep, and predicts C at the
/// substep's end, by which whole turns are counted: a body may turn by more than half a turn in a substep.
void note_twist_rates(double h, const std::vector<TwistRow>& rows, state::Tables& tables);

}  // namespace hooke::solver
