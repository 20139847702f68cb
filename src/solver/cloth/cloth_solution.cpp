#include "solver/cloth/cloth_solution.h"

#include "base/assert.h"
#include "solver/cloth/cloth_tuning.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::SpringClass;
using state::SpringForm;

/// q of an isometric bend, or its rate.
template <class Bend>
DVec3 weighted_sum(const Bend& bend, std::span<const DVec3> of) {
  DVec3 sum;
  for (std::size_t k = 0; k < 4; ++k) sum += bend.weight[k] * of[bend.points[k]];
  return sum;
}

}  // namespace

void ClothSolution::take_points(const state::Deformable& cloth, std::span<const Vec3> unsprung,
                                const state::Tables& tables) {
  points_ = cloth.particles.count;
  HOOKE_ASSERT(unsprung.size() == points_);
  unsprung_.resize(points_);
  x_.resize(points_);
  v_.resize(points_);
  mass_.resize(points_);
  is_held_ = false;
  for (std::size_t i = 0; i < points_; ++i) {
    const state::VelocityRecord& record = tables.particles.velocity[cloth.particles.first + i];
    unsprung_[i] = vector_cast<double>(unsprung[i]);
    x_[i] = vector_cast<double>(tables.particles.position[cloth.particles.first + i].x);
    v_[i] = vector_cast<double>(record.v);
    mass_[i] = record.inverse_mass > Real(0) ? 1 / static_cast<double>(record.inverse_mass) : 0;
    const auto own_mass = static_cast<double>(tables.particles.mass[cloth.particles.first + i]);
    is_held_ = is_held_ || !(mass_[i] > 0) || mass_[i] > kMassThatHolds * own_mass;
  }
}

/// Makes room for all unknowns, points and bodies.
void ClothSolution::set_sizes() {
  const std::size_t count = unsprung_.size();
  v_.insert(v_.end(), unsprung_.begin() + static_cast<std::ptrdiff_t>(points_), unsprung_.end());
  change_.resize(count);
  trial_.resize(count);
  residual_.resize(count);
  wanted_.resize(count);
  direction_.resize(count);
  image_.resize(count);
  per_diagonal_.resize(count);
}

void ClothSolution::take_springs(const state::Deformable& cloth, const state::Springs& springs) {
  const auto end = mass_.begin() + static_cast<std::ptrdiff_t>(points_);
  rigid_ =
      kRigidOfCloth * (std::accumulate(mass_.begin(), end, 0.0) + bodies_.mass() + loads_.mass()) / (h_ * h_);
  springs_.clear();
  std::ptrdiff_t limited = 0;  // Limits stand in the order of the springs that they belong to.
  for (std::uint32_t row = cloth.springs.first; row < cloth.springs.end(); ++row) {
    const SpringClass kind = springs.kind[row];
    if (kind == SpringClass::kTether) continue;
    const std::uint32_t a = springs.particle_a[row] - cloth.particles.first;
    const std::uint32_t b = springs.particle_b[row] - cloth.particles.first;
    const auto rest_length = static_cast<double>(springs.rest_length[row]);
    if (kind == SpringClass::kLimit) {
      const auto limits = [&](const Spring& spring) { return spring.a == a && spring.b == b; };
      const auto found = std::find_if(springs_.begin() + limited, springs_.end(), limits);
      if (found != springs_.end()) {
        found->most_length = rest_length;
        limited = std::distance(springs_.begin(), found);
      } else {
        springs_.push_back({.a = a, .b = b, .most_length = rest_length});
      }
      continue;
    }
    const SpringForm form = springs.form[row];
    springs_.push_back(
        {.a = a,
         .b = b,
         .rest_length = rest_length,
         .stiffness = std::min(static_cast<double>(springs.stiffness[row]), rigid_),
         .damping = static_cast<double>(springs.damping[row]),
         .most_length = std::numeric_limits<double>::infinity(),
         .isotropic = form == SpringForm::kExplicitIsotropic || form == SpringForm::kPredictedIsotropic});
  }
  resistances_.resize(springs_.size());
  double lengths = 0;
  for (const Spring& spring : springs_)
    lengths += std::max(spring.rest_length, spring.stiffness > 0 ? 0 : spring.most_length);
  accepted_length_ = kLoadedClothLengthError * lengths / static_cast<double>(springs_.size());
}

void ClothSolution::take_bends(const state::Deformable& cloth, const state::Bends& bends) {
  for (std::uint32_t row = cloth.bends.first; row < cloth.bends.end(); ++row) {
    if (!bends.is_isometric(row)) continue;
    const state::Bends::Stencil& s = bends.stencil[row];
    const std::uint32_t first = cloth.particles.first;
    bends_.push_back({.points = {s.edge_a - first, s.edge_b - first, s.wing_a - first, s.wing_b - first},
                      .weight = bends.weights_of(row),
                      .stiffness = static_cast<double>(bends.stiffness[row]),
                      .damping = static_cast<double>(bends.damping[row])});
  }
}

