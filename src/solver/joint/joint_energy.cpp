#include "solver/joint/joint_energy.h"

#include "base/assert.h"
#include "math/symmetric.h"
#include "solver/body/body_motion.h"
#include "solver/joint_rows/joint_rows.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using math::Symmetric3;

/// A body that moves, in the world's axes.
struct Mover {
  std::uint32_t row = 0;
  double mass = 0;
  DVec3 center, v;
  DVec3 omega;              ///< From the angular momentum, which is what a body in a gyroscopic turn has.
  DVec3 momentum;           ///< Angular momentum.
  Symmetric3<double> root;  ///< S = I^(-1/2) of now.

  [[nodiscard]] DVec3 momentum_at(DVec3 spin) const {
    const Symmetric3<double> back = math::inverse(root);
    return back * (back * spin);
  }
};

Mover mover_of(std::uint32_t row, const JointBody& body, const state::Bodies& bodies) {
  HOOKE_ASSERT(body.inverse_mass > 0);
  Mover mover = {.row = row,
                 .mass = 1 / body.inverse_mass,
                 .center = body.center,
                 .v = body.v,
                 .omega = body.scale * body.omega_scaled,
                 .momentum = {},
                 .root = body.scale};
  if (is_gyroscopic_now(bodies, row)) {
    const Vec3 by_contacts = bodies.motion[row].omega_scaled - bodies.free_motion[row].omega_scaled;
    mover.momentum = vector_cast<double>(bodies.angular_momentum[row]) +
                     math::inverse(math::in_double(bodies.scale[row])) * vector_cast<double>(by_contacts);
    mover.omega = body.scale * (body.scale * mover.momentum);
  } else {
    mover.momentum = mover.momentum_at(mover.omega);
  }
  return mover;
}

/// Calls `visit(mover)` once for each body that moves.
template <class Visit>
void for_moving(const Articulation& art, const state::Bodies& bodies, Visit&& visit) {
  for (std::size_t i = 0; i < art.bodies.size(); ++i) {
    if (i > 0 && art.bodies[i] == art.bodies[i - 1]) continue;  // a part of the same body
    const JointBody body = joint_body_now(bodies, art.bodies[i]);
    if (body.inverse_mass > 0) visit(mover_of(art.bodies[i], body, bodies));
  }
}

/// A rigid motion: velocity at `center`, and angular velocity.
struct Twist {
  DVec3 center, v, omega;
  [[nodiscard]] DVec3 at(DVec3 place) const { return v + cross(omega, place - center); }
};

/// The matrix |r|^2 - r r^T, `mass` times.
Symmetric3<double> inertia_about(double mass, DVec3 r) {
  const double square = length_squared(r);
  return {mass * (square - r.x * r.x), -mass * r.x * r.y, -mass * r.x * r.z,
          mass * (square - r.y * r.y), -mass * r.y * r.z, mass * (square - r.z * r.z)};
}

/// The motion of all bodies together that has these sums.
Twist common_motion(const BodySums& sums, const Articulation& art, const state::Bodies& bodies) {
  const DVec3 to_center = (1 / sums.mass) * sums.moment;
  Twist all = {.center = sums.place + to_center, .v = (1 / sums.mass) * sums.momentum, .omega = {}};
  Symmetric3<double> inertia;
  for_moving(art, bodies, [&](const Mover& body) {
    const Symmetric3<double> back = math::inverse(body.root);
    inertia = inertia + math::symmetric_product(back, Symmetric3<double>::diagonal(1), back) +
              inertia_about(body.mass, body.center - all.center);
  });
  all.omega = math::inverse(inertia) * (sums.angular_momentum - cross(to_center, sums.momentum));
  return all;
}

/// The motion of the body that nothing moves, or the common motion of all.
Twist reference_of(const BodySums& sums, const Articulation& art, const state::Bodies& bodies) {
  for (const std::uint32_t row : art.bodies) {
    const JointBody body = joint_body_now(bodies, row);
    if (!(body.inverse_mass > 0)) return {body.center, body.v, body.scale * body.omega_scaled};
  }
  return common_motion(sums, art, bodies);
}

