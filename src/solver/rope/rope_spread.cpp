#include "solver/rope/rope_spread.h"

#include "math/rotation.h"
#include "solver/body/joint_body.h"

#include <algorithm>

namespace hooke::solver {

namespace {

using state::HookPlace;

/// Lists the points of ropes that hooks hold to bodies or to the world.
void list_held_points(const state::Tables& t, std::vector<HeldRopePoint>& held) {
  const auto is_before = [](std::uint32_t particle, const HeldRopePoint& other) {
    return particle < other.particle;
  };
  held.clear();
  for (const state::Hook& hook : t.hooks) {
    if (hook.broken || hook.a.is_point() == hook.b.is_point()) continue;
    const HookPlace& point = hook.point_end();
    if (point.particle_count != 1 || t.objects[point.object].kind != PointRef::Kind::kRope) continue;
    if (hook.kind == HookKind::kDistance || hook.kind == HookKind::kRopeSlide) continue;
    const std::uint32_t body = hook.other_end().body;
    if (body != HookPlace::kWorld && t.bodies.asleep[body] != 0) continue;
    // Hooks mostly come in the order of points, and nothing else is allocated so.
    const auto at = std::upper_bound(held.begin(), held.end(), point.particle[0], is_before);
    held.insert(at, {point.particle[0], body, hook.other_end().anchor});
  }
}

/// One rope in which what rows did is spread.
class Spread {
 public:
  Spread(const RopeSystem& rope, double h, RopeSpreadScratch& scratch, state::Tables& tables)
      : rope_(rope), h_(h), s_(scratch), t_(tables) {}

  void run() {
    if (!load()) return;
    for_held([&](const HeldRopePoint& at, std::size_t node) { hold(at, node); });
    answer();
    for_held([&](const HeldRopePoint& at, std::size_t node) { push(at, s_.change[node]); });
    for (std::uint32_t i = 0; i < rope_.node_count; ++i) {
      const std::uint32_t row = rope_.first_particle + i;
      state::VelocityRecord& record = t_.particles.velocity[row];
      if (!(record.inverse_mass > Real(0))) continue;
      record.v = s_.solved[row].v + vector_cast<Real>(s_.change[i]);
      s_.solved[row].v = record.v;
    }
  }

 private:
  /// Loads the changes of velocity. Returns whether there are any.
  bool load() {
    const std::size_t count = rope_.node_count;
    s_.change.resize(count);
    s_.inverse_mass.resize(count);
    s_.direction.resize(count);
    bool any = false;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t row = rope_.first_particle + i;
      const state::VelocityRecord& now = t_.particles.velocity[row];
      s_.change[i] = vector_cast<double>(now.v) - vector_cast<double>(s_.solved[row].v);
      s_.inverse_mass[i] = static_cast<double>(now.inverse_mass);
      any = any || s_.change[i] != DVec3{};
      if (i == 0) continue;
      const DVec3 along = vector_cast<double>(t_.particles.position[row].x) -
                          vector_cast<double>(t_.particles.position[row - 1].x);
      const double size = length(along);
      s_.direction[i - 1] = size > 0 ? (1 / size) * along : DVec3{};
    }
    return any;
  }

  /// Calls `visit(held point, its node)` with the first hold of each held node.
  template <class Visit>
  void for_held(Visit visit) const {
    const std::uint32_t end = rope_.first_particle + rope_.node_count;
    auto at = std::lower_bound(s_.held.begin(), s_.held.end(), rope_.first_particle,
                               [](const HeldRopePoint& held, std::uint32_t p) { return held.particle < p; });
    for (; at != s_.held.end() && at->particle < end; ++at) {
      const bool is_first = at == s_.held.begin() || (at - 1)->particle != at->particle;
      if (is_first) visit(*at, std::size_t{at->particle - rope_.first_particle});
    }
  }

  /// Gives a held node the mass of what holds it: both move by what rows gave to the node.
  void hold(const HeldRopePoint& at, std::size_t node) {
    const double own = s_.inverse_mass[node];
    if (!(own > 0)) return;
    const double other = mobility_of(at);
    const double both = other > 0 ? own * other / (own + other) : 0;
    s_.change[node] = (both / own) * s_.change[node];
    s_.inverse_mass[node] = both;
  }

