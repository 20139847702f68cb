#include "solver/solid/stiff_rows.h"

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

}  // namespace

void prepare_stiff_rows(const state::Particles& particles, const StiffSystem& system) {
  for (StiffRow& row : system.rows) {
    const double mass = row.corners.resisting_mass(
        particles, system.parts,
        [&](const Symmetric3<double>& stress) { return dot(row.normal, stress * row.normal); });
    row.stiffness = kStiffRowShare * mass;
    // Overlaps leave slowly where stress resists them: moving a point strains what is stiff.
    if (row.least_speed > 0 && mass > 0) {
      row.least_speed *= row.corners.resisting_mass(particles, system.parts, [](const Symmetric3<double>&) {
        return 0.0;
      }) / mass;
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
    const DVec3 n = row.normal;
    for (std::size_t k = 0; k < row.corners.count; ++k) {
      const double share = row.corners.weight[k] * row.corners.weight[k];
      const double along = share * (row.stiffness - row.drag);
      const double all = share * row.drag;
      Symmetric3<double>& to =
          system.parts[row.corners.part[k]]->stiff.contact_diagonal[row.corners.point[k]];
      to = to + Symmetric3<double>{along * n.x * n.x + all, along * n.x * n.y, along * n.x * n.z,
                                   along * n.y * n.y + all, along * n.y * n.z, along * n.z * n.z + all};
    }
  }
}

void add_row_forces(const StiffSystem& system) {
  for (const StiffRow& row : system.rows) {
    if (!row.pushes) continue;
    const DVec3 given = (row.carried + row.stiffness * row.least_speed) * row.normal;
    row.corners.push(system.parts, given - row.resistance(row.before), &StiffSolution::residual);
  }
}

void resist_stiff_rows(const StiffSystem& system) {
  for (const StiffRow& row : system.rows) {
    if (!row.pushes) continue;
    const DVec3 u = row.corners.sum(system.parts, &StiffSolution::direction);
    row.corners.push(system.parts, row.resistance(u), &StiffSolution::image);
  }
}

bool renew_stiff_rows(bool may_hold, const StiffSystem& system) {
  bool any = false;
  for (StiffRow& row : system.rows) {
    if (!(row.stiffness > 0)) continue;
    const DVec3 u = row.before + row.corners.sum(system.parts, &StiffSolution::change);
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

}  // namespace hooke::solver
