#include "collision/narrow_phase_keep.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

/// Of a body's radius: by so much a pair may drift, so its surfaces lean by no more than twice this [rad].
constexpr Real kDriftShare = Real(5e-4);

// The same for calm bodies of large islands; less than the margin within which points are kept.
constexpr Real kCalmDriftShare = Real(0.03);
constexpr Real kLargestCalmDrift = Real(0.015);  // [m]
constexpr Real kCalmRate = Real(0.25);           // speed of all its points over its radius [1/s]

constexpr int kBodyGrain = 1024;

/// Whether the body stays where it is in this step.
bool stands(const state::Bodies& bodies, std::uint32_t body) {
  if (bodies.asleep[body] != 0 || bodies.traits[body].kind == BodyKind::kStatic) return true;
  return bodies.traits[body].kind == BodyKind::kKinematic && bodies.motion[body].v == Vec3{} &&
         bodies.angular_velocity[body] == Vec3{};
}

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

/// Of an island that is too large to be solved directly (solver/hard_islands.h).
bool is_calm(const state::Bodies& bodies, std::size_t row) {
  const Real radius = bodies.traits[row].radius;
  const Real speed = length(bodies.motion[row].v) + length(bodies.angular_velocity[row]) * radius;
  return bodies.hardness[row] < 0 && speed < kCalmRate * radius;
}

void add_motion(const state::SeenPose& before, const state::SeenPose& now, SmallMotion& motion) {
  if (before.center == now.center && before.rotation == now.rotation) return;
  const Quat turn = normalize(now.rotation * conjugate(before.rotation));
  motion.way = vector_cast<Real>(now.center - before.center);
  motion.turn = displacement_of(turn);
  motion.angle = (turn.w < Real(0) ? Real(-2) : Real(2)) * Vec3{turn.x, turn.y, turn.z};
}

}  // namespace

bool rests(const state::Bodies& bodies, const state::Colliders& colliders, const state::Pair& pair) {
  return pair.tested && stands(bodies, colliders.body[pair.collider_a]) &&
         stands(bodies, colliders.body[pair.collider_b]);
}

bool all_rest(const state::Bodies& bodies, const state::Colliders& colliders, const state::Pairs& pairs) {
  std::size_t next = 0;
  for (const state::Pair& pair : pairs.pair) {
    if (pair.first_manifold != next || !rests(bodies, colliders, pair)) return false;
    next += pair.manifold_count;
  }
  return next == pairs.manifold.size();
}

void find_motions(parallel::ThreadPool& pool, const state::Bodies& bodies, std::vector<state::SeenPose>& seen,
                  std::vector<SmallMotion>& motions) {
  motions.resize(static_cast<std::size_t>(bodies.count()));
  seen.resize(motions.size());
  parallel::for_ranges(pool, bodies.count(), kBodyGrain, [&](parallel::Range range) {
    for (auto row = static_cast<std::size_t>(range.begin); row < static_cast<std::size_t>(range.end); ++row) {
      const state::SeenPose now = {bodies.center[row], bodies.rotation[row]};
      const Real radius = bodies.traits[row].radius;
      const bool calm = is_calm(bodies, row);
      const Real tolerance =
          calm ? std::min(kCalmDriftShare * radius, kLargestCalmDrift) : kDriftShare * radius;
      motions[row] = {.radius = radius, .tolerance = tolerance, .calm = calm};
      add_motion(seen[row], now, motions[row]);
      seen[row] = now;
    }
  });
}

void add_drift(const SmallMotion& a, const SmallMotion& b, state::Drift& drift) {
  drift.way += b.way - a.way;
  drift.angle_a += a.angle;
  drift.angle_b += b.angle;
}

Real largest_drift(const SmallMotion& a, const SmallMotion& b, const state::Drift& drift) {
  return length(drift.way) + length(drift.angle_a) * a.radius + length(drift.angle_b) * b.radius;
}

void carry_along(const SmallMotion& a, const SmallMotion& b, bool fixed_is_a, state::Manifold& m) {
  const bool stays = a.calm && b.calm;
  const Vec3 apart = b.way - a.way;
  if (!stays) {
    m.normal = normalize(m.normal + (fixed_is_a ? a.turn : b.turn) * m.normal);
    m.friction_impulse -= dot(m.friction_impulse, m.normal) * m.normal;
  }
  for (int i = 0; i < m.point_count; ++i) {
    state::ContactPoint& p = m.point[static_cast<std::size_t>(i)];
    const Vec3 of_a = a.turn * p.anchor_a;
    const Vec3 of_b = b.turn * p.anchor_b;
    p.separation += dot(m.normal, apart + of_b - of_a);
    if (stays) continue;
    p.anchor_a += of_a;
    p.anchor_b += of_b;
  }
}

}  // namespace hooke::collision
