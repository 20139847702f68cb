#include "solver/soft/pressed_points.h"

#include "base/assert.h"
#include "solver/body/body_motion.h"
#include "solver/soft/soft_tuning.h"
#include "state/bodies.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::gives_way;

/// W of a point with one more mass m, which moves with it along the unit vector n alone:
/// (W^-1 + m n n^T)^-1 (Sherman and Morrison 1950).
Symmetric3<double> with_mass_along(const Symmetric3<double>& w, DVec3 n, double m) {
  const DVec3 t = w * n;
  const double s = -m / (1 + m * dot(n, t));
  return w + Symmetric3<double>{s * t.x * t.x, s * t.x * t.y, s * t.x * t.z,
                                s * t.y * t.y, s * t.y * t.z, s * t.z * t.z};
}

/// How fast a point that moves with the velocity v would press on what it touches, beyond reaching it: 0 or
/// less if it does not.
Real pressing_speed(const state::Contacts& contacts, std::size_t row, Vec3 v, Real h) {
  return -dot(contacts.normal[row], v - contacts.surface_velocity[row]) -
         std::max(contacts.separation[row], Real(0)) / h;
}

bool presses(const state::Tables& t, std::size_t row, Real h) {
  const Vec3 v = t.particles.velocity[t.contacts.particle[row]].v;
  return t.contacts.normal_force[row] > Real(0) || pressing_speed(t.contacts, row, v, h) > Real(0);
}

/// The mass that moves with the point of a contact.
double mass_behind(const state::Tables& t, std::size_t row, const std::vector<int>& shares,
                   double inverse_mass) {
  const std::uint32_t body = t.contacts.body[row];
  const double most = kMostMassShare / inverse_mass;
  if (!gives_way(t.bodies, body)) return most;
  const int share = std::max(shares[body], 1);
  return std::min(most, 1 / (share * static_cast<double>(t.bodies.motion[body].inverse_mass)));
}

/// Calls visit(row, bit) with the contacts of a point.
template <class Visit>
void for_contacts(const state::Contacts& contacts, const PressedPoint& point, Visit visit) {
  std::uint32_t bit = 1;
  for (std::size_t row = point.contact;
       bit != 0 && row < contacts.particle.size() && contacts.particle[row] == point.particle;
       ++row, bit <<= 1)
    visit(row, bit);
}

/// Takes what held the point in the substep before, and what it is about to reach.
void hold_at_first(const state::Tables& t, Real h, PressedPoint& point) {
  const state::Contacts& contacts = t.contacts;
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if (presses(t, row, h)) point.held |= bit;
    const Real pressed = contacts.normal_force[row];
    if (!(pressed > Real(0)) ||
        length(contacts.friction_force[row]) < kStickingShare * contacts.friction[row] * pressed) {
      point.stuck |= bit;
    } else {
      point.friction += vector_cast<double>(h * contacts.friction_force[row]);
    }
  });
}

/// What a point is given for contacts to share out: where they hold it, the change of velocity that stress
/// alone causes, and that of the solution across. Of friction beyond its limit the point gets what it can
/// be, and the body the rest: that of a light point would be a large velocity.
DVec3 released_change(Vec3 v, Real h, const PressedPoint& point, state::Tables& t) {
  state::Contacts& contacts = t.contacts;
  const auto w = static_cast<double>(point.inverse_mass);
  const DVec3 free = w * point.impulse;
  DVec3 change = point.change;
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if ((point.held & bit) == 0) return;
    const auto n = vector_cast<double>(contacts.normal[row]);
    const DVec3 rest = free - change;
    change += dot(n, rest) * n;
    const auto stopped = static_cast<double>(pressing_speed(contacts, row, v + vector_cast<Real>(change), h));
    const double most = static_cast<double>(contacts.friction[row]) * std::max(stopped, 0.0);
    const DVec3 across = rest - dot(n, rest) * n;
    const double size = length(across);
    const DVec3 given = (size > most ? most / size : 1) * across;
    change += given;
    contacts.normal_force[row] = static_cast<Real>(std::max(stopped, 0.0)) / (h * point.inverse_mass);
    if (size > most && gives_way(t.bodies, contacts.body[row])) {
      const Vec3 rest_of_friction = vector_cast<Real>((1 / w) * (across - given));
      push_body(contacts.body[row], rest_of_friction, contacts.lever[row], t.bodies);
    }
  });
  return change;
}

/// Lets go what does not hold a point, and takes hold where it would pass. Bodies do not pull, and friction
/// has a limit. What was let go is not held again in the same substep, so that points do not flicker.
void revise(const state::Tables& t, Real h, PressedPoint& point) {
  const state::Contacts& contacts = t.contacts;
  const Vec3 before = t.particles.velocity[point.particle].v;
  const Vec3 free = before + vector_cast<Real>(static_cast<double>(point.inverse_mass) * point.impulse);
  const Vec3 now = before + vector_cast<Real>(point.change);
  point.friction = {};
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if ((point.held & bit) == 0) {
      if ((point.let_go & bit) == 0 && pressing_speed(contacts, row, now, h) > Real(0)) point.held |= bit;
      return;
    }
    const Vec3 relative = free - contacts.surface_velocity[row];
    const Vec3 across = relative - dot(contacts.normal[row], relative) * contacts.normal[row];
    const Real stopped = pressing_speed(contacts, row, free, h);
    if (!(stopped > Real(0))) {
      point.held &= ~bit;
      point.let_go |= bit;
      return;
    }
    const Real rate = length(across);
    const Real most = contacts.friction[row] * stopped;
    if (!(rate < most)) point.stuck &= ~bit;
    if ((point.stuck & bit) == 0 && rate > Real(0))
      point.friction -= vector_cast<double>(std::min(most / rate, Real(1)) / point.inverse_mass * across);
  });
}

