/// Ends of hooks at points: where they are, and where along a rope they slide.

#include "base/assert.h"
#include "solver/coupled/coupled_groups.h"
#include "solver/coupled/coupled_tuning.h"
#include "state/rope_chains.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::Hook;
using state::HookPlace;
using state::Tables;

DVec3 offset_of(const Tables& t, std::uint32_t particle) {
  return vector_cast<double>(t.particles.position[particle].x);
}

/// A rope as a line through its points, near where a hook slides.
struct Line {
  const Tables& t;
  const state::Deformable& rope;

  [[nodiscard]] DVec3 at(std::uint32_t node) const { return offset_of(t, rope.particles.first + node); }
  /// Share of segment `i` that lies before the point of the segment's line that is nearest to x.
  [[nodiscard]] double share(std::uint32_t i, DVec3 x) const {
    const DVec3 d = at(i + 1) - at(i);
    const double square = length_squared(d);
    return square > 0 ? dot(x - at(i), d) / square : 0;
  }
  /// Whether `node` and the next are joined.
  [[nodiscard]] bool goes_on(std::uint32_t node) const { return state::goes_on(rope, t.segments, node); }
  /// Direction from the node before to the node behind; the ends of a chain have one neighbor only.
  [[nodiscard]] DVec3 tangent(std::uint32_t node) const {
    const std::uint32_t before = node > 0 && goes_on(node - 1) ? node - 1 : node;
    return normalize(at(goes_on(node) ? node + 1 : node) - at(before));
  }
};

/// The segment whose line has x beside it. The search goes from segment `i` toward x, within a chain.
std::uint32_t find_segment(const Line& line, std::uint32_t i, DVec3 x) {
  HOOKE_ASSERT(i < line.rope.segments.count);
  const bool onward = line.share(i, x) > 1;
  if (onward) {
    while (line.goes_on(i + 1) && line.share(i, x) > 1) ++i;
  } else {
    while (i > 0 && line.goes_on(i - 1) && line.share(i, x) < 0) --i;
  }
  return i;
}

/// How far the hook may slide along its chain of the rope, as limits of its freedom.
HookLimits limits_along(const Line& line, std::uint32_t segment, double share) {
  double before = 0;
  double behind = 0;
  const auto rest_of = [&](std::uint32_t i) {
    return static_cast<double>(line.t.segments.rest_length[line.rope.segments.first + i]);
  };
  std::uint32_t first = segment;
  while (first > 0 && line.goes_on(first - 1)) --first;
  for (std::uint32_t i = first; i < segment; ++i) before += rest_of(i);
  before += share * rest_of(segment);
  behind += (1 - share) * rest_of(segment);
  for (std::uint32_t i = segment + 1; line.goes_on(i); ++i) behind += rest_of(i);
  return {static_cast<Real>(-before), static_cast<Real>(behind)};
}

void slide(const Tables& t, Hook& hook) {
  const state::Deformable& rope = t.objects[hook.a.object];
  HOOKE_ASSERT(rope.kind == PointRef::Kind::kRope && hook.a.particle[0] >= rope.particles.first);
  const Line line = {t, rope};
  const JointBody b = joint_end(t, hook.b);
  const DVec3 x = b.center + rotate(b.rotation, hook.b.anchor) - rope.origin;
  const std::uint32_t segment = find_segment(line, hook.a.particle[0] - rope.particles.first, x);
  const double share = std::clamp(line.share(segment, x), 0.0, 1.0);
  hook.a.particle[0] = rope.particles.first + segment;
  hook.a.particle[1] = hook.a.particle[0] + 1;
  hook.a.weight[0] = static_cast<Real>(1 - share);
  hook.a.weight[1] = static_cast<Real>(share);
  hook.freedom[0].limits = limits_along(line, segment, share);
}

/// 1 / mass of what holds the other end, if it has `shares` such hooks; a mean over directions [1/kg].
Real inverse_mass_of(const Tables& t, const HookPlace& end, int shares) {
  const JointBody body = joint_end(t, end);
  double sum = 3 * body.inverse_mass;
  if (!end.is_point() && body.inverse_mass > 0) {
    const DVec3 lever = rotate(body.rotation, end.anchor);
    for (const DVec3& axis : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}})
      sum += length_squared(body.scale * cross(lever, axis));
  }
  return static_cast<Real>(shares * sum / 3);
}

}  // namespace

void apply_mass_shares(CoupledGroups& groups, const std::vector<std::uint8_t>& stiff, Tables& t,
                       std::vector<HookedPoint>& points) {
  points.clear();
  std::vector<int>& shares = groups.scratch.counts;
  for (const CoupledGroup& group : groups.live()) {
    shares.assign(group.bodies.size() + 1, 0);
    const auto shares_of = [&](std::uint32_t body) -> int& { return shares[group.body_of(body) + 1]; };
    for (const std::uint32_t row : group.hooks) {
      for (const HookPlace& end : {t.hooks[row].a, t.hooks[row].b}) ++shares_of(end.body);
    }
    for (const std::uint32_t row : group.hooks) {
      const Hook& hook = t.hooks[row];
      if (hook.kind != HookKind::kBall || hook.broken) continue;
      for (const HookPlace* end : {&hook.a, &hook.b}) {
        const HookPlace& other = end == &hook.a ? hook.b : hook.a;
        // If several points share one end, each of them moves freely relative to the others.
        if (end->particle_count != 1 || t.objects[end->object].kind == PointRef::Kind::kRope) continue;
        if (stiff[end->object] != 0) continue;  // Its solution knows the hook.
        state::VelocityRecord& record = t.particles.velocity[end->particle[0]];
        if (!(record.inverse_mass > Real(0)) || other.is_point()) continue;
        points.push_back({end->particle[0], record.inverse_mass, record.v});
        const Real held_by = inverse_mass_of(t, other, shares_of(other.body));
        const Real merged = record.inverse_mass * held_by / (record.inverse_mass + held_by);
        record.inverse_mass = std::max(merged, kLeastMassShare * record.inverse_mass);
      }
    }
  }
}

void remove_mass_shares(const std::vector<HookedPoint>& points, state::Particles& particles) {
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    HOOKE_ASSERT(point->particle < particles.velocity.size());
    state::VelocityRecord& record = particles.velocity[point->particle];
    record.v = point->velocity + (point->inverse_mass / record.inverse_mass) * (record.v - point->velocity);
    record.inverse_mass = point->inverse_mass;
  }
}

void slide_hooks(Tables& t) {
  for (Hook& hook : t.hooks) {
    if (hook.kind == HookKind::kRopeSlide) slide(t, hook);
  }
}

Quaternion<double> slide_rotation(const Tables& t, const Hook& hook) {
  const state::Deformable& rope = t.objects[hook.a.object];
  const Line line = {t, rope};
  const std::uint32_t node = hook.a.particle[0] - rope.particles.first;
  HOOKE_ASSERT(node + 1 < rope.particles.count && hook.a.particle_count == 2);
  const DVec3 x = normalize(static_cast<double>(hook.a.weight[0]) * line.tangent(node) +
                            static_cast<double>(hook.a.weight[1]) * line.tangent(node + 1));
  // Halfway between x and the x axis; for opposite directions, half a turn about y.
  const Quaternion<double> turn = {0, -x.z, x.y, 1 + x.x};
  return 1 + x.x > 1e-9 ? normalize(turn) : Quaternion<double>{0, 1, 0, 0};
}

}  // namespace hooke::solver
