#include "solver/solid/stiff_solution.h"

#include "base/assert.h"
#include "solver/solid/solid_tuning.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using Six = HoldingBody::Six;

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
double product(const Six& a, const Six& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}
Six product(const std::array<Six, 6>& m, const Six& v) {
  Six result = {};
  for (std::size_t i = 0; i < 6; ++i) result[i] = product(m[i], v);
  return result;
}

/// Factors L D L^T in place: L below the diagonal, 1 / D on it. What nearly nothing resists stays at rest.
void factorize(std::array<Six, 6>& m) {
  constexpr double kLeastPivot = 1e-12;
  Six d = {};
  for (std::size_t j = 0; j < 6; ++j) {
    const double whole = m[j][j];
    d[j] = whole;
    for (std::size_t k = 0; k < j; ++k) d[j] -= m[j][k] * m[j][k] * d[k];
    const double inverse = d[j] > kLeastPivot * whole ? 1 / d[j] : 0;
    for (std::size_t i = j + 1; i < 6; ++i) {
      for (std::size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k] * d[k];
      m[i][j] *= inverse;
    }
    m[j][j] = inverse;
  }
}

Six solved(const std::array<Six, 6>& factor, Six x) {
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= factor[i][k] * x[k];
  }
  for (std::size_t i = 6; i-- > 0;) {
    x[i] *= factor[i][i];
    for (std::size_t k = i + 1; k < 6; ++k) x[i] -= factor[k][i] * x[k];
  }
  return x;
}

/// The part of the diagonal that rows of stress and of contact give.
Symmetric3<double> diagonal_of(const StiffSolution& stiff, std::size_t i) {
  return stress_diagonal(stiff, i) + stiff.contact_diagonal[i];
}

const PressedPoint* pressed_point(const TetrahedronBlocks& tetrahedra, std::size_t i) {
  const std::uint32_t pressed = tetrahedra.pressed_of[i];
  return pressed != 0 ? &tetrahedra.pressed[pressed - 1] : nullptr;
}

/// The projection on the directions across which a point is held.
Symmetric3<double> held_of(const PressedPoint& point) {
  const Symmetric3<double>& f = point.free;
  return {1 - f.xx, -f.xy, -f.xz, 1 - f.yy, -f.yz, 1 - f.zz};
}

/// F M F for symmetric matrices.
Symmetric3<double> sandwich(const Symmetric3<double>& f, const Symmetric3<double>& m) {
  const DVec3 x = f * (m * (f * DVec3{1, 0, 0}));
  const DVec3 y = f * (m * (f * DVec3{0, 1, 0}));
  const DVec3 z = f * (m * (f * DVec3{0, 0, 1}));
  return {x.x, x.y, x.z, y.y, y.z, z.z};
}

/// The inverse of M in the directions in which a point is free, and 0 across them.
Symmetric3<double> inverse_within(const PressedPoint& point, const Symmetric3<double>& m) {
  const double size = m.xx + m.yy + m.zz;
  const Symmetric3<double> p = held_of(point);
  const Symmetric3<double> rest = {size * p.xx, size * p.xy, size * p.xz,
                                   size * p.yy, size * p.yz, size * p.zz};
  return sandwich(point.free, math::inverse(sandwich(point.free, m) + rest));
}

/// The body that moves a point, null if there is none.
HoldingBody* mover_of(StiffSolution& stiff, const PressedPoint& point) {
  return point.mover == PressedPoint::kNone ? nullptr : &stiff.holders[point.mover];
}

/// The part of a change or a direction by which a point slides.
DVec3 slip_of(const PressedPoint& point, DVec3 of_point, const HoldingBody* mover, const Six& of_mover) {
  return mover != nullptr ? of_point - velocity_at(of_mover, point.lever) : of_point;
}

