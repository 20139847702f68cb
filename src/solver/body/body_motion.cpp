#include "solver/body/body_motion.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/body/body_tuning.h"
#include "solver/body/free_turn_kernels.h"
#include "state/body_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using state::Bodies;
using state::BodyMass;
using state::MotionRecord;

/// D x with the diagonal matrix D in principal axes.
Vec3 in_axes(Quat axes, Vec3 diagonal, Vec3 x) {
  const Vec3 local = rotate(conjugate(axes), x);
  return rotate(axes, {diagonal.x * local.x, diagonal.y * local.y, diagonal.z * local.z});
}

/// 1/I, or zero about axes about which nothing turns.
Vec3 inverse_inertia(const BodyMass& mass) {
  const auto inverse = [](Real i) { return i > Real(0) ? Real(1) / i : Real(0); };
  return {inverse(mass.inertia.x), inverse(mass.inertia.y), inverse(mass.inertia.z)};
}

/// S^(-1) x turns a change of omega_scaled into one of L. It is zero if S has no inverse.
Vec3 momentum_of(const math::Symmetric3<Real>& scale, Vec3 x) {
  if (x == Vec3{} || !(scale.xx > Real(0))) return {};
  return math::inverse(scale) * x;
}

/// A free body that turns about its center.
struct FreeTurn {
  Quat axes = {};
  Vec3 inverse = {};  ///< 1 / I about each principal axis.
  Vec3 momentum = {};
};

FreeTurn free_turn(const BodyMass& mass, Quat rotation, Vec3 momentum) {
  return {rotation * mass.principal, inverse_inertia(mass), momentum};
}

/// Whether the iteration of the midpoint rule converges at once.
bool is_slow(const FreeTurn& turn, Real h) {
  const auto [least, most] = std::minmax({turn.inverse.x, turn.inverse.y, turn.inverse.z});
  return h * length(turn.momentum) * most * most <= kMidpointTurn * least;
}

void put_turn(const FreeTurn& turn, int lane, wide::TurnLanes& turns) {
  const std::array<Real, 4> axes = {turn.axes.x, turn.axes.y, turn.axes.z, turn.axes.w};
  for (int k = 0; k < 4; ++k) turns.axes[k][lane] = axes[k];
  const std::array<Real, 3> inverse = {turn.inverse.x, turn.inverse.y, turn.inverse.z};
  const std::array<Real, 3> momentum = {turn.momentum.x, turn.momentum.y, turn.momentum.z};
  for (int k = 0; k < 3; ++k) {
    turns.inverse[k][lane] = inverse[k];
    turns.momentum[k][lane] = momentum[k];
  }
}

Vec3 omega_of(const wide::TurnLanes& turns, int lane) {
  return {turns.omega[0][lane], turns.omega[1][lane], turns.omega[2][lane]};
}

/// Rotates about one of the principal axes by `turn_per_momentum` times the part of L along it.
Quaternion<double> turned_about(int axis, Quaternion<double> axes, DVec3 momentum, double turn_per_momentum) {
  const DVec3 local = rotate(conjugate(axes), momentum);
  const std::array<DVec3, 3> turns = {DVec3{local.x, 0, 0}, DVec3{0, local.y, 0}, DVec3{0, 0, local.z}};
  return axes * math::quaternion_of(turn_per_momentum * turns[static_cast<std::size_t>(axis)]);
}