  /// Inverse mass of the place that holds a point, the mean of all directions [1/kg].
  [[nodiscard]] double mobility_of(const HeldRopePoint& at) const {
    const JointBody body = joint_body_now(t_.bodies, at.body);
    const DVec3 lever = rotate(body.rotation, at.anchor);
    double turns = 0;
    for (const DVec3 axis : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}})
      turns += length_squared(body.scale * cross(lever, axis));
    return body.inverse_mass > 0 ? body.inverse_mass + turns / 3 : 0;
  }

  /// Gives the body that holds a node the node's change of velocity [m/s].
  void push(const HeldRopePoint& at, DVec3 change) {
    const double mobility = mobility_of(at);
    if (!(mobility > 0) || change == DVec3{}) return;
    const JointBody body = joint_body_now(t_.bodies, at.body);
    const DVec3 impulse = (1 / mobility) * change;
    const DVec3 turn = body.scale * cross(rotate(body.rotation, at.anchor), impulse);
    set_joint_velocity(body, body.v + body.inverse_mass * impulse, body.omega_scaled + turn, at.body,
                       t_.bodies);
  }

  /// Solves for the impulses of segments, and adds them.
  void answer() {
    const std::size_t count = rope_.node_count - 1;
    s_.pivot.resize(count);
    s_.tension.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double a = s_.inverse_mass[i];
      const double b = s_.inverse_mass[i + 1];
      const DVec3 d = s_.direction[i];
      double pivot = dot(d, d) * (a + b) + compliance_of(i);
      double speed = dot(d, s_.change[i + 1] - s_.change[i]);
      if (i > 0 && s_.pivot[i - 1] > 0) {
        const double off = a * dot(d, s_.direction[i - 1]);
        pivot -= off * off / s_.pivot[i - 1];
        speed += off / s_.pivot[i - 1] * s_.tension[i - 1];
      }
      s_.pivot[i] =
          t_.segments.joins(rope_.first_segment + i) && a + b > 0 && pivot > 1e-9 * (a + b) ? pivot : 0;
      s_.tension[i] = speed;
    }
    double next = 0;
    for (std::size_t i = count; i-- > 0;) {
      double sum = s_.tension[i];
      if (i + 1 < count) sum += s_.inverse_mass[i + 1] * dot(s_.direction[i], s_.direction[i + 1]) * next;
      next = s_.pivot[i] > 0 ? sum / s_.pivot[i] : 0;
      pull(i, next);
    }
  }

  [[nodiscard]] double compliance_of(std::size_t segment) const {
    const std::size_t row = rope_.first_segment + segment;
    if (t_.segments.limited[row] != 0) return 0;
    const double stiffness =
        static_cast<double>(t_.segments.damping[row]) + h_ * static_cast<double>(t_.segments.stiffness[row]);
    return 1 / (h_ * stiffness);
  }

  /// Applies the impulse of a segment [N s] to its ends.
  void pull(std::size_t segment, double impulse) {
    const DVec3 along = impulse * s_.direction[segment];
    s_.change[segment] += s_.inverse_mass[segment] * along;
    s_.change[segment + 1] -= s_.inverse_mass[segment + 1] * along;
  }

  const RopeSystem& rope_;
  double h_;
  RopeSpreadScratch& s_;
  state::Tables& t_;
};

}  // namespace

void begin_rope_spread(std::span<const RopeSystem> rope_systems, const SurfaceContacts& surfaces,
                       const state::Tables& tables, RopeSpreadScratch& scratch) {
  scratch.ropes.clear();
  if (!surfaces.active || !surfaces.any_rope) return;
  for (std::size_t i = 0; i < surfaces.live_groups; ++i) {
    const SurfaceGroup& group = surfaces.groups[i];
    if (!group.any_rope) continue;
    for (const std::uint32_t number : group.meshes) {
      const SurfaceMesh& mesh = surfaces.surfaces.meshes[number];
      if (!mesh.is_rope()) continue;
      auto at =
          std::lower_bound(rope_systems.begin(), rope_systems.end(), mesh.object,
                           [](const RopeSystem& rope, std::uint32_t object) { return rope.object < object; });
      for (; at != rope_systems.end() && at->object == mesh.object; ++at) {
        if (!at->in_coupled_group) continue;
        scratch.ropes.push_back(static_cast<std::uint32_t>(at - rope_systems.begin()));
      }
    }
  }
  if (scratch.ropes.empty()) return;
  scratch.solved.resize(tables.particles.velocity.size());
  for (const std::uint32_t i : scratch.ropes) {
    const RopeSystem& rope = rope_systems[i];
    for (std::uint32_t k = 0; k < rope.node_count; ++k)
      scratch.solved[rope.first_particle + k] = tables.particles.velocity[rope.first_particle + k];
  }
  list_held_points(tables, scratch.held);
}

void spread_over_ropes(Real h, std::span<const RopeSystem> rope_systems, RopeSpreadScratch& scratch,
                       state::Tables& tables) {
  for (const std::uint32_t i : scratch.ropes)
    Spread(rope_systems[i], static_cast<double>(h), scratch, tables).run();
}

}  // namespace hooke::solver
