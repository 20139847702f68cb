#include "solver/soft/pass_masses.h"

#include "solver/body/body_motion.h"

#include <algorithm>
#include <tuple>

namespace hooke::solver {

namespace {

/// Calls `visit(row, count)` with each row that lends mass, and the number of those that have its body.
template <class Visit>
void for_lending_rows(std::span<const state::ElementContact> passes,
                      std::span<const std::uint8_t> solved_whole, std::span<const PressingBody> pressing,
                      const state::Tables& t, Visit visit) {
  const auto lends = [&](const state::ElementContact& row) {
    return state::gives_way(t.bodies, row.body) && solved_whole[row.object] == 0 &&
           !std::binary_search(pressing.begin(), pressing.end(), PressingBody{row.object, row.body});
  };
  std::vector<std::uint32_t> bodies;
  for (const state::ElementContact& row : passes) {
    if (lends(row)) bodies.push_back(row.body);
  }
  std::sort(bodies.begin(), bodies.end());
  for (const state::ElementContact& row : passes) {
    if (!lends(row)) continue;
    const auto [first, end] = std::equal_range(bodies.begin(), bodies.end(), row.body);
    visit(row, static_cast<Real>(end - first));
  }
}

Vec3 lever_of(const state::Tables& t, const state::Deformable& object, const PassMass& share) {
  const DVec3 center = t.bodies.center[share.body] + vector_cast<double>(t.bodies.motion[share.body].dx);
  return t.particles.position[share.particle].x + vector_cast<Real>(object.origin - center);
}

/// Upper bound of 1 / the mass that resists at `lever`, over all directions [1/kg].
Real most_yielding(const state::Bodies& bodies, std::uint32_t body, Vec3 lever) {
  const Real at_center = bodies.motion[body].inverse_mass;
  Real sum = -Real(2) * at_center;
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    sum += inverse_mass_at(bodies, body, axis, lever);
  return std::max(sum, at_center);
}

}  // namespace

void share_pass_masses(std::span<const state::ElementContact> passes,
                       std::span<const std::uint8_t> solved_whole, std::span<const PressingBody> pressing,
                       state::Tables& t, std::vector<PassMass>& shares) {
  shares.clear();
  for_lending_rows(passes, solved_whole, pressing, t, [&](const state::ElementContact& row, Real count) {
    for (std::uint32_t k = 0; k < row.count; ++k) {
      if (!(row.weight[k] > Real(0)) || !(t.particles.velocity[row.particle[k]].inverse_mass > Real(0)))
        continue;
      PassMass share = {.particle = row.particle[k], .body = row.body};
      share.lever = lever_of(t, t.objects[row.object], share);
      share.mass = row.weight[k] / (count * most_yielding(t.bodies, row.body, share.lever));
      shares.push_back(share);
    }
  });
  std::stable_sort(shares.begin(), shares.end(), [](const PassMass& a, const PassMass& b) {
    return std::tie(a.particle, a.body) < std::tie(b.particle, b.body);
  });
  for (PassMass& share : shares) {
    state::VelocityRecord& record = t.particles.velocity[share.particle];
    share.velocity = state::velocity_now(t.bodies, share.body, share.lever);
    share.inverse_mass = record.inverse_mass;
    const Real own = Real(1) / record.inverse_mass;
    record.v += (share.mass / (own + share.mass)) * (share.velocity - record.v);
    record.inverse_mass = Real(1) / (own + share.mass);
  }
}

void give_back_pass_masses(std::span<const PassMass> shares, state::Tables& t) {
  for (auto share = shares.rbegin(); share != shares.rend(); ++share) {
    state::VelocityRecord& record = t.particles.velocity[share->particle];
    record.inverse_mass = share->inverse_mass;
    push_body(share->body, share->mass * (record.v - share->velocity), share->lever, t.bodies);
  }
}

}  // namespace hooke::solver