/// Takes masses, and what preconditions the particles and the bodies that hold some.
void take_masses(TetrahedronBlocks& tetrahedra, const state::Particles& particles) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (HoldingBody& body : stiff.holders) {
    body.factor = body.own_factor = body.mass;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < 6; ++k) body.factor[i][k] += body.tied[i][k];
    }
    factorize(body.own_factor);
  }
  for (std::size_t i = 0; i < stiff.mass.size(); ++i) {
    stiff.mass[i] = {};
    stiff.per_diagonal[i] = {};
    const Real inverse_mass = particles.velocity[tetrahedra.first_particle + i].inverse_mass;
    if (!(inverse_mass > Real(0)) || !(tetrahedra.volume_at[i] > Real(0))) continue;
    const PressedPoint* point = pressed_point(tetrahedra, i);
    if (point == nullptr) {
      stiff.mass[i] = Symmetric3<double>::diagonal(1 / static_cast<double>(inverse_mass));
      stiff.per_diagonal[i] = math::inverse(stiff.mass[i] + diagonal_of(stiff, i));
      continue;
    }
    stiff.mass[i] = math::inverse(point->answer);
    const Symmetric3<double> resisting = stiff.mass[i] + diagonal_of(stiff, i);
    stiff.per_diagonal[i] = inverse_within(*point, resisting + point->drag);
    if (HoldingBody* mover = mover_of(stiff, *point))
      add_mass(sandwich(point->follows, resisting), point->lever, mover->factor);
  }
  for (HoldingBody& body : stiff.holders) factorize(body.factor);
}

/// Finds what the residual asks for by itself, in the place of `image` and `wanted`, and its size.
double precondition(TetrahedronBlocks& tetrahedra) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (std::size_t i = 0; i < stiff.mass.size(); ++i)
    set(stiff.per_diagonal[i] * at(stiff.residual, i), i, stiff.image);
  for (HoldingBody& body : stiff.holders) body.wanted = body.residual;
  double size = 0;
  for (const PressedPoint& point : tetrahedra.pressed) {
    const std::size_t i = point.particle - tetrahedra.first_particle;
    const DVec3 own = at(stiff.image, i) + stiff.per_diagonal[i] * point.drag_lacks;
    set(own, i, stiff.image);
    size += dot(own, point.drag_lacks);
    if (HoldingBody* mover = mover_of(stiff, point))
      add_impulse(point.follows * at(stiff.residual, i), point.lever, mover->wanted);
  }
  for (HoldingBody& body : stiff.holders) {
    const Six lacks = body.moves ? body.wanted : Six{};
    body.error = product(lacks, solved(body.own_factor, lacks));
    body.wanted = solved(body.factor, lacks);
    size += product(body.wanted, body.residual);
  }
  for (const PressedPoint& point : tetrahedra.pressed) {
    const HoldingBody* mover = mover_of(stiff, point);
    if (mover == nullptr) continue;
    const std::size_t i = point.particle - tetrahedra.first_particle;
    set(at(stiff.image, i) + point.follows * velocity_at(mover->wanted, point.lever), i, stiff.image);
  }
  return size + product(stiff.residual, stiff.image);
}

DVec3 slip_along(TetrahedronBlocks& tetrahedra, const PressedPoint& point) {
  const HoldingBody* mover = mover_of(tetrahedra.stiff, point);
  const DVec3 direction = at(tetrahedra.stiff.direction, point.particle - tetrahedra.first_particle);
  return slip_of(point, direction, mover, mover != nullptr ? mover->direction : Six{});
}

/// Adds to the image of the direction what masses resist, and returns the work of all along it.
double add_masses(TetrahedronBlocks& tetrahedra) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (std::size_t i = 0; i < stiff.mass.size(); ++i)
    set(at(stiff.image, i) + stiff.mass[i] * at(stiff.direction, i), i, stiff.image);
  double curvature = product(stiff.direction, stiff.image);
  for (const HoldingBody& body : stiff.holders) {
    curvature +=
        product(body.direction, product(body.mass, body.direction)) + product(body.direction, body.image);
  }
  for (const PressedPoint& point : tetrahedra.pressed) {
    const DVec3 slip = slip_along(tetrahedra, point);
    curvature += dot(slip, point.drag * slip);
  }
  return curvature;
}

/// Begins one part with the change so far, and with `start` for points that a contact has taken hold of.
/// Returns whether any point changes its velocity.
bool look_back(TetrahedronBlocks& tetrahedra) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (const PressedPoint& point : tetrahedra.pressed) {
    HoldingBody* holder = stiff.find_holder(point.holder);
    if (holder == nullptr) continue;
    const std::size_t i = point.particle - tetrahedra.first_particle;
    const DVec3 held = point.start + velocity_at(holder->change, point.lever);
    set(point.free * at(stiff.change, i) + held_of(point) * held, i, stiff.change);
  }
  stiff.direction = stiff.change;
  std::fill(stiff.image.begin(), stiff.image.end(), 0.0);
  for (HoldingBody& body : stiff.holders) {
    body.direction = body.change;
    body.image = {};
    body.tied = {};
  }
  const auto is_any = [](double v) { return v != 0; };
  return std::any_of(stiff.change.begin(), stiff.change.end(), is_any) ||
         std::any_of(stiff.holders.begin(), stiff.holders.end(), [&](const HoldingBody& body) {
           return std::any_of(body.change.begin(), body.change.end(), is_any);
         });
}