DVec3 ClothSolution::vector_at_end(const Spring& spring, std::span<const DVec3> v) const {
  return x_[spring.a] - x_[spring.b] + h_ * (v[spring.a] - v[spring.b]);
}

double ClothSolution::tension(const Spring& spring, double length) const {
  return spring.stiffness * (length - spring.rest_length) +
         rigid_ * std::max(0.0, length - spring.most_length);
}

/// The sum that becomes least, at velocities v [J].
double ClothSolution::energy(std::span<const DVec3> v) const {
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += mass_[i] * length_squared(v[i] - unsprung_[i]);
  for (const Spring& spring : springs_) {
    const DVec3 d = vector_at_end(spring, v);
    const double l = length(d);
    const double error = l - spring.rest_length;
    const double beyond = std::max(0.0, l - spring.most_length);
    sum += spring.stiffness * error * error + rigid_ * beyond * beyond;
    if (!(spring.damping > 0)) continue;
    const DVec3 u = v[spring.a] - v[spring.b];
    const double along = l > 0 ? dot(d, u) / l : 0;
    sum += h_ * spring.damping * (spring.isotropic ? length_squared(u) : along * along);
  }
  for (const Bend& bend : bends_) {
    const DVec3 q = weighted_sum(bend, x_);
    const DVec3 rate = weighted_sum(bend, v);
    sum += bend.stiffness * (length_squared(q + h_ * rate) + h_ * bend.damping * length_squared(rate));
  }
  return 0.5 * sum + bodies_.friction_energy(v) + loads_.energy(v);
}

/// Adds how isometric bends resist at v_.
void ClothSolution::linearize_bends() {
  for (const Bend& bend : bends_) {
    const DVec3 rate = weighted_sum(bend, v_);
    const DVec3 impulse = (h_ * bend.stiffness) * (weighted_sum(bend, x_) + (h_ + bend.damping) * rate);
    const double resistance = h_ * (h_ + bend.damping) * bend.stiffness;
    for (std::size_t k = 0; k < 4; ++k) {
      const double w = bend.weight[k];
      residual_[bend.points[k]] -= w * impulse;
      per_diagonal_[bend.points[k]] =
          per_diagonal_[bend.points[k]] + Symmetric3<double>::diagonal(w * w * resistance);
    }
  }
}

/// Finds how springs resist at v_, and the residual, of points that no body holds.
void ClothSolution::linearize_freely() {
  for (std::size_t i = 0; i < v_.size(); ++i) {
    residual_[i] = mass_[i] * (unsprung_[i] - v_[i]);
    per_diagonal_[i] = Symmetric3<double>::diagonal(mass_[i]);
  }
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const Spring& spring = springs_[k];
    const DVec3 d = vector_at_end(spring, v_);
    const double l = length(d);
    const double pull = tension(spring, l);
    const DVec3 u = v_[spring.a] - v_[spring.b];
    const DVec3 n = l > 0 ? (1 / l) * d : DVec3{};
    const double stiffness = spring.stiffness + (l > spring.most_length ? rigid_ : 0);
    const double damping = h_ * spring.damping;
    resistances_[k] = {
        .direction = n,
        .along = l > 0 ? h_ * h_ * stiffness + damping : 0,
        .across = (l > 0 ? h_ * h_ * std::max(0.0, pull) / l : 0) + (spring.isotropic ? damping : 0)};
    const DVec3 damped = spring.isotropic ? u : dot(n, u) * n;
    const DVec3 impulse = (h_ * pull) * n + damping * damped;
    residual_[spring.a] -= impulse;
    residual_[spring.b] += impulse;
    const auto own = math::axial(n, resistances_[k].along, resistances_[k].across);
    per_diagonal_[spring.a] = per_diagonal_[spring.a] + own;
    per_diagonal_[spring.b] = per_diagonal_[spring.b] + own;
  }
  linearize_bends();
  loads_.add(v_, residual_, per_diagonal_);
  bodies_.add_friction(v_, residual_, per_diagonal_);
}

/// Leaves to bodies what they hold, and finds the blocks of the preconditioner.
void ClothSolution::restrict_to_freedom() {
  bodies_.restrict_resistances(per_diagonal_);
  bodies_.gather(residual_);
  for (std::size_t i = 0; i < v_.size(); ++i) {
    if (mass_[i] > 0) {
      per_diagonal_[i] = math::inverse(per_diagonal_[i]);
    } else {
      per_diagonal_[i] = {};
      residual_[i] = {};
    }
  }
}