/// Rotates further so that L has the energy it should have. In the body's own axes |L|^2 = sum L_i^2 and 2 E
/// = sum c_i L_i^2 are linear in the squares. The nearest squares that fulfill both, none of them negative,
/// are taken. What is nearly right stays: otherwise the root of a square's rounding error spun a ladder,
/// which leaned at rest, about its own axis.
Quaternion<double> turned_to_energy(Quaternion<double> axes, DVec3 c, DVec3 momentum, double twice_energy) {
  const double size = length(momentum);
  const DVec3 l = (1 / size) * rotate(conjugate(axes), momentum);
  const DVec3 square = {l.x * l.x, l.y * l.y, l.z * l.z};
  const double mean = (c.x + c.y + c.z) / 3;
  const DVec3 slope = c - DVec3{mean, mean, mean};
  const DVec3 free = {c.z - c.y, c.x - c.z, c.y - c.x};  // This direction changes neither sum.
  if (!(length_squared(slope) > 0)) return axes;
  const double lacks = twice_energy / (size * size) - dot(c, square);
  if (std::abs(lacks) <= kTurnEnergyTolerance * dot(c, square)) return axes;
  const DVec3 nearest = square + (lacks / length_squared(slope)) * slope;
  double low = -std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto axis : {&DVec3::x, &DVec3::y, &DVec3::z}) {
    const double zero = -(nearest.*axis) / (free.*axis);
    if ((free.*axis) > 0) low = std::max(low, zero);
    if ((free.*axis) < 0) high = std::min(high, zero);
  }
  const DVec3 found = nearest + std::clamp(0.0, std::min(low, high), high) * free;
  const auto root = [](double x, double sign) { return std::copysign(std::sqrt(std::max(0.0, x)), sign); };
  const DVec3 goal = normalize(DVec3{root(found.x, l.x), root(found.y, l.y), root(found.z, l.z)});
  const DVec3 across = cross(l, goal);
  return axes * conjugate(normalize(Quaternion<double>{across.x, across.y, across.z, 1 + dot(l, goal)}));
}

/// Mean velocity of a fast turn, for which the midpoint rule makes energy out of nothing. The body turns
/// exactly, as a symmetric top about the axis that is least like the others, between two halves of the turn
/// by which the others differ.
Vec3 split_velocity(const FreeTurn& turn, Real h) {
  const auto& [axes, inverse, momentum] = turn;
  const DVec3 c = vector_cast<double>(inverse);
  const DVec3 l = vector_cast<double>(momentum);
  const std::array<double, 3> of = {c.x, c.y, c.z};
  const auto unlike = [&](int i, int k) { return std::abs(of[i] - of[k]) / (of[i] + of[k]); };
  const int top = unlike(0, 1) <= std::min(unlike(1, 2), unlike(2, 0))   ? 2
                  : unlike(1, 2) <= std::min(unlike(0, 1), unlike(2, 0)) ? 0
                                                                         : 1;
  const int a = (top + 1) % 3;
  const int b = (top + 2) % 3;
  const double step = static_cast<double>(h);
  const double rest = 0.5 * step * (of[b] - of[a]);
  const Quaternion<double> before = math::in_double(axes);
  const bool is_symmetric = rest == 0;
  Quaternion<double> q = is_symmetric ? before : turned_about(b, before, l, rest);
  q = math::quaternion_of(step * of[a] * l) * turned_about(top, q, l, step * (of[top] - of[a]));
  const DVec3 now = vector_cast<double>(in_axes(axes, inverse, momentum));
  if (!is_symmetric) {
    q = turned_about(b, q, l, rest);
    const DVec3 start = rotate(conjugate(before), l);
    q = turned_to_energy(q, c, l, dot(start, {c.x * start.x, c.y * start.y, c.z * start.z}));
  }
  return vector_cast<Real>((1 / step) * math::turn_between(before, q, step * now));
}

/// Sets speeds to zero that are too small to keep: nothing may decay into denormals.
Vec3 flushed(Vec3 v) {
  const auto flush = [](Real x) { return std::abs(x) < Real(1e-20) ? Real(0) : x; };
  return {flush(v.x), flush(v.y), flush(v.z)};
}

/// Finds mean velocities of up to kLanes bodies, the slow ones side by side.
class MeanVelocities {
 public:
  explicit MeanVelocities(Real h) : h_(h) {}

  /// Adds the body at position `place` among them.
  void add(std::size_t place, const FreeTurn& turn) {
    if (is_slow(turn, h_)) {
      place_[static_cast<std::size_t>(count_)] = place;
      put_turn(turn, count_++, turns_);
    } else {
      omega[place] = split_velocity(turn, h_);
    }
  }
  void find() {
    if (count_ > 0) wide::turn_freely(h_, count_, turns_);
    for (int lane = 0; lane < count_; ++lane)
      omega[place_[static_cast<std::size_t>(lane)]] = omega_of(turns_, lane);
  }