/// Finds what one part lacks without its contacts with other solids.
void find_residual(TetrahedronBlocks& tetrahedra) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (std::size_t i = 0; i < stiff.mass.size(); ++i) {
    const DVec3 lacks = at(stiff.force, i) - at(stiff.image, i);
    DVec3 change = at(stiff.change, i);
    if (const PressedPoint* point = pressed_point(tetrahedra, i)) change -= point->others_start;
    set(lacks - stiff.mass[i] * change, i, stiff.residual);
  }
  for (PressedPoint& point : tetrahedra.pressed) {
    const HoldingBody* mover = mover_of(stiff, point);
    const DVec3 change = at(stiff.change, point.particle - tetrahedra.first_particle);
    const DVec3 slip = slip_of(point, change, mover, mover != nullptr ? mover->change : Six{});
    point.drag_lacks = -(point.drag * (point.sliding + slip));
  }
  for (HoldingBody& body : stiff.holders) {
    body.residual = product(body.mass, body.change);
    for (std::size_t k = 0; k < 6; ++k) body.residual[k] = -(body.residual[k] + body.image[k]);
  }
}

/// Goes along the direction of one part.
void go_along(double share, TetrahedronBlocks& tetrahedra) {
  StiffSolution& stiff = tetrahedra.stiff;
  for (std::size_t i = 0; i < stiff.change.size(); ++i) {
    stiff.change[i] += share * stiff.direction[i];
    stiff.residual[i] -= share * stiff.image[i];
  }
  for (PressedPoint& point : tetrahedra.pressed)
    point.drag_lacks -= share * (point.drag * slip_along(tetrahedra, point));
  for (HoldingBody& body : stiff.holders) {
    const Six image = product(body.mass, body.direction);
    for (std::size_t k = 0; k < 6; ++k) {
      body.change[k] += share * body.direction[k];
      body.residual[k] -= share * (image[k] + body.image[k]);
    }
  }
}

/// Turns the direction of one part to what the residual asks for, and keeps a share of the one before.
void turn_direction(double kept, StiffSolution& stiff) {
  for (std::size_t i = 0; i < stiff.direction.size(); ++i) {
    stiff.direction[i] = stiff.image[i] + kept * stiff.direction[i];
    stiff.image[i] = 0;
  }
  for (HoldingBody& body : stiff.holders) {
    for (std::size_t k = 0; k < 6; ++k) body.direction[k] = body.wanted[k] + kept * body.direction[k];
    body.image = {};
  }
}

/// Whether what is lacking of an impulse is more than a share of the change that it makes. `lacking` and
/// `changing` are energies: squares of impulses over the mass that they move.
bool lacks_impulse(double error, double lacking, double changing) {
  const double most = std::max(kMotionError, error);
  return lacking > most * most * changing;
}

/// Whether a body or a solid as a whole lacks so much of its impulse that it would move otherwise than its
/// points do, or not keep its momentum. Points of steel resist with a million times their mass, so that
/// little of the residual says so.
bool lacks_motion(double error, const TetrahedronBlocks& tetrahedra) {
  const StiffSolution& stiff = tetrahedra.stiff;
  for (const HoldingBody& body : stiff.holders) {
    if (lacks_impulse(error, body.error, product(body.change, product(body.mass, body.change)))) return true;
  }
  if (stiff.is_anchored) return false;
  DVec3 lacking;
  double changing = 0;
  double mass = 0;
  for (std::size_t i = 0; i < stiff.mass.size(); ++i) {
    const DVec3 change = at(stiff.change, i);
    // Of a point that is held the residual is what its holder gives, and of one that slides also friction.
    const PressedPoint* point = pressed_point(tetrahedra, i);
    lacking +=
        point != nullptr ? point->free * (at(stiff.residual, i) + point->drag_lacks) : at(stiff.residual, i);
    changing += dot(change, stiff.mass[i] * change);
    mass += stiff.mass[i].xx;
  }
  return lacks_impulse(error, dot(lacking, lacking) / mass, changing);
}