/// Finds what the residual asks for by itself, and its size.
double ClothSolution::precondition() {
  double size = 0;
  for (std::size_t i = 0; i < residual_.size(); ++i) {
    wanted_[i] = per_diagonal_[i] * residual_[i];
    size += dot(wanted_[i], residual_[i]);
  }
  return size;
}

/// Largest change of a velocity that the residual asks for by itself [m/s].
double ClothSolution::largest_wanted() const {
  double largest = 0;
  for (std::size_t i = 0; i < points_; ++i) largest = std::max(largest, length_squared(wanted_[i]));
  return std::sqrt(largest);
}

/// Finds how all resists the direction.
void ClothSolution::resist() {
  for (std::size_t i = 0; i < direction_.size(); ++i) image_[i] = mass_[i] * direction_[i];
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const Resistance& resistance = resistances_[k];
    const DVec3 d = direction_[springs_[k].a] - direction_[springs_[k].b];
    const double along = (resistance.along - resistance.across) * dot(resistance.direction, d);
    const DVec3 impulse = resistance.across * d + along * resistance.direction;
    image_[springs_[k].a] += impulse;
    image_[springs_[k].b] -= impulse;
  }
  for (const Bend& bend : bends_) {
    const DVec3 impulse = (h_ * (h_ + bend.damping) * bend.stiffness) * weighted_sum(bend, direction_);
    for (std::size_t k = 0; k < 4; ++k) image_[bend.points[k]] += bend.weight[k] * impulse;
  }
  loads_.resist(direction_, image_);
  bodies_.resist(direction_, image_);
  bodies_.gather(image_);
}

/// Goes along the direction to the minimum, and turns it. Returns the size of the residual there.
double ClothSolution::go_along(double size) {
  resist();
  double curvature = 0;
  for (std::size_t i = 0; i < direction_.size(); ++i) curvature += dot(direction_[i], image_[i]);
  if (!(curvature > 0)) return 0;
  const double share = size / curvature;
  for (std::size_t i = 0; i < direction_.size(); ++i) {
    if (!(mass_[i] > 0)) continue;
    change_[i] += share * direction_[i];
    residual_[i] -= share * image_[i];
  }
  const double next = precondition();
  const double kept = next / size;
  for (std::size_t i = 0; i < direction_.size(); ++i) direction_[i] = wanted_[i] + kept * direction_[i];
  bodies_.follow(direction_);
  return next;
}

/// Whether an unknown is the rotation of a body.
bool ClothSolution::is_turn(std::size_t unknown) const {
  return unknown >= points_ && (unknown - points_) % 2 == 1;
}

/// Whether a cloth that nothing holds lacks so much momentum that it would move otherwise as a whole.
bool ClothSolution::lacks_motion() const {
  if (is_held_) return false;
  DVec3 lacking;
  double mass = 0;
  double changing = 0;
  for (std::size_t i = 0; i < v_.size(); ++i) {
    if (is_turn(i)) continue;
    lacking += residual_[i];
    mass += mass_[i];
    changing += mass_[i] * length_squared(v_[i] - unsprung_[i]);
  }
  return length_squared(lacking) > kClothMotionError * kClothMotionError * mass * changing;
}

/// Whether the cloth has not used up its work.
bool ClothSolution::may_go_on() const {
  return static_cast<double>(directions_) * static_cast<double>(springs_.size() + bends_.size()) <
         kMostClothWork;
}

/// Solves the linear problem at v_. Returns false if nothing is to be changed.
bool ClothSolution::find_change() {
  std::fill(change_.begin(), change_.end(), DVec3{});
  double size = precondition();
  // The first error is that of points that move freely.
  if (accepted_ < 0) accepted_ = kLoadedClothError * kLoadedClothError * size;
  if (!(size > accepted_) && !(h_ * largest_wanted() > accepted_length_) && !lacks_motion()) return false;
  const double enough = kClothStepError * kClothStepError * size;
  direction_ = wanted_;
  bodies_.follow(direction_);
  while (size > enough && may_go_on()) {
    ++directions_;
    size = go_along(size);
  }
  return true;
}

/// Goes along the change as far as the sum becomes less. Returns false if it does nowhere.
bool ClothSolution::go_down() {
  double share = 1;
  for (int halving = 0; halving <= kMostClothHalvings; ++halving, share *= 0.5) {
    for (std::size_t i = 0; i < v_.size(); ++i) trial_[i] = v_[i] + share * change_[i];
    const double there = energy(trial_);
    if (!(there <= energy_)) continue;
    std::swap(v_, trial_);
    energy_ = there;
    return true;
  }
  return false;
}

