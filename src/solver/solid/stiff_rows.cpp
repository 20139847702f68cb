#include "solver/solid/stiff_rows.h"

#include "solver/body/body_motion.h"
#include "solver/solid/solid_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using math::Symmetric3;

/// The drag with which friction begins: a light point would stick if it slid within the cone of friction.
double first_drag(const StiffRow& row, DVec3 u, double lacks) {
  const double sliding = length(u - dot(row.normal, u) * row.normal);
  return row.friction > 0 && sliding <= row.friction * lacks ? row.stiffness : 0;
}

/// With what mass the points of a row and its body resist along the normal, each by itself [kg].
template <class OfStress>
double resisting_mass(const state::Tables& t, const StiffSystem& system, const StiffRow& row,
                      OfStress of_stress) {
  const double mass = row.corners.resisting_mass(t.particles, system.parts, of_stress);
  if (row.other.mover == StiffEnd::kNone || !(mass > 0)) return mass;
  const Real mobility = inverse_mass_at(t.bodies, row.other.body, vector_cast<Real>(row.normal),
                                        vector_cast<Real>(row.other.lever));
  return 1 / (1 / mass + static_cast<double>(mobility) / row.other.share);
}

/// A share of how a row resists in all directions [kg].
Symmetric3<double> resistance_of(const StiffRow& row, double share) {
  const DVec3 n = row.normal;
  const double along = share * (row.stiffness - row.drag);
  const double all = share * row.drag;
  return {along * n.x * n.x + all, along * n.x * n.y, along * n.x * n.z,
          along * n.y * n.y + all, along * n.y * n.z, along * n.z * n.z + all};
}

/// The velocity at which the sides part after the solution [m/s].
DVec3 parting(const StiffSystem& system, const StiffRow& row) {
  return row.before +
         row.other.leaving(system.parts, row.corners, &StiffSolution::change, &HoldingBody::change);
}

}  // namespace

void prepare_stiff_rows(const state::Tables& t, const StiffSystem& system) {
  for (StiffRow& row : system.rows) {
    take_mover(t.bodies, system.parts, row.corners, row.other);
    const double mass = resisting_mass(t, system, row, [&](const Symmetric3<double>& stress) {
      return dot(row.normal, stress * row.normal);
    });
    row.stiffness = kStiffRowShare * mass;
    // Overlaps leave slowly where stress resists them: moving a point strains what is stiff.
    if (row.least_speed > 0 && mass > 0) {
      row.least_speed *= resisting_mass(t, system, row, [](const Symmetric3<double>&) { return 0.0; }) / mass;
    }
    const double lacks = row.least_speed - dot(row.normal, row.before);
    row.pushes = row.stiffness > 0 && lacks > 0;
    row.let_go = false;
    row.carried = 0;
    row.drag = row.pushes ? first_drag(row, row.before, lacks) : 0;
  }
}

void add_row_diagonals(const StiffSystem& system) {
  for (const StiffRow& row : system.rows) {
    if (!row.pushes) continue;
    for (std::size_t k = 0; k < row.corners.count; ++k) {
      const double share = row.corners.weight[k] * row.corners.weight[k];
      Symmetric3<double>& to =
          system.parts[row.corners.part[k]]->stiff.contact_diagonal[row.corners.point[k]];
      to = to + resistance_of(row, share);
    }
    if (HoldingBody* mover = row.other.mover_of(system.parts, row.corners))
      add_mass(resistance_of(row, 1), row.other.lever, mover->tied);
  }
}

void add_row_forces(const StiffSystem& system) {
  for (const StiffRow& row : system.rows) {
    if (!row.pushes) continue;
    const DVec3 given = (row.carried + row.stiffness * row.least_speed) * row.normal;
    row.other.push(system.parts, row.corners, given - row.resistance(row.before), &StiffSolution::residual,
                   &HoldingBody::residual);
  }
}

void resist_stiff_rows(const StiffSystem& system) {
  for (const StiffRow& row : system.rows) {
    if (!row.pushes) continue;
    const DVec3 u =
        row.other.leaving(system.parts, row.corners, &StiffSolution::direction, &HoldingBody::direction);
    row.other.push(system.parts, row.corners, row.resistance(u), &StiffSolution::image, &HoldingBody::image);
  }
}

bool renew_stiff_rows(bool may_hold, const StiffSystem& system) {
  bool any = false;
  for (StiffRow& row : system.rows) {
    if (!(row.stiffness > 0)) continue;
    const DVec3 u = parting(system, row);
    const double lacks = row.least_speed - dot(row.normal, u);
    if (!row.pushes) {
      if (!may_hold || !(lacks > 0)) continue;
      if (row.let_go) {
        row.let_go = false;
        continue;
      }
      row.pushes = true;
      row.drag = first_drag(row, u, lacks);
      any = true;
      continue;
    }
    const double pushed = row.carried + row.stiffness * lacks;
    if (!(pushed > 0)) {
      row.pushes = false;
      row.let_go = true;
      row.carried = 0;
      any = true;
      continue;
    }
    if (system.error > kStiffRowsFrom) continue;
    if (std::abs(pushed - row.carried) > kStiffRowError * pushed) {
      row.carried = pushed;
      any = true;
    }
    const double speed = length(u - dot(row.normal, u) * row.normal);
    const double most = row.friction * pushed;
    double drag = most < row.stiffness * speed ? most / speed : row.friction > 0 ? row.stiffness : 0;
    if (!may_hold) drag = std::min(drag, row.drag);
    if (std::abs(drag - row.drag) > kRowFrictionError * std::max(drag, row.drag)) {
      row.drag = drag;
      any = true;
    }
  }
  return any;
}

void release_stiff_rows(Real h, const StiffSystem& system, std::span<state::ElementContact> faces,
                        state::Tables& t) {
  for (const StiffRow& row : system.rows) {
    if (row.face == StiffRow::kNone || !row.pushes) continue;
    const DVec3 given = (row.carried + row.stiffness * row.least_speed) * row.normal;
    const DVec3 impulse = given - row.resistance(parting(system, row));
    const double along = dot(row.normal, impulse);
    state::ElementContact& face = faces[row.face];
    face.normal_force = static_cast<Real>(std::max(along, 0.0)) / h;
    face.friction_force = (Real(1) / h) * vector_cast<Real>(impulse - along * row.normal);
    if (row.other.mover != StiffEnd::kNone)
      push_body(row.other.body, vector_cast<Real>(-impulse), vector_cast<Real>(row.other.lever), t.bodies);
  }
}

}  // namespace hooke::solver
