#include "solver/contacts.h"

#include <algorithm>

namespace hooke::solver {

namespace {

void solve_row(std::size_t row, Real h, state::Contacts& contacts, state::Particles& particles) {
  const std::uint32_t p = contacts.particle[row];
  Vec3& v = particles.velocity[p].v;
  const Vec3 n = contacts.normal[row];
  const Real speed = dot(n, v);
  const Real change = std::max(Real(0), -(speed + std::max(contacts.separation[row], Real(0)) / h));
  if (!(change > Real(0))) return;

  v += change * n;
  const Vec3 sliding = v - dot(n, v) * n;
  const Real rate = length(sliding);
  const Real most = contacts.friction[row] * change;
  v -= (rate > most ? most / rate : Real(1)) * sliding;
  contacts.normal_force[row] += change / (h * particles.velocity[p].inverse_mass);
}

void push_out(std::size_t row, Real h, const state::Contacts& contacts, state::Particles& particles) {
  const Real overlap = -contacts.separation[row];
  if (!(overlap > Real(0))) return;
  particles.position[contacts.particle[row]].x +=
      std::min(overlap, Real(kPushOutSpeed) * h) * contacts.normal[row];
}

}  // namespace

void solve_contacts(const std::vector<state::Deformable>& objects, parallel::Range range, Real h,
                    state::Contacts& contacts, state::Particles& particles) {
  const auto& particle = contacts.particle;
  auto row = static_cast<std::size_t>(range.begin);
  while (row > 0 && row < particle.size() && particle[row] == particle[row - 1]) ++row;
  while (row < static_cast<std::size_t>(range.end)) {
    const std::size_t first = row;
    while (row < particle.size() && particle[row] == particle[first]) ++row;
    if (objects[contacts.object[first]].kind == PointRef::Kind::kRope) continue;
    if (!(particles.velocity[particle[first]].inverse_mass > Real(0))) continue;

    for (std::size_t i = first; i < row; ++i) contacts.normal_force[i] = Real(0);
    const int sweeps = row - first > 1 ? 2 : 1;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      for (std::size_t i = first; i < row; ++i) solve_row(i, h, contacts, particles);
    }
    for (std::size_t i = first; i < row; ++i) push_out(i, h, contacts, particles);
  }
}

}  // namespace hooke::solver
