#include "solver/solid/stiff_ties.h"

#include "solver/solid/stiff_rows.h"
#include "state/bodies.h"

#include <cstddef>
#include <vector>

namespace hooke::solver {

namespace {

using math::Symmetric3;

/// The solution that has the body of a hook, that of its first point's part.
StiffSolution& solution_of(const StiffSystem& system, const StiffTie& tie) {
  return system.parts[tie.points.part[0]]->stiff;
}

/// The body that a hook holds, null if the other end does not give way.
HoldingBody* mover_of(const StiffSystem& system, const StiffTie& tie) {
  return tie.mover == StiffTie::kNone ? nullptr : &solution_of(system, tie).holders[tie.mover];
}

/// The velocity at which the points leave the other end, in a vector and the six numbers of bodies.
DVec3 leaving(const StiffSystem& system, const StiffTie& tie, std::vector<double> StiffSolution::*of_points,
              HoldingBody::Six HoldingBody::*of_bodies) {
  const DVec3 u = tie.points.sum(system.parts, of_points);
  const HoldingBody* mover = mover_of(system, tie);
  return mover != nullptr ? u - velocity_at(mover->*of_bodies, tie.lever) : u;
}

/// Adds an impulse to the points of a hook, and the opposite one to the body.
void push_ends(const StiffSystem& system, const StiffTie& tie, DVec3 impulse,
               std::vector<double> StiffSolution::*to_points, HoldingBody::Six HoldingBody::*to_bodies) {
  tie.points.push(system.parts, impulse, to_points);
  if (HoldingBody* mover = mover_of(system, tie)) add_impulse(-impulse, tie.lever, mover->*to_bodies);
}

DVec3 impulse_of(const StiffSystem& system, const StiffTie& tie) {
  return tie.carried -
         tie.stiffness * (tie.before + leaving(system, tie, &StiffSolution::change, &HoldingBody::change));
}

}  // namespace

HoldingBody holding_body(const state::Bodies& bodies, std::uint32_t body, double share) {
  HoldingBody holder = {.body = body, .moves = state::gives_way(bodies, body)};
  if (!holder.moves) return holder;
  const double mass = share / static_cast<double>(bodies.motion[body].inverse_mass);
  const Symmetric3<double> root = math::inverse(math::in_double(bodies.scale[body]));
  for (std::size_t k = 0; k < 3; ++k) {
    holder.mass[k][k] = mass;
    const DVec3 axis = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
    const DVec3 inertia = share * (root * (root * axis));
    holder.mass[3][3 + k] = inertia.x;
    holder.mass[4][3 + k] = inertia.y;
    holder.mass[5][3 + k] = inertia.z;
  }
  return holder;
}

void prepare_ties(const state::Tables& t, const StiffSystem& system) {
  for (StiffTie& tie : system.ties) {
    tie.stiffness = kStiffRowShare * tie.points.resisting_mass(
                                         t.particles, system.parts, [](const Symmetric3<double>& stress) {
                                           return (stress.xx + stress.yy + stress.zz) / 3;
                                         });
    tie.carried = {};
    tie.mover = StiffTie::kNone;
    if (tie.body == StiffTie::kNone) continue;
    StiffSolution& stiff = solution_of(system, tie);
    if (stiff.find_holder(tie.body) == nullptr)
      stiff.holders.push_back(holding_body(t.bodies, tie.body, tie.share));
    const HoldingBody* holder = stiff.find_holder(tie.body);
    if (holder->moves) tie.mover = static_cast<std::uint32_t>(holder - stiff.holders.data());
  }
}

void add_tie_diagonals(const StiffSystem& system) {
  for (const StiffTie& tie : system.ties) {
    const auto& points = tie.points;
    for (std::size_t k = 0; k < points.count; ++k) {
      Symmetric3<double>& to = system.parts[points.part[k]]->stiff.contact_diagonal[points.point[k]];
      to = to + Symmetric3<double>::diagonal(points.weight[k] * points.weight[k] * tie.stiffness);
    }
    if (HoldingBody* mover = mover_of(system, tie))
      add_mass(Symmetric3<double>::diagonal(tie.stiffness), tie.lever, mover->tied);
  }
}

void add_tie_forces(const StiffSystem& system) {
  for (const StiffTie& tie : system.ties) {
    push_ends(system, tie, tie.carried - tie.stiffness * tie.before, &StiffSolution::residual,
              &HoldingBody::residual);
  }
}

void resist_ties(const StiffSystem& system) {
  for (const StiffTie& tie : system.ties) {
    const DVec3 u = leaving(system, tie, &StiffSolution::direction, &HoldingBody::direction);
    push_ends(system, tie, tie.stiffness * u, &StiffSolution::image, &HoldingBody::image);
  }
}

bool renew_ties(const StiffSystem& system) {
  bool any = false;
  for (StiffTie& tie : system.ties) {
    const DVec3 impulse = impulse_of(system, tie);
    if (!(length(impulse - tie.carried) > kStiffRowError * length(impulse))) continue;
    tie.carried = impulse;
    any = true;
  }
  return any;
}

void release_ties(const StiffSystem& system, state::Particles& particles) {
  for (const StiffTie& tie : system.ties) {
    const DVec3 impulse = impulse_of(system, tie);
    const auto& points = tie.points;
    for (std::size_t k = 0; k < points.count; ++k) {
      state::VelocityRecord& record =
          particles.velocity[system.parts[points.part[k]]->first_particle + points.point[k]];
      record.v -= vector_cast<Real>((points.weight[k] * static_cast<double>(record.inverse_mass)) * impulse);
    }
  }
}

}  // namespace hooke::solver