/// Finds how a point answers, and how contacts change its velocity before stress does.
void find_answer(const state::Tables& t, const std::vector<int>& shares, Real h, PressedPoint& point) {
  const state::Contacts& contacts = t.contacts;
  const auto inverse_mass = static_cast<double>(point.inverse_mass);
  point.answer = Symmetric3<double>::diagonal(inverse_mass);
  const DVec3 before = vector_cast<double>(t.particles.velocity[point.particle].v);
  point.start = {};
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if ((point.held & bit) == 0) return;
    const double mass = mass_behind(t, row, shares, inverse_mass);
    const double share = mass / (mass + 1 / inverse_mass);
    const auto n = vector_cast<double>(contacts.normal[row]);
    const DVec3 relative = before + point.start - vector_cast<double>(contacts.surface_velocity[row]);
    const double along = dot(n, relative);
    const double stopped =
        -along - static_cast<double>(std::max(contacts.separation[row], Real(0))) / static_cast<double>(h);
    if (stopped > 0 || contacts.normal_force[row] > Real(0)) point.start += share * stopped * n;
    if ((point.stuck & bit) != 0) {
      for (const DVec3& axis : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}})
        point.answer = with_mass_along(point.answer, axis, mass);
      point.start -= share * (relative - along * n);
    } else {
      point.answer = with_mass_along(point.answer, n, mass);
    }
  });
}

}  // namespace

void count_pressing_points(const state::Tables& t, Real h, std::vector<int>& shares) {
  shares.assign(t.bodies.motion.size(), 0);
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row)
    shares[t.contacts.body[row]] += presses(t, row, h);
}

void note_pressed_points(const state::Tables& t, const std::vector<int>& shares, Real h,
                         TetrahedronBlocks& tetrahedra) {
  HOOKE_ASSERT(tetrahedra.pressed.empty());
  const state::Contacts& contacts = t.contacts;
  const std::uint32_t first = tetrahedra.first_particle;
  auto row =
      static_cast<std::size_t>(std::lower_bound(contacts.particle.begin(), contacts.particle.end(), first) -
                               contacts.particle.begin());
  while (row < contacts.particle.size() && contacts.particle[row] - first < tetrahedra.volume_at.size()) {
    const std::uint32_t particle = contacts.particle[row];
    const std::size_t first_row = row;
    while (row < contacts.particle.size() && contacts.particle[row] == particle) ++row;
    const Real inverse_mass = t.particles.velocity[particle].inverse_mass;
    if (!(inverse_mass > Real(0)) || !(tetrahedra.volume_at[particle - first] > Real(0))) continue;
    PressedPoint point = {.particle = particle, .contact = first_row, .inverse_mass = inverse_mass};
    hold_at_first(t, h, point);
    find_answer(t, shares, h, point);
    tetrahedra.pressed.push_back(point);
    tetrahedra.pressed_of[particle - first] = static_cast<std::uint32_t>(tetrahedra.pressed.size());
  }
}

bool renew_pressed_points(const std::vector<int>& shares, const state::Tables& t, Real h,
                          TetrahedronBlocks& tetrahedra) {
  bool any = false;
  for (PressedPoint& point : tetrahedra.pressed) {
    const std::uint32_t held = point.held;
    const std::uint32_t stuck = point.stuck;
    const DVec3 friction = point.friction;
    revise(t, h, point);
    const bool slides_alike = length(point.friction - friction) <= kFrictionError * length(point.friction);
    if (slides_alike && point.held == held && (point.stuck & point.held) == (stuck & point.held)) continue;
    point.is_new_hold = (point.held & ~held) != 0;
    find_answer(t, shares, h, point);
    any = true;
  }
  return any;
}

void release_pressed_points(Real h, TetrahedronBlocks& tetrahedra, state::Tables& t) {
  const Real most = Real(kParticlePushOutSpeed) * h;
  for (const PressedPoint& point : tetrahedra.pressed) {
    Vec3& v = t.particles.velocity[point.particle].v;
    v += vector_cast<Real>(released_change(v, h, point, t));
    const Real deepest = -static_cast<Real>(point.yielding) * most;
    for_contacts(t.contacts, point, [&](std::size_t row, std::uint32_t) {
      t.contacts.separation[row] = std::max(t.contacts.separation[row], deepest);
    });
    tetrahedra.pressed_of[point.particle - tetrahedra.first_particle] = 0;
  }
}

void settle_pressed_points(Real h, TetrahedronBlocks& tetrahedra, state::Tables& t) {
  for (const PressedPoint& point : tetrahedra.pressed) {
    if (point.held == 0) continue;
    const std::size_t row = point.contact + static_cast<std::size_t>(std::countr_zero(point.held));
    const std::uint32_t body = t.contacts.body[row];
    if (!gives_way(t.bodies, body)) continue;
    const Vec3 n = t.contacts.normal[row];
    Vec3& v = t.particles.velocity[point.particle].v;
    const Vec3 relative =
        v - velocity_now(t.bodies, body, t.contacts.lever[row]) - t.contacts.belt_velocity[row];
    const Real along = dot(n, relative);
    Vec3 change = (-along - std::max(t.contacts.separation[row], Real(0)) / h) * n;
    if ((point.stuck & point.held & (~point.held + 1)) != 0) change -= relative - along * n;
    v += change;
    push_body(body, (Real(-1) / point.inverse_mass) * change, t.contacts.lever[row], t.bodies);
  }
  tetrahedra.pressed.clear();
}

}  // namespace hooke::solver