  std::array<Vec3, kLanes> omega = {};

 private:
  Real h_;
  int count_ = 0;
  std::array<std::size_t, kLanes> place_ = {};
  wide::TurnLanes turns_ = {};
};

Real angular_damping(std::uint32_t i, Real h, const Bodies& bodies) {
  return Real(1) / (Real(1) + h * bodies.traits[i].angular_damping);
}

/// Changes L of a body that makes a gyroscopic turn, by external torque, damping, and the contacts of the
/// substep before.
void turn_momentum(std::uint32_t i, const BodyStep& step, Bodies& bodies) {
  Vec3& momentum = bodies.angular_momentum[i];
  const Vec3 by_contacts = bodies.motion[i].omega_scaled - bodies.free_motion[i].omega_scaled;
  if (!step.first) momentum += momentum_of(bodies.scale[i], by_contacts);
  momentum = angular_damping(i, step.h, bodies) * (momentum + step.h * bodies.torque[i]);
}

/// omega_scaled after external torque, damping and the free motion of the substep. A body that makes a
/// gyroscopic turn has the mean velocity `omega`.
Vec3 turned(std::uint32_t i, const BodyStep& step, Vec3 omega, const Bodies& bodies) {
  const math::Symmetric3<Real>& scale = bodies.scale[i];
  if (is_gyroscopic_now(bodies, i)) return momentum_of(scale, omega);
  return angular_damping(i, step.h, bodies) *
         (bodies.motion[i].omega_scaled + scale * (step.h * bodies.torque[i]));
}

/// Accelerates a body; `omega` has the meaning it has in `turned`.
void accelerate_body(std::uint32_t i, const BodyStep& step, Vec3 omega, Bodies& bodies) {
  MotionRecord& m = bodies.motion[i];
  state::FreeMotionRecord& free = bodies.free_motion[i];
  const Vec3 by_contacts = m.v - free.v;
  const Vec3 turn_by_contacts = m.omega_scaled - free.omega_scaled;

  const state::BodyTraits& traits = bodies.traits[i];
  const Vec3 a = traits.gravity_scale * step.gravity + m.inverse_mass * bodies.force[i];
  free.v = flushed((Real(1) / (Real(1) + step.h * traits.linear_damping)) * (m.v + step.h * a));
  free.omega_scaled = flushed(turned(i, step, omega, bodies));
  m.v = free.v + by_contacts;
  m.omega_scaled = free.omega_scaled + turn_by_contacts;
}

/// Makes L, together with what contacts have yet to add to it, smaller where its energy is larger than with
/// the body's rotation `before`.
void keep_rotational_energy(std::uint32_t row, Quat before, Bodies& bodies) {
  const Vec3 pending =
      momentum_of(bodies.scale[row], bodies.motion[row].omega_scaled - bodies.free_motion[row].omega_scaled);
  const Vec3 momentum = bodies.angular_momentum[row] + pending;
  const Vec3 inverse = inverse_inertia(bodies.mass[row]);
  const auto energy = [&](Quat q) {
    return dot(momentum, in_axes(q * bodies.mass[row].principal, inverse, momentum));
  };
  const Real had = energy(before);
  const Real has = energy(bodies.rotation[row]);
  if (has > had) bodies.angular_momentum[row] = std::sqrt(had / has) * momentum - pending;
}

/// Whether the rows of a body whose S was `scale` at the start of the step ask for too large impulses now.
bool outgrows_rows(const math::Symmetric3<Real>& scale, const math::Symmetric3<Real>& now) {
  const math::Symmetric3<Real> inverse = math::inverse(scale);
  Real trace = Real(0);
  for (const Vec3 axis :
       {Vec3{Real(1), Real(0), Real(0)}, Vec3{Real(0), Real(1), Real(0)}, Vec3{Real(0), Real(0), Real(1)}})
    trace += length_squared(now * (inverse * axis));
  return !(trace <= kOutgrownResponse);
}

