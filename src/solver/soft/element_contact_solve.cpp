#include "solver/soft/element_contact_solve.h"

#include "base/assert.h"
#include "solver/body/body_motion.h"
#include "solver/soft/particle_contact_solve.h"
#include "solver/soft/soft_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::ElementContact;

Real inverse_mass_of(const ElementContact& contact, const state::Particles& particles) {
  Real sum = Real(0);
  for (std::uint32_t i = 0; i < contact.count; ++i)
    sum += contact.weight[i] * contact.weight[i] * particles.velocity[contact.particle[i]].inverse_mass;
  return sum;
}

constexpr Real kFar = Real(1e6);  ///< Least separation of a row that does not hold now [m].

void push(const ElementContact& contact, Vec3 impulse, state::Tables& t) {
  HOOKE_ASSERT(contact.count > 0 && contact.count <= contact.particle.size());
  for (std::uint32_t i = 0; i < contact.count; ++i) {
    state::VelocityRecord& record = t.particles.velocity[contact.particle[i]];
    record.v += (contact.weight[i] * record.inverse_mass) * impulse;
  }
  if (gives_way(t.bodies, contact.body)) push_body(contact.body, -impulse, contact.lever, t.bodies);
}

/// Velocity of the contact's place relative to the surface.
Vec3 velocity_of(const ElementContact& contact, const state::Tables& t) {
  Vec3 v = -(state::velocity_now(t.bodies, contact.body, contact.lever) + contact.belt_velocity);
  for (std::uint32_t i = 0; i < contact.count; ++i)
    v += contact.weight[i] * t.particles.velocity[contact.particle[i]].v;
  return v;
}

/// Least speed along the normal at which a row is satisfied [m/s].
Real least_speed(const ElementContact& contact, Real h) {
  return -std::max(contact.separation, Real(0)) / h;
}

/// Returns the change of speed along the normal that was needed [m/s].
Real solve_row(Real h, Real least, ElementContact& contact, state::Tables& t) {
  const Real w = inverse_mass_of(contact, t.particles);
  const auto resists = [&](Vec3 along) {
    return gives_way(t.bodies, contact.body)
               ? w + inverse_mass_at(t.bodies, contact.body, along, contact.lever)
               : w;
  };
  const Vec3 n = contact.normal;
  const Vec3 relative = velocity_of(contact, t);
  const Real speed = dot(n, relative);
  const Real change = least - speed;
  const Real w_normal = resists(n);
  if (!(change > Real(0)) || !(w_normal > Real(0))) return Real(0);

  const Real pushed = change / w_normal;
  if (!std::isfinite(pushed)) return Real(0);
  const Vec3 sliding = relative - speed * n;
  const Real rate = length(sliding);
  Vec3 impulse = pushed * n;
  if (rate > Real(0)) {
    const Vec3 along = (Real(1) / rate) * sliding;
    impulse -= std::min(rate / resists(along), contact.friction * pushed) * along;
  }
  push(contact, impulse, t);
  contact.normal_force += pushed / h;
  return change;
}

}  // namespace

bool is_coupled(const state::Tables& t, const ElementContact& contact) {
  if (!contact.joined) return false;
  if (t.objects[contact.object].kind == PointRef::Kind::kRope) return true;
  return contact.few && gives_way(t.bodies, contact.body);
}

bool is_near(const ElementContact& contact) {
  return contact.separation < kFar;
}

void push_out(const ElementContact& contact, Real h, state::Tables& t) {
  const Real overlap = -contact.separation;
  const Real w = inverse_mass_of(contact, t.particles);
  if (!(overlap > Real(0)) || !(w > Real(0))) return;
  const Vec3 displacement = (std::min(overlap, Real(kParticlePushOutSpeed) * h) / w) * contact.normal;
  for (std::uint32_t i = 0; i < contact.count; ++i) {
    const std::uint32_t p = contact.particle[i];
    displace(p, (contact.weight[i] * t.particles.velocity[p].inverse_mass) * displacement, t.bodies,
             t.contacts, t.particles);
  }
}

Real stop_pass(Real h, ElementContact& pass, state::Tables& t) {
  return solve_row(h, least_speed(pass, h), pass, t);
}

void solve_element_contacts(Real h, state::Tables& t) {
  for (int sweep = 0; sweep < kElementContactSweeps; ++sweep) {
    for (ElementContact& contact : t.element_contacts) {
      if (is_coupled(t, contact)) continue;
      if (sweep == 0) {
        contact.normal_force = Real(0);
        contact.friction_force = {};
        push_out(contact, h, t);
      }
      solve_row(h, least_speed(contact, h), contact, t);
    }
  }
}

}  // namespace hooke::solver
