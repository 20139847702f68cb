#include "solver/soft/pass_masses.h"

#include "solver/body/body_motion.h"

#include <algorithm>
#include <tuple>

namespace hooke::solver {

namespace {

/// Calls `visit(row, count)` with each row that lends mass, and the number of those that have its body.
template <class Visit>
void for_lending_rows(std::span<const state::ElementContact> passes,
                      std::span<const std::uint8_t> solved_whole, const state::Tables& t, Visit visit) {
  const auto lends = [&](const state::ElementContact& row) {
    return state::gives_way(t.bodies, row.body) && solved_whole[row.object] == 0;
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

}  // namespace

void share_pass_masses(std::span<const state::ElementContact> passes,
                       std::span<const std::uint8_t> solved_whole, state::Tables& t,
                       std::vector<PassMass>& shares) {
  shares.clear();
  for_lending_rows(passes, solved_whole, t, [&](const state::ElementContact& row, Real count) {
    const Real mass = Real(1) / (count * t.bodies.motion[row.body].inverse_mass);
    for (std::uint32_t k = 0; k < row.count; ++k) {
      const Real share = row.weight[k] * mass;
      if (share > Real(0) && t.particles.velocity[row.particle[k]].inverse_mass > Real(0))
        shares.push_back({.particle = row.particle[k], .body = row.body, .mass = share});
    }
  });
  std::stable_sort(shares.begin(), shares.end(), [](const PassMass& a, const PassMass& b) {
    return std::tie(a.particle, a.body) < std::tie(b.particle, b.body);
  });
  for (PassMass& share : shares) {
    state::VelocityRecord& record = t.particles.velocity[share.particle];
    share.velocity = t.bodies.motion[share.body].v;
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
    push_body(share->body, share->mass * (record.v - share->velocity), {}, t.bodies);
  }
}

}  // namespace hooke::solver
