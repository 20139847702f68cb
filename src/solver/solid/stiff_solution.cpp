#include "solver/solid/stiff_solution.h"

#include "base/assert.h"
#include "solver/solid/solid_tuning.h"

#include <algorithm>
#include <cstddef>

namespace hooke::solver {

namespace {

DVec3 at(const std::vector<double>& of, std::size_t i) {
  return {of[4 * i], of[4 * i + 1], of[4 * i + 2]};
}
void set(DVec3 v, std::size_t i, std::vector<double>& of) {
  of[4 * i] = v.x;
  of[4 * i + 1] = v.y;
  of[4 * i + 2] = v.z;
}
double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The part of the diagonal that the rows give.
math::Symmetric3<double> diagonal_of(const StiffSolution& stiff, std::size_t i) {
  const double* d = stiff.diagonal.data() + 8 * i;
  return {d[0], d[1], d[2], d[4], d[5], d[6]};
}

/// The change of a particle's velocity so far, without what its contacts began with.
DVec3 own_change(const TetrahedronBlocks& tetrahedra, std::size_t i) {
  const DVec3 change = at(tetrahedra.stiff.change, i);
  const std::uint32_t pressed = tetrahedra.pressed_of[i];
  return pressed != 0 ? change - tetrahedra.pressed[pressed - 1].start : change;
}

DVec3 friction_on(const TetrahedronBlocks& tetrahedra, std::size_t i) {
  const std::uint32_t pressed = tetrahedra.pressed_of[i];
  return pressed != 0 ? tetrahedra.pressed[pressed - 1].friction : DVec3{};
}

void take_masses(TetrahedronBlocks& tetrahedra, const state::Particles& particles) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (std::size_t i = 0; i < stiff.mass.size(); ++i) {
    stiff.mass[i] = {};
    stiff.per_diagonal[i] = {};
    const Real inverse_mass = particles.velocity[tetrahedra.first_particle + i].inverse_mass;
    if (!(inverse_mass > Real(0)) || !(tetrahedra.volume_at[i] > Real(0))) continue;
    const std::uint32_t pressed = tetrahedra.pressed_of[i];
    stiff.mass[i] = pressed != 0 ? math::inverse(tetrahedra.pressed[pressed - 1].answer)
                                 : math::Symmetric3<double>::diagonal(1 / static_cast<double>(inverse_mass));
    stiff.per_diagonal[i] = math::inverse(stiff.mass[i] + diagonal_of(stiff, i));
  }
}

/// Finds what the residual asks for by itself, in the place of `image`, and its size.
double precondition(StiffSolution& stiff) {
  for (std::size_t i = 0; i < stiff.mass.size(); ++i)
    set(stiff.per_diagonal[i] * at(stiff.residual, i), i, stiff.image);
  return product(stiff.residual, stiff.image);
}

}  // namespace

void begin_stiff_solution(TetrahedronBlocks& tetrahedra) {
  StiffSolution& stiff = tetrahedra.stiff;
  const std::size_t count = tetrahedra.volume_at.size();
  stiff.stress.resize(tetrahedra.blocks.size());
  stiff.force.assign(4 * count, 0);
  stiff.change.assign(4 * count, 0);
  stiff.residual.assign(4 * count, 0);
  stiff.direction.assign(4 * count, 0);
  stiff.image.assign(4 * count, 0);
  stiff.diagonal.assign(8 * count, 0);
  stiff.mass.resize(count);
  stiff.per_diagonal.resize(count);
  stiff.first_size = 0;
  stiff.solutions = 0;
}

void aim(TetrahedronBlocks& tetrahedra, const state::Particles& particles) {
  StiffSolution& stiff = tetrahedra.stiff;
  take_masses(tetrahedra, particles);
  for (std::size_t i = 0; i < stiff.mass.size(); ++i) {
    const DVec3 given = at(stiff.force, i) + friction_on(tetrahedra, i) - at(stiff.image, i);
    set(given - stiff.mass[i] * own_change(tetrahedra, i), i, stiff.residual);
  }
  stiff.size = precondition(stiff);
  if (!(stiff.first_size > 0)) stiff.first_size = stiff.size;
  stiff.direction = stiff.image;
  std::fill(stiff.image.begin(), stiff.image.end(), 0.0);
}

bool needs_direction(const TetrahedronBlocks& tetrahedra) {
  const StiffSolution& stiff = tetrahedra.stiff;
  return stiff.size > kStiffSolidError * kStiffSolidError * stiff.first_size &&
         stiff.solutions < kMostStiffSolidDirections;
}

void advance(TetrahedronBlocks& tetrahedra) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (std::size_t i = 0; i < stiff.mass.size(); ++i)
    set(at(stiff.image, i) + stiff.mass[i] * at(stiff.direction, i), i, stiff.image);
  const double curvature = product(stiff.direction, stiff.image);
  ++stiff.solutions;
  if (!(curvature > 0)) {
    stiff.size = 0;
    return;
  }
  const double along = stiff.size / curvature;
  for (std::size_t i = 0; i < stiff.change.size(); ++i) {
    stiff.change[i] += along * stiff.direction[i];
    stiff.residual[i] -= along * stiff.image[i];
  }
  const double size = precondition(stiff);
  const double kept = size / stiff.size;
  stiff.size = size;
  for (std::size_t i = 0; i < stiff.direction.size(); ++i) {
    stiff.direction[i] = stiff.image[i] + kept * stiff.direction[i];
    stiff.image[i] = 0;
  }
}

void find_pressed_impulses(TetrahedronBlocks& tetrahedra) {
  const StiffSolution& stiff = tetrahedra.stiff;
  for (PressedPoint& point : tetrahedra.pressed) {
    const std::size_t i = point.particle - tetrahedra.first_particle;
    point.change = at(stiff.change, i);
    point.impulse = at(stiff.residual, i) + stiff.mass[i] * own_change(tetrahedra, i) - point.friction;
    const auto resisting = diagonal_of(stiff, i);
    point.yielding = std::min(
        1.0, 3 / (static_cast<double>(point.inverse_mass) * (resisting.xx + resisting.yy + resisting.zz)));
  }
}

bool look_back(TetrahedronBlocks& tetrahedra) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (PressedPoint& point : tetrahedra.pressed) {
    if (point.is_new_hold) set(point.start, point.particle - tetrahedra.first_particle, stiff.change);
    point.is_new_hold = false;
  }
  stiff.direction = stiff.change;
  std::fill(stiff.image.begin(), stiff.image.end(), 0.0);
  return std::any_of(stiff.change.begin(), stiff.change.end(), [](double v) { return v != 0; });
}

void finish_stiff_solution(TetrahedronBlocks& tetrahedra, state::Particles& particles) {
  StiffSolution& stiff = tetrahedra.stiff;
  stiff.unconverged = stiff.unconverged || stiff.solutions >= kMostStiffSolidDirections;
  for (std::size_t i = 0; i < stiff.mass.size(); ++i) {
    if (tetrahedra.pressed_of[i] != 0) continue;
    particles.velocity[tetrahedra.first_particle + i].v += vector_cast<Real>(at(stiff.change, i));
  }
}

}  // namespace hooke::solver