/// Adds what bodies and solids have got of the cloth: momentum, and angular momentum about `center`.
void ClothSolution::add_given(const Problem& problem, std::uint32_t first_particle, DVec3 center, DVec3& made,
                              DVec3& spin_made) const {
  for (const ClothPress& press : problem.presses) {
    made += press.push;
    const DVec3 center_of_body = x_[press.particle - first_particle] - press.lever;
    spin_made += cross(center_of_body - center, press.push) + press.turn;
  }
  for (const ClothLoad& load : problem.loads) {
    if (load.object != problem.object) continue;
    DVec3 place;
    for (std::size_t k = 0; k < 3; ++k) {
      if (load.weight[k] != 0) place += load.weight[k] * x_[load.particle[k] - first_particle];
    }
    const DVec3 given = load.is_whole ? -load.push : load.impulse;
    made -= given;
    spin_made += load.turn - cross(place - load.lever - center, given);
  }
}

/// Takes back what momentum and angular momentum the error has made, where nothing holds the cloth: springs
/// keep them.
void ClothSolution::keep_momentum(const Problem& problem, std::uint32_t first_particle) {
  constexpr double kLeastSpinShare = 1e-9;  // of inertia, for points on a line
  if (is_held_) return;
  double mass = 0;
  DVec3 center, made;
  for (std::size_t i = 0; i < points_; ++i) {
    mass += mass_[i];
    center += mass_[i] * x_[i];
    made += mass_[i] * (v_[i] - unsprung_[i]);
  }
  center = (1 / mass) * center;
  Symmetric3<double> inertia = {};
  DVec3 spin_made;
  add_given(problem, first_particle, center, made, spin_made);
  for (std::size_t i = 0; i < points_; ++i) {
    const DVec3 r = x_[i] - center;
    spin_made += mass_[i] * cross(r, v_[i] - unsprung_[i]);
    inertia = inertia + math::inertia_of_point(mass_[i], r);
  }
  const double least = kLeastSpinShare * (inertia.xx + inertia.yy + inertia.zz);
  const DVec3 turn = math::inverse(inertia + Symmetric3<double>::diagonal(least)) * spin_made;
  if (!is_finite(made) || !is_finite(turn)) return;  // One point that is not a number spoils no other.
  for (std::size_t i = 0; i < points_; ++i) v_[i] -= (1 / mass) * made + cross(turn, x_[i] - center);
}

/// Finds anew what holds, slides and is let go. Returns whether anything changed.
bool ClothSolution::renew_touches() {
  const bool loads_change = loads_.renew(v_);
  return bodies_.renew(v_, residual_, per_diagonal_) || loads_change;
}

/// Goes from v_ to the minimum, while points are let go and taken hold of. Returns whether it came there.
bool ClothSolution::find_minimum() {
  energy_ = energy(v_);
  directions_ = 0;
  accepted_ = -1;
  if (!std::isfinite(energy_)) return false;  // Some point is not a number: it is quarantined in the end.
  int renewals = 0;
  for (int step = 0; step < kMostClothSteps; ++step) {
    linearize_freely();
    if (step > 0 && renewals < kMostPressRenewals && renew_touches()) {
      ++renewals;
      bodies_.move_along(v_);
      energy_ = energy(v_);
      linearize_freely();
    }
    restrict_to_freedom();
    if (!find_change()) return true;
    if (!may_go_on() || !go_down()) return false;
  }
  return false;
}

bool ClothSolution::solve(const Problem& problem, state::Tables& tables) {
  const state::Deformable& cloth = tables.objects[problem.object];
  const std::uint32_t first = cloth.particles.first;
  h_ = problem.h;
  take_points(cloth, problem.unsprung, tables);
  bodies_.take(first, problem.presses, tables, unsprung_, mass_);
  loads_.take(problem.object, problem.loads, h_, tables, unsprung_, mass_);
  is_held_ = is_held_ || bodies_.is_held();
  set_sizes();
  take_springs(cloth, tables.springs);
  bends_.clear();
  if (problem.with_bends) take_bends(cloth, tables.bends);
  from_passes_ = v_;
  v_ = unsprung_;
  bodies_.move_along(v_);
  loads_.begin(v_);
  const bool is_solved = find_minimum();
  bodies_.move_along(from_passes_);
  const bool keeps_passes = !is_solved && !(energy(from_passes_) >= energy_);
  if (keeps_passes) std::swap(v_, from_passes_);
  if (!bodies_.empty()) {
    linearize_freely();
    bodies_.note_impulses(v_, unsprung_, residual_, is_solved, problem.presses);
  }
  if (!keeps_passes) loads_.note_impulses(v_, unsprung_, problem.loads);
  keep_momentum(problem, first);
  for (std::size_t i = 0; i < points_; ++i) {
    if (mass_[i] > 0) tables.particles.velocity[first + i].v = vector_cast<Real>(v_[i]);
  }
  return is_solved;
}

}  // namespace hooke::solver
