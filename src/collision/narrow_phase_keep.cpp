#include "collision/narrow_phase_keep.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

/// Of a body's radius: by so much a pair may drift, so its surfaces lean by no more than twice this [rad].
constexpr Real kDriftShare = Real(5e-4);
constexpr int kBodyGrain = 1024;

/// The rotation less one: small turns keep their digits, which rotate(q, x) - x would lose.
Mat3 displacement_of(Quat q) {
  const Vec3 v = {q.x, q.y, q.z};
  const auto column = [&](Vec3 x) {
    const Vec3 t = Real(2) * cross(v, x);
    return q.w * t + cross(v, t);
  };
  return {column({Real(1), Real(0), Real(0)}), column({Real(0), Real(1), Real(0)}),
          column({Real(0), Real(0), Real(1)})};
}

SmallMotion motion_between(const state::SeenPose& before, const state::SeenPose& now, Real radius) {
  SmallMotion motion = {.tolerance = kDriftShare * radius};
  if (before.center == now.center && before.rotation == now.rotation) return motion;
  const Quat turn = normalize(now.rotation * conjugate(before.rotation));
  motion.way = vector_cast<Real>(now.center - before.center);
  motion.turn = displacement_of(turn);
  motion.reach = Real(2) * length(Vec3{turn.x, turn.y, turn.z}) * radius;
  return motion;
}

}  // namespace

std::vector<SmallMotion> motions_since(parallel::ThreadPool& pool, const state::Bodies& bodies,
                                       std::vector<state::SeenPose>& seen) {
  std::vector<SmallMotion> motions(static_cast<std::size_t>(bodies.count()));
  seen.resize(motions.size());
  parallel::for_ranges(pool, bodies.count(), kBodyGrain, [&](parallel::Range range) {
    for (auto row = static_cast<std::size_t>(range.begin); row < static_cast<std::size_t>(range.end); ++row) {
      const state::SeenPose now = {bodies.center[row], bodies.rotation[row]};
      motions[row] = motion_between(seen[row], now, bodies.traits[row].radius);
      seen[row] = now;
    }
  });
  return motions;
}

Real drift_of(const SmallMotion& a, const SmallMotion& b) {
  return length(b.way - a.way) + a.reach + b.reach;
}

void carry_along(const SmallMotion& a, const SmallMotion& b, bool fixed_is_a, state::Manifold& m) {
  const Vec3 apart = b.way - a.way;
  m.normal = normalize(m.normal + (fixed_is_a ? a.turn : b.turn) * m.normal);
  m.friction_impulse -= dot(m.friction_impulse, m.normal) * m.normal;
  for (int i = 0; i < m.point_count; ++i) {
    state::ContactPoint& p = m.point[static_cast<std::size_t>(i)];
    const Vec3 of_a = a.turn * p.anchor_a;
    const Vec3 of_b = b.turn * p.anchor_b;
    p.separation += dot(m.normal, apart + of_b - of_a);
    p.anchor_a += of_a;
    p.anchor_b += of_b;
  }
}

}  // namespace hooke::collision
