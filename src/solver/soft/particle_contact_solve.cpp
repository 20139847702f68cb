#include "solver/soft/particle_contact_solve.h"

#include "base/assert.h"
#include "solver/soft/soft_tuning.h"

#include <algorithm>

namespace hooke::solver {

namespace {

void solve_row(std::size_t row, Real h, state::Contacts& contacts, state::VelocityRecord& particle) {
  HOOKE_ASSERT(particle.inverse_mass > Real(0));
  const Vec3 n = contacts.normal[row];
  const Vec3 relative = particle.v - contacts.surface_velocity[row];
  const Real speed = dot(n, relative);
  const Real change = -(speed + std::max(contacts.separation[row], Real(0)) / h);
  if (!(change > Real(0))) return;

  particle.v += change * n;
  const Vec3 sliding = relative - speed * n;
  const Real rate = length(sliding);
  const Vec3 stopped =
      rate > Real(0) ? std::min(Real(1), contacts.friction[row] * change / rate) * sliding : Vec3{};
  particle.v -= stopped;
  contacts.normal_force[row] += change / (h * particle.inverse_mass);
  contacts.friction_force[row] -= Real(1) / (h * particle.inverse_mass) * stopped;
}

/// Calls solve(first, end) with the rows of each free particle that belongs to the range.
template <class Solve>
void for_particles(parallel::Range range, const state::Contacts& contacts, const state::Particles& particles,
                   Solve&& solve) {
  const auto& particle = contacts.particle;
  HOOKE_ASSERT(static_cast<std::size_t>(range.end) <= particle.size());
  auto row = static_cast<std::size_t>(range.begin);
  while (row > 0 && row < particle.size() && particle[row] == particle[row - 1]) ++row;
  while (row < static_cast<std::size_t>(range.end)) {
    const std::size_t first = row;
    while (row < particle.size() && particle[row] == particle[first]) ++row;
    if (particles.velocity[particle[first]].inverse_mass > Real(0)) solve(first, row);
  }
}

/// Solves rows [first, end) of one particle.
void solve_rows(std::size_t first, std::size_t end, Real h, const state::Bodies& bodies,
                state::Contacts& contacts, state::Particles& particles) {
  for (std::size_t i = first; i < end; ++i) {
    contacts.normal_force[i] = Real(0);
    contacts.friction_force[i] = {};
  }
  const int sweeps = end - first > 1 ? 2 : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = first; i < end; ++i)
      solve_row(i, h, contacts, particles.velocity[contacts.particle[first]]);
  }
  for (std::size_t i = first; i < end; ++i) push_out(i, h, bodies, contacts, particles);
}

/// Takes the speed with which a particle would pass what does not give way. Its coupled group has solved
/// these contacts; element contacts that came after may have pressed it on.
void stop_at_ground(std::size_t first, std::size_t end, Real h, const state::Bodies& bodies,
                    const state::Contacts& contacts, state::VelocityRecord& particle) {
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (std::size_t row = first; row < end; ++row) {
      if (gives_way(bodies, contacts.body[row])) continue;
      const Real speed = dot(contacts.normal[row], particle.v - contacts.surface_velocity[row]);
      const Real least = -std::max(contacts.separation[row], Real(0)) / h;
      if (speed < least) particle.v += (least - speed) * contacts.normal[row];
    }
  }
}

/// As displace; `first` is the first row of the particle, if it has any.
void displace_from(std::size_t first, std::uint32_t particle, Vec3 by, const state::Bodies& bodies,
                   state::Contacts& contacts, state::Particles& particles) {
  const auto of_particle = [&](std::size_t row) {
    return row < contacts.particle.size() && contacts.particle[row] == particle;
  };
  for (std::size_t row = first; of_particle(row); ++row) {
    if (gives_way(bodies, contacts.body[row])) continue;
    const Real before = contacts.separation[row];
    const Real deeper = std::min(before, Real(0)) - (before + dot(contacts.normal[row], by));
    if (deeper > Real(0)) by += deeper * contacts.normal[row];
  }
  for (std::size_t row = first; of_particle(row); ++row) {
    if (!gives_way(bodies, contacts.body[row])) contacts.separation[row] += dot(contacts.normal[row], by);
  }
  particles.position[particle].x += by;
}

}  // namespace

void displace(std::uint32_t particle, Vec3 by, const state::Bodies& bodies, state::Contacts& contacts,
              state::Particles& particles) {
  const auto first = std::lower_bound(contacts.particle.begin(), contacts.particle.end(), particle);
  displace_from(static_cast<std::size_t>(first - contacts.particle.begin()), particle, by, bodies, contacts,
                particles);
}

void stop_at_ground(std::uint32_t particle, Real h, state::Tables& t) {
  const std::vector<std::uint32_t>& of = t.contacts.particle;
  const auto [first, end] = std::equal_range(of.begin(), of.end(), particle);
  if (first == end || !(t.particles.velocity[particle].inverse_mass > Real(0))) return;
  stop_at_ground(static_cast<std::size_t>(first - of.begin()), static_cast<std::size_t>(end - of.begin()), h,
                 t.bodies, t.contacts, t.particles.velocity[particle]);
}

void push_out(std::size_t row, Real h, const state::Bodies& bodies, state::Contacts& contacts,
              state::Particles& particles) {
  const Real overlap = -contacts.separation[row];
  if (!(overlap > Real(0))) return;
  const std::uint32_t particle = contacts.particle[row];
  std::size_t first = row;
  while (first > 0 && contacts.particle[first - 1] == particle) --first;
  displace_from(first, particle, std::min(overlap, Real(kParticlePushOutSpeed) * h) * contacts.normal[row],
                bodies, contacts, particles);
}

void solve_contacts(const std::vector<state::Deformable>& objects, parallel::Range range, Real h,
                    const state::Bodies& bodies, state::Contacts& contacts, state::Particles& particles) {
  for_particles(range, contacts, particles, [&](std::size_t first, std::size_t end) {
    if (objects[contacts.object[first]].kind == PointRef::Kind::kRope) return;
    if (contacts.coupled[first] != 0) {
      stop_at_ground(first, end, h, bodies, contacts, particles.velocity[contacts.particle[first]]);
    } else {
      solve_rows(first, end, h, bodies, contacts, particles);
    }
  });
}

void solve_contacts_again(const state::Tables& tables, std::span<const std::uint8_t> marked,
                          parallel::Range range, Real h, state::Contacts& contacts,
                          state::Particles& particles) {
  for_particles(range, contacts, particles, [&](std::size_t first, std::size_t end) {
    const std::uint32_t object = contacts.object[first];
    if (marked[object] == 0) return;
    state::VelocityRecord& particle = particles.velocity[contacts.particle[first]];
    if (contacts.coupled[first] != 0 || tables.objects[object].kind == PointRef::Kind::kRope)
      return stop_at_ground(first, end, h, tables.bodies, contacts, particle);
    for (std::size_t row = first; row < end; ++row) solve_row(row, h, contacts, particle);
  });
}

}  // namespace hooke::solver