/// S of the mean inertia of a body that spins about its angular velocity.
math::Symmetric3<Real> spinning_scale(const Bodies& bodies, std::uint32_t i) {
  const Vec3 axis = normalize(bodies.angular_velocity[i]);
  const BodyMass& mass = bodies.mass[i];
  const Real along = dot(axis, state::angular_momentum_of(mass, bodies.rotation[i], axis));
  const Real across = Real(0.5) * (mass.inertia.x + mass.inertia.y + mass.inertia.z - along);
  const Real s = Real(1) / std::sqrt(across);
  const Real more = Real(1) / std::sqrt(along) - s;
  return {s + more * axis.x * axis.x, more * axis.x * axis.y, more * axis.x * axis.z,
          s + more * axis.y * axis.y, more * axis.y * axis.z, s + more * axis.z * axis.z};
}

/// Freezes the inertia: the rotation of the step so far becomes one about a single axis from its start. Its
/// energy is that of L, but no more than rows know: where an impact turned the body over within the substep,
/// L belongs to another time.
void begin_frozen_inertia(std::uint32_t i, Vec3 momentum, const math::Symmetric3<Real>& now, Quat start,
                          Bodies& bodies) {
  const math::Symmetric3<Real>& scale = bodies.scale[i];
  MotionRecord& m = bodies.motion[i];
  state::FreeMotionRecord& free = bodies.free_motion[i];
  const Vec3 by_contacts = m.omega_scaled - free.omega_scaled;
  const Vec3 omega_now = now * momentum;
  const Vec3 omega_scaled = momentum_of(scale, now * omega_now);
  const Real size = length_squared(omega_scaled);
  const Real energy = std::min(length_squared(omega_now), length_squared(m.omega_scaled));
  m.omega_scaled = size > Real(0) ? std::sqrt(energy / size) * omega_scaled : Vec3{};
  free.omega_scaled = m.omega_scaled - by_contacts;
  m.theta_scaled = momentum_of(scale, math::turn_between(start, bodies.rotation[i], scale * m.theta_scaled));
  bodies.rotation[i] = start;
  bodies.frozen_inertia[i].on = true;
}

/// Ends a step with frozen inertia. The inertia was not turned exactly as the body was: the
/// rotational energy decides how fast the body turns.
void finish_frozen_inertia(std::uint32_t i, Bodies& bodies) {
  const MotionRecord& m = bodies.motion[i];
  bodies.rotation[i] = normalize(math::quaternion_of(bodies.scale[i] * m.theta_scaled) * bodies.rotation[i]);
  const Vec3 omega = bodies.scale[i] * m.omega_scaled;
  const Vec3 momentum = state::angular_momentum_of(bodies.mass[i], bodies.rotation[i], omega);
  const Real energy = dot(omega, momentum);
  const Real share = energy > Real(0) ? std::sqrt(length_squared(m.omega_scaled) / energy) : Real(0);
  bodies.angular_velocity[i] = share * omega;
  bodies.angular_momentum[i] = share * momentum;
}

void finish_rotation(std::uint32_t i, Bodies& bodies) {
  const MotionRecord& m = bodies.motion[i];
  const math::Symmetric3<Real>& scale = bodies.scale[i];
  if (!(m.inverse_mass > Real(0))) {
    bodies.rotation[i] = normalize(math::quaternion_of(m.theta_scaled) * bodies.rotation[i]);
    return;
  }
  if (bodies.frozen_inertia[i].on) {
    finish_frozen_inertia(i, bodies);
    return;
  }
  Vec3& momentum = bodies.angular_momentum[i];
  if (is_gyroscopic(bodies.mass[i])) {
    momentum += momentum_of(scale, m.omega_scaled - bodies.free_motion[i].omega_scaled);
  } else {
    momentum += momentum_of(scale, m.omega_scaled - scale * momentum);
    bodies.rotation[i] = normalize(math::quaternion_of(scale * m.theta_scaled) * bodies.rotation[i]);
  }
  const Quat axes = bodies.rotation[i] * bodies.mass[i].principal;
  bodies.angular_velocity[i] = in_axes(axes, inverse_inertia(bodies.mass[i]), momentum);
}

}  // namespace

