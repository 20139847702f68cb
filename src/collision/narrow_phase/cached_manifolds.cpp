#include "collision/narrow_phase/cached_manifolds.h"

#include "base/assert.h"
#include "collision/narrow_phase/narrow_phase_tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::collision {

namespace {

constexpr int kBodyGrain = 1024;

/// The rotation matrix less one. Small rotations keep their digits, which rotate(q, x) - x would lose.
Mat3 rotation_less_one(Quat q) {
  const Vec3 v = {q.x, q.y, q.z};
  const auto column = [&](Vec3 x) {
    const Vec3 t = Real(2) * cross(v, x);
    return q.w * t + cross(v, t);
  };
  return {column({Real(1), Real(0), Real(0)}), column({Real(0), Real(1), Real(0)}),
          column({Real(0), Real(0), Real(1)})};
}

/// Whether the body is slow and belongs to an island that is too large to be solved directly
/// (solver/coupled/direct_islands.h).
bool is_slow(const state::Bodies& bodies, std::size_t row) {
  const Real radius = bodies.traits[row].radius;
  const Real speed = length(bodies.motion[row].v) + length(bodies.angular_velocity[row]) * radius;
  return bodies.direct_state[row] < 0 && speed < kSlowRate * radius;
}

void add_motion(const state::SeenPose& before, const state::SeenPose& now, SmallMotion& motion) {
  if (before.center == now.center && before.rotation == now.rotation) return;
  const Quat rotation_change = normalize(now.rotation * conjugate(before.rotation));
  motion.displacement = vector_cast<Real>(now.center - before.center);
  motion.rotation_change = rotation_less_one(rotation_change);
  motion.angle = (rotation_change.w < Real(0) ? Real(-2) : Real(2)) *
                 Vec3{rotation_change.x, rotation_change.y, rotation_change.z};
  // The chord of the rotation, 2 sin(angle / 2) of a radius, is as long as its vector part twice.
  constexpr Real kRounding = Real(1) + Real(8) * std::numeric_limits<Real>::epsilon();
  motion.reach = kRounding * (length(motion.displacement) + length(motion.angle) * motion.radius);
}

}  // namespace

void SmallMotions::find(parallel::ThreadPool& pool, const state::Bodies& bodies,
                        std::span<const std::uint32_t> moved_set, std::vector<state::SeenPose>& seen) {
  const auto count = static_cast<std::size_t>(bodies.count());
  if (count < motions_.size()) *this = {};  // it is another world
  motions_.resize(count);
  seen.resize(count);
  is_listed_.assign(count, 0);
  rows_.clear();
  const auto list = [this](std::span<const std::uint32_t> rows) {
    for (const std::uint32_t row : rows) {
      HOOKE_ASSERT(row < is_listed_.size());
      if (is_listed_[row] == 0) rows_.push_back(row);
      is_listed_[row] = 1;
    }
  };
  list(moved_set);
  const auto new_ones = static_cast<std::ptrdiff_t>(rows_.size());
  list(before_);
  parallel::for_ranges(pool, static_cast<int>(rows_.size()), kBodyGrain, [&](parallel::Range range) {
    for (int i = range.begin; i < range.end; ++i) {
      const std::uint32_t row = rows_[static_cast<std::size_t>(i)];
      const state::SeenPose now = {bodies.center[row], bodies.rotation[row]};
      const Real radius = bodies.traits[row].radius;
      const bool slow = is_slow(bodies, row);
      const Real tolerance =
          slow ? std::min(kSlowDriftShare * radius, kSlowDriftLimit) : kDriftShare * radius;
      motions_[row] = {.radius = radius, .tolerance = tolerance, .slow = slow};
      add_motion(seen[row], now, motions_[row]);
      seen[row] = now;
    }
  });
  before_.assign(rows_.begin(), rows_.begin() + new_ones);
}

void add_drift(const SmallMotion& a, const SmallMotion& b, state::Drift& drift) {
  drift.displacement += b.displacement - a.displacement;
  drift.angle_a += a.angle;
  drift.angle_b += b.angle;
}

Real largest_drift(const SmallMotion& a, const SmallMotion& b, const state::Drift& drift) {
  return length(drift.displacement) + length(drift.angle_a) * a.radius + length(drift.angle_b) * b.radius;
}

Real gap_after(const SmallMotion& a, const SmallMotion& b, Real gap) {
  constexpr Real kRoundOff = Real(2) * std::numeric_limits<Real>::epsilon();
  return gap - (a.reach + b.reach) - kRoundOff * std::fabs(gap);
}

void move_cached_manifold(const SmallMotion& a, const SmallMotion& b, bool fixed_is_a, state::Manifold& m) {
  const bool stays = a.slow && b.slow;
  HOOKE_ASSERT(m.point_count <= state::Manifold::kMaxPoints);
  const Vec3 apart = b.displacement - a.displacement;
  if (!stays) {
    m.normal = normalize(m.normal + (fixed_is_a ? a.rotation_change : b.rotation_change) * m.normal);
    m.friction_impulse -= dot(m.friction_impulse, m.normal) * m.normal;
  }
  for (int i = 0; i < m.point_count; ++i) {
    state::ContactPoint& p = m.point[static_cast<std::size_t>(i)];
    const Vec3 of_a = a.rotation_change * p.anchor_a;
    const Vec3 of_b = b.rotation_change * p.anchor_b;
    p.separation += dot(m.normal, apart + of_b - of_a);
    if (stays) continue;
    p.anchor_a += of_a;
    p.anchor_b += of_b;
  }
}

}  // namespace hooke::collision
