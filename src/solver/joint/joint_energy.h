#pragma once

#include "solver/joint/articulations.h"
#include "solver/joint/joint_tuning.h"

/// \file
/// Joints take energy from one body and give it to another. Only motors, ends that move as told and the
/// energy in springs add any. A solution assumes straight motion and removes the errors that the last ones
/// left, which adds some energy here and takes some there. A body may turn far in a substep, as one of grams
/// does that hangs between tons. Then energy would grow without end: errors grow with speed, and their
/// removal is speed. So an energy account records what was added while one of the bodies of an articulation
/// turns far, or the line between the ends of a hook that keeps a distance: a bead of grams on a rail that a
/// ton on a rod swings past.

namespace hooke::solver {

/// Sums over bodies that move.
struct BodySums {
  double energy = 0;            ///< Kinetic energy [J].
  double mass = 0;              ///< [kg]
  DVec3 place = {};             ///< Center of one of the bodies [m].
  DVec3 moment = {};            ///< First moment of the masses about `place` [kg m].
  DVec3 momentum = {};          ///< [kg m/s]
  DVec3 angular_momentum = {};  ///< Angular momentum about `place` [kg m^2/s].
};

/// The sums over the bodies of an articulation.
[[nodiscard]] BodySums sum_bodies(const Articulation& articulation, const state::Bodies& bodies);

/// What a solution says about the energy of a joint.
struct JointWork {
  double work = 0;  ///< Work of motors and of ends that move as told [J].
  // Energy of its springs if all move at a share s of the velocities found: held + first s + second s^2 [J].
  double held = 0;
  double first = 0;
  double second = 0;

  /// Adds a spring of stiffness k [N/m or N m/rad] that goes from c to `next` [m or rad].
  void add_spring(double k, double c, double next) {
    held += 0.5 * k * c * c;
    first += k * c * (next - c);
    second += 0.5 * k * (next - c) * (next - c);
  }
  [[nodiscard]] double held_after(double share) const { return held + share * (first + share * second); }
};

/// Resets the account where nothing turns far, or another solver has the articulation.
void reset_energy(const Articulation& articulation, std::vector<state::Hook>& hooks);

/// Called after a solution whose joints may add `work` [J]. Removes what has been added beyond the slack, in
/// this substep and those before, from the motion of the bodies relative to a reference. That is the body
/// that nothing moves, or the common motion of all before. Returns the share of the relative motion that is
/// left.
[[nodiscard]] double take_excess(const BodySums& before, double work, const Articulation& articulation,
                                 JointTables tables);

/// Does the same where `work_of(i)` gives the JointWork of joint i. All joints hold as they did, in
/// proportion. Hooks store what was added, and what their springs should hold by now (state::Hook).
template <class WorkOf>
void balance_energy(const BodySums& before, const Articulation& articulation, JointTables tables,
                    WorkOf&& work_of) {
  double work = 0;
  for (std::size_t i = 0; i < articulation.joints.size(); ++i) {
    if (articulation.joints[i].is_weld()) continue;
    const JointWork joint = work_of(i);
    const double held = tables.hooks[articulation.joints[i].hook].spring_energy;
    work += joint.work + (held < 0 ? joint.held : held) - joint.held_after(1);
  }
  const double share = take_excess(before, work, articulation, tables);
  for (std::size_t i = 0; i < articulation.joints.size(); ++i) {
    if (articulation.joints[i].is_weld()) continue;
    tables.hooks[articulation.joints[i].hook].spring_energy = work_of(i).held_after(share);
  }
}

}  // namespace hooke::solver
