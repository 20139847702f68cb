#include "solver/soft/pressed_points.h"

#include "base/assert.h"
#include "solver/soft/soft_tuning.h"
#include "state/bodies.h"

#include <algorithm>
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

/// The mass that moves with the point of a contact.
double mass_behind(const state::Tables& t, std::size_t row, const std::vector<int>& shares,
                   double inverse_mass) {
  const std::uint32_t body = t.contacts.body[row];
  const double most = kMostMassShare / inverse_mass;
  if (!gives_way(t.bodies, body)) return most;
  return std::min(most, 1 / (shares[body] * static_cast<double>(t.bodies.motion[body].inverse_mass)));
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

/// Takes what held the point in the substep before.
void hold_as_before(const state::Contacts& contacts, PressedPoint& point) {
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    const Real pressed = contacts.normal_force[row];
    if (pressed > Real(0)) point.held |= bit;
    if (length(contacts.friction_force[row]) < kStickingShare * contacts.friction[row] * pressed)
      point.stuck |= bit;
  });
}

/// Lets go what does not hold a point that would move with the velocity v if nothing held it: bodies do not
/// pull, and friction has a limit. Nothing is held again in the same substep, so that points do not flicker.
void let_go(const state::Contacts& contacts, Vec3 v, PressedPoint& point) {
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    const Vec3 relative = v - contacts.surface_velocity[row];
    const Real away = dot(contacts.normal[row], relative);
    const Vec3 across = relative - away * contacts.normal[row];
    if (!(away < Real(0))) point.held &= ~bit;
    if (!(length(across) < -kLettingGoShare * contacts.friction[row] * away)) point.stuck &= ~bit;
  });
}

/// W of a point.
Symmetric3<double> answer_of(const state::Tables& t, const std::vector<int>& shares,
                             const PressedPoint& point) {
  const auto inverse_mass = static_cast<double>(point.inverse_mass);
  auto answer = Symmetric3<double>::diagonal(inverse_mass);
  for_contacts(t.contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if ((point.held & bit) == 0) return;
    const double mass = mass_behind(t, row, shares, inverse_mass);
    if ((point.stuck & bit) != 0) {
      for (const DVec3& axis : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}})
        answer = with_mass_along(answer, axis, mass);
    } else {
      answer = with_mass_along(answer, vector_cast<double>(t.contacts.normal[row]), mass);
    }
  });
  return answer;
}

/// The impulse that has changed the velocity of a point since it was noted.
DVec3 impulse_on(const PressedPoint& point, const state::VelocityRecord& record) {
  return math::inverse(point.answer) * vector_cast<double>(record.v - point.velocity);
}

}  // namespace

void count_pressing_points(const state::Tables& t, std::vector<int>& shares) {
  shares.assign(t.bodies.motion.size(), 0);
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row)
    shares[t.contacts.body[row]] += t.contacts.normal_force[row] > Real(0);
}

void note_pressed_points(const state::Tables& t, const std::vector<int>& shares,
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
    bool pressed = false;
    for (; row < contacts.particle.size() && contacts.particle[row] == particle; ++row)
      pressed = pressed || contacts.normal_force[row] > Real(0);
    const state::VelocityRecord& record = t.particles.velocity[particle];
    if (!pressed || !(record.inverse_mass > Real(0)) || !(tetrahedra.volume_at[particle - first] > Real(0)))
      continue;
    PressedPoint point = {.particle = particle,
                          .contact = first_row,
                          .inverse_mass = record.inverse_mass,
                          .velocity = record.v};
    hold_as_before(contacts, point);
    point.answer = answer_of(t, shares, point);
    tetrahedra.pressed.push_back(point);
    tetrahedra.pressed_of[particle - first] = static_cast<std::uint32_t>(tetrahedra.pressed.size());
  }
}

void renew_pressed_points(const std::vector<int>& shares, TetrahedronBlocks& tetrahedra, state::Tables& t) {
  for (PressedPoint& point : tetrahedra.pressed) {
    state::VelocityRecord& record = t.particles.velocity[point.particle];
    const DVec3 impulse = impulse_on(point, record);
    const Vec3 free = point.velocity + vector_cast<Real>(static_cast<double>(point.inverse_mass) * impulse);
    let_go(t.contacts, free, point);
    point.answer = answer_of(t, shares, point);
    record.v = point.velocity + vector_cast<Real>(point.answer * impulse);
  }
}

void release_pressed_points(TetrahedronBlocks& tetrahedra, state::Particles& particles) {
  for (const PressedPoint& point : tetrahedra.pressed) {
    state::VelocityRecord& record = particles.velocity[point.particle];
    record.v = point.velocity +
               vector_cast<Real>(static_cast<double>(point.inverse_mass) * impulse_on(point, record));
    tetrahedra.pressed_of[point.particle - tetrahedra.first_particle] = 0;
  }
  tetrahedra.pressed.clear();
}

}  // namespace hooke::solver
