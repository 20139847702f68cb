#include "solver/contacts.h"

#include "solver/bodies.h"
#include "state/body_frames.h"

#include <algorithm>

namespace hooke::solver {

namespace {

/// One row. `yields`: its body gives way.
void solve_row(std::size_t row, Real h, bool yields, state::Bodies& bodies, state::Contacts& contacts,
               state::Particles& particles) {
  state::VelocityLine& particle = particles.velocity[contacts.particle[row]];
  const std::uint32_t body = contacts.body[row];
  const Vec3 n = contacts.normal[row];
  const Vec3 lever = contacts.lever[row];
  // What yields may have been pushed since update_contacts.
  const Vec3 surface = yields ? velocity_now(bodies, body, lever) + contacts.belt_velocity[row]
                              : contacts.surface_velocity[row];
  const auto inverse_mass = [&](Vec3 direction) {
    return particle.inverse_mass + (yields ? inverse_mass_at(bodies, body, direction, lever) : Real(0));
  };
  const Vec3 relative = particle.v - surface;
  const Real speed = dot(n, relative);
  const Real change = -(speed + std::max(contacts.separation[row], Real(0)) / h);
  if (!(change > Real(0))) return;

  const Real push = change / inverse_mass(n);
  Vec3 impulse = push * n;
  const Vec3 sliding = relative - speed * n;
  const Real rate = length(sliding);
  if (rate > Real(0)) {
    const Vec3 along = (Real(1) / rate) * sliding;
    impulse -= std::min(rate / inverse_mass(along), contacts.friction[row] * push) * along;
  }
  particle.v += particle.inverse_mass * impulse;
  if (yields) push_body(body, -impulse, lever, bodies);
  contacts.normal_force[row] += push / h;
}

void push_out(std::size_t row, Real h, const state::Contacts& contacts, state::Particles& particles) {
  const Real overlap = -contacts.separation[row];
  if (!(overlap > Real(0))) return;
  particles.position[contacts.particle[row]].x +=
      std::min(overlap, Real(kPushOutSpeed) * h) * contacts.normal[row];
}

/// Calls solve(first, end) with the rows of each particle that belongs to the range, is no rope's, and is
/// free.
template <class Solve>
void for_particles(const std::vector<state::Deformable>& objects, parallel::Range range,
                   const state::Contacts& contacts, const state::Particles& particles, Solve&& solve) {
  const auto& particle = contacts.particle;
  auto row = static_cast<std::size_t>(range.begin);
  while (row > 0 && row < particle.size() && particle[row] == particle[row - 1]) ++row;
  while (row < static_cast<std::size_t>(range.end)) {
    const std::size_t first = row;
    while (row < particle.size() && particle[row] == particle[first]) ++row;
    if (objects[contacts.object[first]].kind == PointRef::Kind::kRope) continue;
    if (particles.velocity[particle[first]].inverse_mass > Real(0)) solve(first, row);
  }
}

bool any_gives_way(const state::Bodies& bodies, const state::Contacts& contacts, std::size_t first,
                   std::size_t end) {
  return std::any_of(contacts.body.begin() + static_cast<std::ptrdiff_t>(first),
                     contacts.body.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](std::uint32_t body) { return gives_way(bodies, body); });
}

/// Rows [first, end) of one particle.
void solve_rows(std::size_t first, std::size_t end, Real h, state::Bodies& bodies, state::Contacts& contacts,
                state::Particles& particles) {
  for (std::size_t i = first; i < end; ++i) contacts.normal_force[i] = Real(0);
  const int sweeps = end - first > 1 ? 2 : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = first; i < end; ++i)
      solve_row(i, h, gives_way(bodies, contacts.body[i]), bodies, contacts, particles);
  }
  for (std::size_t i = first; i < end; ++i) push_out(i, h, contacts, particles);
}

}  // namespace

void solve_contacts(const std::vector<state::Deformable>& objects, parallel::Range range, Real h,
                    state::Bodies& bodies, state::Contacts& contacts, state::Particles& particles) {
  for_particles(objects, range, contacts, particles, [&](std::size_t first, std::size_t end) {
    if (!any_gives_way(bodies, contacts, first, end)) solve_rows(first, end, h, bodies, contacts, particles);
  });
}

void solve_moving_contacts(const std::vector<state::Deformable>& objects, Real h, state::Bodies& bodies,
                           state::Contacts& contacts, state::Particles& particles) {
  const parallel::Range all = {0, contacts.count()};
  for_particles(objects, all, contacts, particles, [&](std::size_t first, std::size_t end) {
    if (any_gives_way(bodies, contacts, first, end)) solve_rows(first, end, h, bodies, contacts, particles);
  });
}

}  // namespace hooke::solver