math::Symmetric3<Real> inertia_scale(const BodyMass& mass, Quat rotation) {
  const Vec3 inverse = inverse_inertia(mass);
  const Real x = std::sqrt(inverse.x);
  const Real y = std::sqrt(inverse.y);
  const Real z = std::sqrt(inverse.z);
  const Mat3 r = matrix_of(rotation * mass.principal);
  const auto entry = [&](Real Vec3::*i, Real Vec3::*j) {
    return x * (r.x.*i * r.x.*j) + y * (r.y.*i * r.y.*j) + z * (r.z.*i * r.z.*j);
  };
  return {entry(&Vec3::x, &Vec3::x), entry(&Vec3::x, &Vec3::y), entry(&Vec3::x, &Vec3::z),
          entry(&Vec3::y, &Vec3::y), entry(&Vec3::y, &Vec3::z), entry(&Vec3::z, &Vec3::z)};
}

Vec3 mean_velocity(const BodyMass& mass, Quat rotation, Vec3 momentum, Real h) {
  MeanVelocities velocities(h);
  velocities.add(0, free_turn(mass, rotation, momentum));
  velocities.find();
  return velocities.omega[0];
}

void prepare_bodies(std::span<const std::uint32_t> rows, Bodies& bodies) {
  for (const std::uint32_t i : rows) {
    MotionRecord& m = bodies.motion[i];
    m.dx = {};
    m.theta_scaled = {};
    if (m.inverse_mass > Real(0)) {
      const state::FrozenInertia& frozen = bodies.frozen_inertia[i];
      const Quat turned =
          frozen.on ? math::quaternion_of(frozen.until_impact) * bodies.rotation[i] : bodies.rotation[i];
      bodies.scale[i] = frozen.hooked ? spinning_scale(bodies, i) : inertia_scale(bodies.mass[i], turned);
      m.omega_scaled = frozen.on ? momentum_of(bodies.scale[i], bodies.angular_velocity[i])
                                 : bodies.scale[i] * bodies.angular_momentum[i];
    } else {
      bodies.scale[i] = math::Symmetric3<Real>::diagonal(Real(1));
      m.omega_scaled = bodies.angular_velocity[i];
    }
    bodies.free_motion[i] = {.v = m.v, .omega_scaled = m.omega_scaled};
  }
}

void accelerate_bodies(std::span<const std::uint32_t> rows, const BodyStep& step, Bodies& bodies) {
  for (; !rows.empty(); rows = rows.subspan(std::min<std::size_t>(kLanes, rows.size()))) {
    const auto some = rows.first(std::min<std::size_t>(kLanes, rows.size()));
    MeanVelocities velocities(step.h);
    for (std::size_t k = 0; k < some.size(); ++k) {
      const std::uint32_t i = some[k];
      if (!(bodies.motion[i].inverse_mass > Real(0)) || !is_gyroscopic_now(bodies, i)) continue;
      turn_momentum(i, step, bodies);
      velocities.add(k, free_turn(bodies.mass[i], bodies.rotation[i], bodies.angular_momentum[i]));
    }
    velocities.find();
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (bodies.motion[some[k]].inverse_mass > Real(0))
        accelerate_body(some[k], step, velocities.omega[k], bodies);
    }
  }
}

void push_body(std::uint32_t row, Vec3 impulse, Vec3 lever, Bodies& bodies) {
  push_and_turn_body(row, impulse, cross(lever, impulse), bodies);
}

void push_and_turn_body(std::uint32_t row, Vec3 impulse, Vec3 angular, Bodies& bodies) {
  HOOKE_ASSERT(gives_way(bodies, row));
  const math::Symmetric3<Real>& scale = bodies.scale[row];
  Vec3 turn = scale * angular;
  if (is_gyroscopic_now(bodies, row)) {
    const math::Symmetric3<Real> now = inertia_scale(bodies.mass[row], bodies.rotation[row]);
    turn = momentum_of(scale, now * (now * angular));
  }
  MotionRecord& m = bodies.motion[row];
  state::FreeMotionRecord& free = bodies.free_motion[row];
  m.v += m.inverse_mass * impulse;
  free.v += m.inverse_mass * impulse;
  m.omega_scaled += turn;
  free.omega_scaled += turn;
  bodies.angular_momentum[row] += angular;
}