/// Whether something that does not move holds points, as a pin does: it may give any impulse.
bool is_anchored(const TetrahedronBlocks& tetrahedra, const state::Particles& particles) {
  for (std::size_t i = 0; i < tetrahedra.volume_at.size(); ++i) {
    const bool is_pinned = !(particles.velocity[tetrahedra.first_particle + i].inverse_mass > Real(0));
    if (is_pinned && tetrahedra.volume_at[i] > Real(0)) return true;
  }
  return std::any_of(tetrahedra.pressed.begin(), tetrahedra.pressed.end(), [](const PressedPoint& point) {
    return point.held != 0 && point.mover == PressedPoint::kNone;
  });
}

/// The sum over the parts of what `work` returns.
template <class Work>
double sum_of_parts(const StiffSystem& system, Work work) {
  double sum = 0;
  for (TetrahedronBlocks* part : system.parts) sum += work(*part);
  return sum;
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
  stiff.contact_diagonal.assign(count, {});
  stiff.mass.resize(count);
  stiff.per_diagonal.resize(count);
}

bool look_back(const StiffSystem& system) {
  bool any = false;
  for (TetrahedronBlocks* part : system.parts) any = look_back(*part) || any;
  return any;
}

void aim(const state::Particles& particles, StiffSystem& system) {
  for (TetrahedronBlocks* part : system.parts)
    std::fill(part->stiff.contact_diagonal.begin(), part->stiff.contact_diagonal.end(), Symmetric3<double>{});
  add_row_diagonals(system);
  add_tie_diagonals(system);
  for (TetrahedronBlocks* part : system.parts) {
    take_masses(*part, particles);
    find_residual(*part);
    part->stiff.is_anchored = is_anchored(*part, particles);
  }
  add_row_forces(system);
  add_tie_forces(system);
  for (const StiffTie& tie : system.ties) {
    if (tie.other.mover == StiffEnd::kNone) system.parts[tie.points.part[0]]->stiff.is_anchored = true;
  }
  system.size = sum_of_parts(system, precondition);
  if (!(system.first_size > 0)) system.first_size = system.size;
  for (TetrahedronBlocks* part : system.parts) turn_direction(0, part->stiff);
}

bool needs_direction(const StiffSystem& system) {
  if (system.solutions >= kMostStiffSolidDirections || !(system.size > 0)) return false;
  return system.size > system.error * system.error * system.first_size ||
         std::any_of(system.parts.begin(), system.parts.end(),
                     [&](const TetrahedronBlocks* part) { return lacks_motion(system.error, *part); });
}

bool may_solve_again(const StiffSystem& system) {
  return 2 * system.solutions < kMostStiffSolidDirections;
}

bool sharpen(StiffSystem& system) {
  if (system.error <= kStiffSolidError) return false;
  system.error = std::max(kStiffSolidError, kStiffSolidErrorFall * system.error);
  return true;
}

bool is_solved(const StiffSystem& system) {
  return system.error <= kStiffSolidError && system.solutions < kMostStiffSolidDirections;
}

void advance(StiffSystem& system) {
  const double curvature = sum_of_parts(system, add_masses);
  ++system.solutions;
  if (!(curvature > 0)) {
    system.size = 0;
    return;
  }
  for (TetrahedronBlocks* part : system.parts) go_along(system.size / curvature, *part);
  const double size = sum_of_parts(system, precondition);
  for (TetrahedronBlocks* part : system.parts) turn_direction(size / system.size, part->stiff);
  system.size = size;
}

void find_pressed_impulses(TetrahedronBlocks& tetrahedra) {
  const StiffSolution& stiff = tetrahedra.stiff;
  for (PressedPoint& point : tetrahedra.pressed) {
    const std::size_t i = point.particle - tetrahedra.first_particle;
    point.change = at(stiff.change, i);
    point.impulse = at(stiff.residual, i) + stiff.mass[i] * (point.change - point.others_start);
    const auto resisting = diagonal_of(stiff, i);
    point.yielding = std::min(
        1.0, 3 / (static_cast<double>(point.inverse_mass) * (resisting.xx + resisting.yy + resisting.zz)));
  }
}

void finish_stiff_solution(bool converged, TetrahedronBlocks& tetrahedra, state::Particles& particles) {
  StiffSolution& stiff = tetrahedra.stiff;
  stiff.unconverged = stiff.unconverged || !converged;
  for (std::size_t i = 0; i < stiff.mass.size(); ++i) {
    if (tetrahedra.pressed_of[i] != 0) continue;
    particles.velocity[tetrahedra.first_particle + i].v += vector_cast<Real>(at(stiff.change, i));
  }
}

}  // namespace hooke::solver
