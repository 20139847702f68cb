#include "collision/deformable/rope_passes.h"

#include "collision/deformable/deformable_tuning.h"
#include "collision/deformable/rope_pair.h"

#include <algorithm>
#include <optional>

namespace hooke::collision {

namespace {

using state::RopeContact;
using state::Tables;

/// The point at which two center lines would come nearer than they may, and by how much they are too fast
/// [m/s].
struct Pass {
  RopePair::Nearest at;
  Real speed = Real(0);
};

std::optional<Pass> find_pass(const Tables& t, Real h, const RopeContact& row, Real share) {
  const RopePair pair(t, h, row);
  const RopePair::Nearest now = pair.nearest(Real(0));
  const Real least = share * std::min(row.least, now.distance);
  if (now.distance - least > pair.longest_displacement()) return std::nullopt;
  const RopePair::Nearest at = pair.advance(now, kPassDirectionShare * least);
  const Real nearer = least - (pair.gap_at_start(at) + pair.gap_growth(at));
  if (!(nearer > kPassNearerShare * least)) return std::nullopt;
  return Pass{at, nearer / h};
}

bool stop(const RopeContact& row, const Pass& pass, Tables& t) {
  const std::array<Real, 4> weight = pass.at.weights();
  Real mobility = Real(0);
  for (std::size_t i = 0; i < 4; ++i)
    mobility += weight[i] * weight[i] * t.particles.velocity[row.particle[i]].inverse_mass;
  if (!(mobility > Real(0))) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    state::VelocityRecord& record = t.particles.velocity[row.particle[i]];
    record.v += (weight[i] * record.inverse_mass * (pass.speed / mobility)) * pass.at.normal;
  }
  return true;
}

bool stop_pairs(Real h, Tables& t) {
  bool any = false;
  for (const RopeContact& row : t.rope_contacts) {
    const std::optional<Pass> pass = find_pass(t, h, row, Real(1));
    any = (pass && stop(row, *pass, t)) || any;
  }
  return any;
}

/// Gives the points of each zone its mean velocity, or that of its held points.
void move_zones(RopeContactFinder& finder, Tables& t) {
  std::vector<RopeContactFinder::Zone>& zones = finder.zone;
  zones.assign(t.particles.position.size(), {});
  const auto for_each_point = [&](auto&& visit) {
    for (const std::uint32_t o : finder.ropes) {
      const state::Rows rows = t.objects[o].particles;
      for (std::uint32_t p = rows.first; p < rows.end(); ++p) visit(p, zones[finder.zones.root(p)]);
    }
  };
  for_each_point([&](std::uint32_t p, RopeContactFinder::Zone& zone) {
    const state::VelocityRecord& record = t.particles.velocity[p];
    const bool is_held = !(record.inverse_mass > Real(0));
    const double mass = is_held ? 1 : static_cast<double>(t.particles.mass[p]);
    ++zone.count;
    if (zone.held) return;
    if (is_held) zone.momentum = {};
    zone.mass = is_held ? mass : zone.mass + mass;
    zone.momentum += mass * vector_cast<double>(record.v);
    zone.held = is_held;
  });
  for_each_point([&](std::uint32_t p, const RopeContactFinder::Zone& zone) {
    state::VelocityRecord& record = t.particles.velocity[p];
    if (zone.count > 1 && record.inverse_mass > Real(0))
      record.v = vector_cast<Real>((1 / zone.mass) * zone.momentum);
  });
}

}  // namespace

void stop_rope_passes(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder, Tables& t) {
  if (finder.ropes.empty()) return;
  renew_rope_contacts(pool, h, finder, t);
  int passes = 0;
  while (passes < kMostPassRounds && stop_pairs(h, t)) ++passes;
  if (passes < kMostPassRounds) return;
  finder.zones.reset(t.particles.position.size());
  for (int i = 0; i < kMostPassZoneRounds; ++i) {
    bool any = false;
    for (const RopeContact& row : t.rope_contacts) {
      if (!find_pass(t, h, row, kPassZoneShare)) continue;
      for (const std::uint32_t p : row.particle) finder.zones.merge(row.particle[0], p);
      any = true;
    }
    if (!any) return;
    move_zones(finder, t);
  }
}

}  // namespace hooke::collision