Real inverse_mass_at(const Bodies& bodies, std::uint32_t row, Vec3 direction, Vec3 lever) {
  return bodies.motion[row].inverse_mass + length_squared(bodies.scale[row] * cross(lever, direction));
}

void move_bodies(std::span<const std::uint32_t> rows, Real h, Bodies& bodies) {
  for (const std::uint32_t i : rows) {
    MotionRecord& m = bodies.motion[i];
    m.dx += h * m.v;
    m.theta_scaled += h * m.omega_scaled;
    if (!(m.inverse_mass > Real(0)) || !is_gyroscopic_now(bodies, i)) continue;
    const Vec3 turn = bodies.scale[i] * (h * m.omega_scaled);
    const Quat before = bodies.rotation[i];
    bodies.rotation[i] = normalize(math::quaternion_of(turn) * before);
    // Far from the free rotation, L would stand for any energy.
    if (length_squared(turn) > kEnergyKeepingTurn * kEnergyKeepingTurn)
      keep_rotational_energy(i, before, bodies);
  }
}

bool outgrows_rows(const Bodies& bodies, std::uint32_t row, Real h) {
  const Vec3 turn = h * bodies.angular_velocity[row];
  if (!gives_way(bodies, row) || !is_gyroscopic(bodies.mass[row])) return false;
  const Real angle = length(turn);
  if (angle < kOtherInertiaTurn) return false;
  const Quat then =
      math::quaternion_of(std::min(Real(1), kForeseenTurn / angle) * turn) * bodies.rotation[row];
  return outgrows_rows(inertia_scale(bodies.mass[row], bodies.rotation[row]),
                       inertia_scale(bodies.mass[row], then));
}

void freeze_inertia(std::span<const std::uint32_t> rows, std::span<const Quat> start_rotation, Real h,
                    bool moved, Bodies& bodies) {
  for (const std::uint32_t i : rows) {
    const state::FrozenInertia& frozen = bodies.frozen_inertia[i];
    if (!frozen.touches || frozen.on) continue;
    HOOKE_ASSERT(i < start_rotation.size());
    const MotionRecord& m = bodies.motion[i];
    const math::Symmetric3<Real>& scale = bodies.scale[i];
    const Vec3 turn = moved ? m.theta_scaled : h * m.omega_scaled;
    if (length_squared(scale * turn) < kOtherInertiaTurn * kOtherInertiaTurn) continue;
    const math::Symmetric3<Real> now = inertia_scale(bodies.mass[i], bodies.rotation[i]);
    const state::FreeMotionRecord& free = bodies.free_motion[i];
    Vec3 momentum = bodies.angular_momentum[i];
    if (moved) momentum += momentum_of(scale, m.omega_scaled - free.omega_scaled);
    const bool is_other_motion =
        !moved && length_squared(free.omega_scaled) > kOtherMotionEnergy * length_squared(now * momentum);
    if (is_other_motion || outgrows_rows(scale, now))
      begin_frozen_inertia(i, momentum, now, start_rotation[i], bodies);
  }
}

void stop_rotation(std::uint32_t row, Quat rotation, Bodies& bodies) {
  HOOKE_ASSERT(state::is_gyroscopic_now(bodies, row));
  const Quat turned = bodies.rotation[row];
  bodies.rotation[row] = rotation;
  keep_rotational_energy(row, turned, bodies);
}

void finish_bodies(std::span<const std::uint32_t> rows, Bodies& bodies) {
  for (const std::uint32_t i : rows) {
    MotionRecord& m = bodies.motion[i];
    bodies.center[i] = bodies.center[i] + vector_cast<double>(m.dx);
    finish_rotation(i, bodies);
    m = {.v = m.v, .inverse_mass = m.inverse_mass};
    bodies.force[i] = {};
    bodies.torque[i] = {};
  }
}

}  // namespace hooke::solver
