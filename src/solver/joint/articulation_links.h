#pragma once

#include "solver/joint/articulations.h"

/// \file
/// Articulations with loops: links and rows at the start of a substep, and what a solution means for the
/// next. Trees have their own, side by side (solver/joint/tree_rows.h). Equations:
/// solver/joint/articulations.h.

namespace hooke::solver {

/// A weld locks the velocities of two links together.
inline constexpr int kWeldRows = 6;

/// Loads links, rows with the bounds they begin with, and the stiffness of the last forces.
void begin_articulation(double h, JointTables tables, Articulation& art);

/// Notes the impulses of a solution. True, with new rows or a new stiffness, if another solution is needed.
[[nodiscard]] bool begin_next_solution(double h, JointTables tables, Articulation& art);

/// Whether a body turns by more than `angle` [rad] in the substep.
[[nodiscard]] bool turns_farther(double angle, double h, const Articulation& art);

/// Whether the line of a hook that keeps a distance turns by more than that.
[[nodiscard]] bool lines_turn_farther(double angle, double h, const std::vector<state::Hook>& hooks,
                                      const Articulation& art);

void store_velocities(const Articulation& art, state::Bodies& bodies);

/// Sets the velocities to those without the joints.
void reset_velocities(Articulation& art);

/// Clamps impulses that no solution has brought within their bounds.
void clamp_impulses(Articulation& art);

/// Adds the impulses of the rows that `which` picks to the velocities of all links.
template <class Which>
void apply_rows(Which&& which, Articulation& art) {
  for (const Articulation::Joint& joint : art.joints) {
    Link& a = art.links[joint.a];
    Link& b = art.links[joint.b];
    DVec3 linear;
    DVec3 angular_a;
    DVec3 angular_b;
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      if (!which(i)) continue;
      const double lambda = art.lambda[i];
      linear += lambda * art.rows[i].n;
      angular_a += lambda * art.rows[i].j_a;
      angular_b += lambda * art.rows[i].j_b;
    }
    a.v -= a.body.inverse_mass * linear;
    a.omega_scaled -= a.response * angular_a;
    b.v += b.body.inverse_mass * linear;
    b.omega_scaled += b.response * angular_b;
  }
}

}  // namespace hooke::solver
