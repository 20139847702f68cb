#include "solver/solid/stiff_rows.h"

#include "solver/solid/solid_tuning.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hooke::solver {

namespace {

using math::Symmetric3;

/// Adds an impulse to the corners of a row, in vectors chosen by `of_part`.
template <class OfPart>
void push_corners(const StiffSystem& system, const StiffRow& row, DVec3 impulse, OfPart of_part) {
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<double>& to = of_part(system.parts[row.part[k]]->stiff);
    double* at = to.data() + 4 * row.point[k];
    at[0] += row.weight[k] * impulse.x;
    at[1] += row.weight[k] * impulse.y;
    at[2] += row.weight[k] * impulse.z;
  }
}

/// The velocity at which the sides part in a vector chosen by `of_part`.
template <class OfPart>
DVec3 parting(const StiffSystem& system, const StiffRow& row, OfPart of_part) {
  DVec3 u;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::vector<double>& from = of_part(system.parts[row.part[k]]->stiff);
    const double* at = from.data() + 4 * row.point[k];
    u += row.weight[k] * DVec3{at[0], at[1], at[2]};
  }
  return u;
}

const std::vector<double>& change_of(StiffSolution& stiff) {
  return stiff.change;
}
const std::vector<double>& direction_of(StiffSolution& stiff) {
  return stiff.direction;
}
std::vector<double>& residual_of(StiffSolution& stiff) {
  return stiff.residual;
}
std::vector<double>& image_of(StiffSolution& stiff) {
  return stiff.image;
}

/// With what mass the corners of a row resist, each by itself, along the normal.
double resisting_mass(const state::Particles& particles, const StiffSystem& system, const StiffRow& row,
                      bool with_stress) {
  double mobility = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const TetrahedronBlocks& part = *system.parts[row.part[k]];
    const StiffSolution& stiff = part.stiff;
    const auto inverse_mass =
        static_cast<double>(particles.velocity[part.first_particle + row.point[k]].inverse_mass);
    if (!(inverse_mass > 0)) continue;
    double mass = 1 / inverse_mass;
    if (with_stress) {
      const double* d = stiff.diagonal.data() + 8 * row.point[k];
      const Symmetric3<double> stress = {d[0], d[1], d[2], d[4], d[5], d[6]};
      mass += dot(row.normal, stress * row.normal);
    }
    mobility += row.weight[k] * row.weight[k] / mass;
  }
  return mobility > 0 ? 1 / mobility : 0;
}

/// The drag with which friction begins: a light point would stick if it slid within the cone of friction.
double first_drag(const StiffRow& row, DVec3 u, double lacks) {
  const double sliding = length(u - dot(row.normal, u) * row.normal);
  return row.friction > 0 && sliding <= row.friction * lacks ? row.stiffness : 0;
}

}  // namespace

void prepare_stiff_rows(const state::Particles& particles, const StiffSystem& system) {
  for (StiffRow& row : system.rows) {
    const double mass = resisting_mass(particles, system, row, true);
    row.stiffness = kStiffRowShare * mass;
    // Overlaps leave slowly where stress resists them: moving a point strains what is stiff.
    if (row.least_speed > 0 && mass > 0)
      row.least_speed *= resisting_mass(particles, system, row, false) / mass;
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
    for (std::size_t k = 0; k < 4; ++k) {
      const double share = row.weight[k] * row.weight[k];
      const double along = share * (row.stiffness - row.drag);
      const double all = share * row.drag;
      Symmetric3<double>& to = system.parts[row.part[k]]->stiff.contact_diagonal[row.point[k]];
      to = to + Symmetric3<double>{along * n.x * n.x + all, along * n.x * n.y, along * n.x * n.z,
                                   along * n.y * n.y + all, along * n.y * n.z, along * n.z * n.z + all};
    }
  }
}

void add_row_forces(const StiffSystem& system) {
  for (const StiffRow& row : system.rows) {
    if (!row.pushes) continue;
    const DVec3 given = (row.carried + row.stiffness * row.least_speed) * row.normal;
    push_corners(system, row, given - row.resistance(row.before), residual_of);
  }
}

void resist_stiff_rows(const StiffSystem& system) {
  for (const StiffRow& row : system.rows) {
    if (row.pushes) push_corners(system, row, row.resistance(parting(system, row, direction_of)), image_of);
  }
}

bool renew_stiff_rows(bool may_hold, const StiffSystem& system) {
  bool any = false;
  for (StiffRow& row : system.rows) {
    if (!(row.stiffness > 0)) continue;
    const DVec3 u = row.before + parting(system, row, change_of);
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