/// The share s in [0, 1] of the motion relative to the reference with which the energy is `most`: the root of
/// a quadratic a s^2 + b s + c = most.
double share_with(double most, double a, double b, double c) {
  if (!(most > c)) return 0;
  const double root = std::sqrt(b * b + 4 * a * (most - c));
  // This form has no cancellation, whatever the sign of b.
  const double share = b > 0 ? 2 * (most - c) / (root + b) : (root - b) / (2 * a);
  return share < 1 ? share : 1;
}

/// Slows the bodies down until the kinetic energy is `most`. Returns the share.
double slow_down(const Articulation& art, const Twist& reference, double most, state::Bodies& bodies) {
  double a = 0;
  double b = 0;
  double c = 0;
  for_moving(art, bodies, [&](const Mover& body) {
    const DVec3 v = reference.at(body.center);
    const DVec3 u = body.v - v;
    const DVec3 turn = body.root * body.momentum_at(reference.omega);
    const DVec3 spin = body.root * body.momentum - turn;
    a += 0.5 * (body.mass * length_squared(u) + length_squared(spin));
    b += body.mass * dot(u, v) + dot(spin, turn);
    c += 0.5 * (body.mass * length_squared(v) + length_squared(turn));
  });
  if (!(a > 0)) return 1;
  const double share = share_with(most, a, b, c);
  const double less = 1 - share;
  for_moving(art, bodies, [&](const Mover& body) {
    const DVec3 v = body.v - less * (body.v - reference.at(body.center));
    const DVec3 momentum = less * (body.momentum - body.momentum_at(reference.omega));
    const DVec3 omega_scaled =
        vector_cast<double>(bodies.motion[body.row].omega_scaled) -
        math::inverse(math::in_double(bodies.scale[body.row])) * (less * (body.omega - reference.omega));
    set_joint_velocity(v, omega_scaled, -momentum, body.row, bodies);
  });
  return share;
}

/// Sums what the hooks store, and resets it. The first hook that is no weld stores the sum from now on.
state::Hook* collect_debt(const Articulation& art, std::vector<state::Hook>& hooks, double& debt) {
  state::Hook* first = nullptr;
  for (const Articulation::Joint& joint : art.joints) {
    if (joint.is_weld()) continue;
    state::Hook& hook = hooks[joint.hook];
    debt += hook.energy_debt;
    hook.energy_debt = 0;
    if (first == nullptr) first = &hook;
  }
  return first;
}

}  // namespace

BodySums sum_bodies(const Articulation& articulation, const state::Bodies& bodies) {
  BodySums sums;
  for_moving(articulation, bodies, [&](const Mover& body) {
    if (!(sums.mass > 0)) sums.place = body.center;
    const DVec3 r = body.center - sums.place;
    sums.mass += body.mass;
    sums.energy += 0.5 * (body.mass * length_squared(body.v) + length_squared(body.root * body.momentum));
    sums.moment += body.mass * r;
    sums.momentum += body.mass * body.v;
    sums.angular_momentum += body.momentum + body.mass * cross(r, body.v);
  });
  return sums;
}

void reset_energy(const Articulation& articulation, std::vector<state::Hook>& hooks) {
  for (const Articulation::Joint& joint : articulation.joints) {
    if (joint.is_weld()) continue;
    hooks[joint.hook].energy_debt = 0;
    hooks[joint.hook].spring_energy = -1;
  }
}

double take_excess(const BodySums& before, double work, const Articulation& articulation,
                   JointTables tables) {
  double debt = 0;
  state::Hook* const memory = collect_debt(articulation, tables.hooks, debt);
  if (memory == nullptr || !(before.mass > 0)) return 1;
  const double most = kEnergySlack * before.energy + 0.5 * before.mass * kEnergyFreeSpeed * kEnergyFreeSpeed;
  const double now = sum_bodies(articulation, tables.bodies).energy;
  debt = std::max(debt + (now - before.energy - work), -most);
  memory->energy_debt = std::min(debt, most);
  if (!(debt > most)) return 1;
  const Twist reference = reference_of(before, articulation, tables.bodies);
  return slow_down(articulation, reference, now - (debt - most), tables.bodies);
}

}  // namespace hooke::solver
