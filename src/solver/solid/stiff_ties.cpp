#include "solver/solid/stiff_ties.h"

#include "solver/solid/stiff_rows.h"
#include "state/bodies.h"

#include <cstddef>
#include <vector>

namespace hooke::solver {

namespace {

using math::Symmetric3;

DVec3 impulse_of(const StiffSystem& system, const StiffTie& tie) {
  const DVec3 change =
      tie.other.leaving(system.parts, tie.points, &StiffSolution::change, &HoldingBody::change);
  return tie.carried - tie.stiffness * (tie.before + change);
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
    take_mover(t.bodies, system.parts, tie.points, tie.other);
  }
}

void add_tie_diagonals(const StiffSystem& system) {
  for (const StiffTie& tie : system.ties) {
    const auto& points = tie.points;
    for (std::size_t k = 0; k < points.count; ++k) {
      Symmetric3<double>& to = system.parts[points.part[k]]->stiff.contact_diagonal[points.point[k]];
      to = to + Symmetric3<double>::diagonal(points.weight[k] * points.weight[k] * tie.stiffness);
    }
    if (HoldingBody* mover = tie.other.mover_of(system.parts, points))
      add_mass(Symmetric3<double>::diagonal(tie.stiffness), tie.other.lever, mover->tied);
  }
}

void add_tie_forces(const StiffSystem& system) {
  for (const StiffTie& tie : system.ties) {
    tie.other.push(system.parts, tie.points, tie.carried - tie.stiffness * tie.before,
                   &StiffSolution::residual, &HoldingBody::residual);
  }
}

void resist_ties(const StiffSystem& system) {
  for (const StiffTie& tie : system.ties) {
    const DVec3 u =
        tie.other.leaving(system.parts, tie.points, &StiffSolution::direction, &HoldingBody::direction);
    tie.other.push(system.parts, tie.points, tie.stiffness * u, &StiffSolution::image, &HoldingBody::image);
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
