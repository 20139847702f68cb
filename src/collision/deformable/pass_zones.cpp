#include "collision/deformable/pass_zones.h"

#include "base/assert.h"
#include "base/disjoint_sets.h"
#include "collision/deformable/body_passes.h"
#include "collision/deformable/deformable_tuning.h"
#include "math/rotation.h"
#include "math/symmetric.h"
#include "state/body_frames.h"

#include <algorithm>

namespace hooke::collision {

namespace {

/// Points and bodies that go on as one.
class PassZones {
 public:
  PassZones(state::Tables& tables, std::span<const std::uint8_t> solved_whole, BodyPassFinder& finder,
            state::BodyManifolds& manifolds, Real h)
      : t_(tables),
        whole_(solved_whole.begin(), solved_whole.end()),
        f_(finder),
        manifolds_(manifolds),
        h_(h),
        points_(static_cast<std::uint32_t>(tables.particles.position.size())) {
    sets_.reset(points_ + tables.bodies.motion.size());
    is_in_.assign(points_ + tables.bodies.motion.size(), 0);
  }

  /// Adds what the finder suspects. Returns whether that was anything new.
  bool add() {
    bool any = false;
    for (std::size_t i = 0; i < f_.suspects.size(); ++i) {
      const BodyPassFinder::Pair& pair = f_.pairs[f_.suspect_pair[i]];
      const BodyPassFinder::Element& e = f_.elements[f_.candidates[f_.suspects[i]].element];
      const std::uint32_t body = points_ + pair.body;
      any = include(body) || any;
      for (std::uint32_t k = 0; k < e.count; ++k) {
        any = include(e.particle[k]) || any;
        any = any || sets_.root(e.particle[k]) != sets_.root(body);
        sets_.merge(e.particle[k], body);
      }
    }
    join_solids();
    return any;
  }

  /// Adds bodies that members have been moved into. Returns whether that was anything new.
  bool add_pressed() {
    manifolds_.list(t_);
    bool any = false;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      if (members_[i] < points_) {
        any = add_ground(members_[i]) || any;
        continue;
      }
      for (const std::uint32_t row : manifolds_.of(members_[i] - points_)) {
        const state::Manifold& m = t_.pairs.manifold[row];
        const std::uint32_t a = points_ + m.body_a;
        const std::uint32_t b = points_ + m.body_b;
        if (is_in_[a] != 0 && is_in_[b] != 0 && sets_.root(a) == sets_.root(b)) continue;
        if (!is_pressed(m)) continue;
        include(a);
        include(b);
        sets_.merge(a, b);
        any = true;
      }
    }
    for (const state::Hook& hook : t_.hooks) any = add_hook(hook) || any;
    join_solids();
    return any;
  }

  /// Moves all members from where they began: bodies first, which points follow.
  void move() {
    std::sort(members_.begin(), members_.end());
    zones_.assign(is_in_.size(), {});
    for (const std::uint32_t member : members_) add_mass(member, zone_of(member));
    for (const std::uint32_t member : members_) add_inertia(member, zone_of(member));
    const auto first_body = std::lower_bound(members_.begin(), members_.end(), points_);
    for (auto member = first_body; member != members_.end(); ++member) move_body(*member - points_);
    for (auto member = members_.begin(); member != first_body; ++member) move_point(*member);
  }

  /// Number of suspects that are not of one zone that moves as one.
  [[nodiscard]] std::uint32_t left() {
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < f_.suspects.size(); ++i) {
      const std::uint32_t body = points_ + f_.pairs[f_.suspect_pair[i]].body;
      const BodyPassFinder::Element& e = f_.elements[f_.candidates[f_.suspects[i]].element];
      bool is_one = zone_of(body).told < 2;
      for (std::uint32_t k = 0; k < e.count; ++k)
        is_one = is_one && sets_.root(e.particle[k]) == sets_.root(body);
      count += is_one ? 0 : 1;
    }
    return count;
  }

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(members_.size()); }

 private:
  /// What moves as one rigid body.
  struct Zone {
    double mass = 0;
    DVec3 momentum = {};
    DVec3 place = {};  ///< Mass times position from `origin`.
    DVec3 origin = {};
    DVec3 spin = {};  ///< Angular momentum about the center of mass.
    math::Symmetric3<double> inertia = {};
    bool held = false;               ///< Something in it moves as told, or is hooked to the world.
    std::uint32_t told = 0;          ///< How many of its members move as told.
    std::uint32_t leader = kNobody;  ///< What moves as told, a body if there is one.

    [[nodiscard]] DVec3 center() const { return origin + (1 / mass) * place; }
  };

  /// What a member brings into its zone.
  struct Member {
    double mass = 0;  ///< 0: it moves as told.
    DVec3 momentum = {};
    DVec3 spin = {};           ///< About its own center.
    bool is_anchored = false;  ///< A hook ties it to the world.
  };

  static constexpr std::uint32_t kNobody = 0xFFFFFFFF;

  Zone& zone_of(std::uint32_t member) { return zones_[sets_.root(member)]; }

  [[nodiscard]] Member describe(std::uint32_t member) const {
    if (member < points_) {
      const state::VelocityRecord& record = t_.particles.velocity[member];
      if (!(record.inverse_mass > Real(0))) return {};
      const double mass = 1 / static_cast<double>(record.inverse_mass);
      return {.mass = mass, .momentum = mass * vector_cast<double>(record.v)};
    }
    const std::uint32_t body = member - points_;
    if (!state::gives_way(t_.bodies, body)) return {};
    const state::MotionRecord& m = t_.bodies.motion[body];
    const double mass = 1 / static_cast<double>(m.inverse_mass);
    const Vec3 omega = t_.bodies.scale[body] * m.omega_scaled;
    return {.mass = mass,
            .momentum = mass * vector_cast<double>(m.v),
            .spin = vector_cast<double>(
                state::angular_momentum_of(t_.bodies.mass[body], begin_of(body).rotation, omega))};
  }

  bool include(std::uint32_t member) {
    if (is_in_[member] != 0) return false;
    is_in_[member] = 1;
    members_.push_back(member);
    brought_.resize(is_in_.size());
    brought_[member] = describe(member);
    return true;
  }

  /// Adds all points of each solid that is solved as a whole and has a member.
  void join_solids() {
    for (std::uint32_t i = 0; i < whole_.size(); ++i) {
      if (whole_[i] == 0) continue;
      const state::Rows points = t_.objects[i].particles;
      std::uint32_t first = points.first;
      while (first < points.end() && is_in_[first] == 0) ++first;
      if (first == points.end()) continue;
      for (std::uint32_t p = points.first; p < points.end(); ++p) {
        include(p);
        sets_.merge(first, p);
      }
      whole_[i] = 0;
    }
  }

  /// Adds what a point has been moved into, as far as it does not give way. Returns whether that was new.
  bool add_ground(std::uint32_t point) {
    const state::Contacts& contacts = t_.contacts;
    const auto [first, end] = std::equal_range(contacts.particle.begin(), contacts.particle.end(), point);
    bool any = false;
    for (auto at = first; at != end; ++at) {
      const auto row = static_cast<std::size_t>(at - contacts.particle.begin());
      const std::uint32_t body = points_ + contacts.body[row];
      if (state::gives_way(t_.bodies, contacts.body[row])) continue;
      if (is_in_[body] != 0 && sets_.root(body) == sets_.root(point)) continue;
      const Vec3 moved = t_.particles.position[point].x - f_.start[point].x;
      const Real way = dot(contacts.normal[row], moved - h_ * contacts.surface_velocity[row]);
      if (way > -kPressedOverlap || contacts.separation[row] + way > -kPressedOverlap) continue;
      include(body);
      sets_.merge(point, body);
      any = true;
    }
    return any;
  }

  /// Where a hook's end is, from where that end of the world or body began.
  struct End {
    DVec3 begin = {};
    Vec3 moved = {};
  };

  [[nodiscard]] End end_of(const state::HookPlace& place) const {
    End end;
    for (std::uint32_t k = 0; k < place.particle_count; ++k) {
      const std::uint32_t p = place.particle[k];
      end.begin += static_cast<double>(place.weight[k]) * place_of(p);
      end.moved += place.weight[k] * (t_.particles.position[p].x - f_.start[p].x);
    }
    if (place.is_point()) return end;
    if (place.body == state::HookPlace::kWorld) return {.begin = place.anchor};
    const Pose begin = begin_of(place.body);
    const Pose now = state::pose_now(t_.bodies, place.body);
    end.begin = begin.position + rotate(math::in_double(begin.rotation), place.anchor);
    end.moved =
        vector_cast<Real>(now.position + rotate(math::in_double(now.rotation), place.anchor) - end.begin);
    return end;
  }

  template <class Visit>
  void for_members(const state::HookPlace& place, Visit visit) const {
    for (std::uint32_t k = 0; k < place.particle_count; ++k) visit(place.particle[k]);
    if (!place.is_point() && place.body != state::HookPlace::kWorld) visit(points_ + place.body);
  }

  /// Adds what a hook at points ties to a member, where the zone would pull it off. Returns whether that was
  /// anything new.
  bool add_hook(const state::Hook& hook) {
    const bool holds = hook.holds_point() && !hook.broken && hook.giving == state::Hook::Giving::kHolds &&
                       hook.freedom[0].locked && hook.freedom[1].locked && hook.freedom[2].locked;
    if (!holds) return false;
    const bool to_world = !hook.other_end().is_point() && hook.other_end().body == state::HookPlace::kWorld;
    tied_.clear();
    for (const state::HookPlace* place : {&hook.a, &hook.b})
      for_members(*place, [&](std::uint32_t member) { tied_.push_back(member); });
    const auto is_in = [&](std::uint32_t member) { return is_in_[member] != 0; };
    const auto is_with_first = [&](std::uint32_t member) {
      return is_in(member) && sets_.root(member) == sets_.root(tied_[0]) &&
             (!to_world || brought_[member].is_anchored);
    };
    if (std::none_of(tied_.begin(), tied_.end(), is_in)) return false;
    if (std::all_of(tied_.begin(), tied_.end(), is_with_first)) return false;
    const End a = end_of(hook.a);
    const End b = end_of(hook.b);
    const Vec3 gap = vector_cast<Real>(b.begin - a.begin);
    if (length(gap + b.moved - a.moved) < length(gap) + kPressedOverlap) return false;
    for (const std::uint32_t member : tied_) {
      include(member);
      brought_[member].is_anchored = brought_[member].is_anchored || to_world;
      sets_.merge(tied_[0], member);
    }
    return true;
  }

  /// Whether two bodies overlap more, by something, than when the particle substep began.
  [[nodiscard]] bool is_pressed(const state::Manifold& m) const {
    for (std::int32_t k = 0; k < m.point_count; ++k) {
      const state::ContactPoint& p = m.point[static_cast<std::size_t>(k)];
      const Vec3 begun = way_at_start(m.body_b, p.anchor_b) - way_at_start(m.body_a, p.anchor_a);
      // Points that are found again are those of the substep.
      const Real begin = m.is_refreshed() ? p.separation : p.separation + dot(m.normal, begun);
      const Real change = dot(m.normal, state::displacement_between(t_.bodies, m, p) - begun);
      if (begin + change < std::min(begin, Real(0)) - kPressedOverlap) return true;
    }
    return false;
  }

  /// How far a point of a body had gone since the step began when the particle substep began.
  [[nodiscard]] Vec3 way_at_start(std::uint32_t body, Vec3 anchor) const {
    return state::displacement_of(t_.bodies, body, f_.body_start[body], anchor);
  }

  /// Pose of a body when the particle substep began.
  [[nodiscard]] Pose begin_of(std::uint32_t body) const {
    return state::pose_after(t_.bodies, body, f_.body_start[body]);
  }

  [[nodiscard]] DVec3 place_of(std::uint32_t member) const {
    if (member < points_) return origin_of(member) + vector_cast<double>(f_.start[member].x);
    return begin_of(member - points_).position;
  }

  /// Members come in order, points before bodies, so that a body leads where there is one.
  void add_mass(std::uint32_t member, Zone& zone) {
    const Member& brought = brought_[member];
    const bool is_told = !(brought.mass > 0);
    if (is_told || brought.is_anchored) {
      zone.told += is_told ? 1 : 0;
      if (is_told || !zone.held) zone.leader = is_told ? member : kNobody;
      zone.held = true;
      return;
    }
    if (zone.mass == 0) zone.origin = place_of(member);
    zone.mass += brought.mass;
    zone.momentum += brought.momentum;
    zone.place += brought.mass * (place_of(member) - zone.origin);
  }

  void add_inertia(std::uint32_t member, Zone& zone) {
    const Member& brought = brought_[member];
    if (zone.held) return;
    const DVec3 r = place_of(member) - zone.center();
    zone.spin += cross(r, brought.momentum) + brought.spin;
    const double square = length_squared(r);
    const math::Symmetric3<double> about = {square - r.x * r.x, -r.x * r.y, -r.x * r.z,
                                            square - r.y * r.y, -r.y * r.z, square - r.z * r.z};
    zone.inertia = zone.inertia + scaled(brought.mass, about);
    if (member >= points_) zone.inertia = zone.inertia + inertia_of(member - points_);
  }

  static math::Symmetric3<double> scaled(double s, const math::Symmetric3<double>& m) {
    return {s * m.xx, s * m.xy, s * m.xz, s * m.yy, s * m.yz, s * m.zz};
  }

  [[nodiscard]] math::Symmetric3<double> inertia_of(std::uint32_t body) const {
    const Quat rotation = begin_of(body).rotation;
    const auto column = [&](Vec3 axis) {
      return vector_cast<double>(state::angular_momentum_of(t_.bodies.mass[body], rotation, axis));
    };
    const DVec3 x = column({1, 0, 0});
    const DVec3 y = column({0, 1, 0});
    return {x.x, x.y, x.z, y.y, y.z, column({0, 0, 1}).z};
  }

  /// How a zone that nothing holds turns [rad/s].
  [[nodiscard]] static DVec3 turn_rate_of(const Zone& zone) {
    return math::inverse(zone.inertia) * zone.spin;
  }

  /// How a place moves with a zone that nothing holds.
  [[nodiscard]] Vec3 way_of(DVec3 place, const Zone& zone) const {
    const DVec3 arm = place - zone.center();
    const DVec3 turned = rotate(math::quaternion_of(static_cast<double>(h_) * turn_rate_of(zone)), arm);
    return vector_cast<Real>((static_cast<double>(h_) / zone.mass) * zone.momentum + (turned - arm));
  }

  void move_body(std::uint32_t body) {
    if (!state::gives_way(t_.bodies, body)) return;
    const Zone& zone = zone_of(points_ + body);
    // In a zone that is held it keeps its rotation: it would go on to turn faster, held in place.
    const Vec3 omega = zone.held ? Vec3{} : vector_cast<Real>(turn_rate_of(zone));
    const Vec3 moved = zone.held ? way_of_leader(zone) : way_of(place_of(points_ + body), zone);
    const state::BodyMotion& start = f_.body_start[body];
    if (!is_finite(start.dx + moved) || !is_finite(start.theta_scaled + omega)) return;  // for quarantine
    state::MotionRecord& m = t_.bodies.motion[body];
    // What contacts gave to the body stays theirs: they apply it again in the next substep.
    state::FreeMotionRecord& free = t_.bodies.free_motion[body];
    const Vec3 by_contacts = m.v - free.v;
    const Vec3 turn_by_contacts = m.omega_scaled - free.omega_scaled;
    m.dx = start.dx + moved;
    m.v = (Real(1) / h_) * moved;
    m.omega_scaled = math::inverse(t_.bodies.scale[body]) * omega;
    m.theta_scaled = start.theta_scaled + h_ * m.omega_scaled;
    free.v = m.v - by_contacts;
    free.omega_scaled = m.omega_scaled - turn_by_contacts;
    t_.bodies.angular_momentum[body] = math::inverse(t_.bodies.scale[body]) * free.omega_scaled;
    set_rotation(body, normalize(math::quaternion_of(h_ * omega) * begin_of(body).rotation));
    if (!state::is_gyroscopic_now(t_.bodies, body)) return;
    t_.bodies.angular_momentum[body] =
        state::angular_momentum_of(t_.bodies.mass[body], t_.bodies.rotation[body], omega) -
        math::inverse(t_.bodies.scale[body]) * turn_by_contacts;
  }

  /// Rotates a body to `now`, by its rotation vector since the step began where that is what rotates it.
  void set_rotation(std::uint32_t body, Quat now) {
    const Quat begin = f_.body_start[body].rotation;
    if (state::is_gyroscopic_now(t_.bodies, body)) {
      t_.bodies.rotation[body] = now;
      return;
    }
    Vec3& theta = t_.bodies.motion[body].theta_scaled;
    theta =
        math::inverse(t_.bodies.scale[body]) * math::turn_between(begin, now, t_.bodies.scale[body] * theta);
  }

  [[nodiscard]] Vec3 way_of_leader(const Zone& zone) const {
    if (zone.leader == kNobody) return {};
    if (zone.leader < points_) return t_.particles.position[zone.leader].x - f_.start[zone.leader].x;
    const Pose now = state::pose_now(t_.bodies, zone.leader - points_);
    return vector_cast<Real>(now.position - begin_of(zone.leader - points_).position);
  }

  void move_point(std::uint32_t point) {
    state::VelocityRecord& record = t_.particles.velocity[point];
    if (!(record.inverse_mass > Real(0))) return;
    const Zone& zone = zone_of(point);
    const Vec3 moved = zone.held ? way_with_leader(place_of(point), zone) : way_of(place_of(point), zone);
    if (!is_finite(f_.start[point].x + moved)) return;
    t_.particles.position[point].x = f_.start[point].x + moved;
    record.v = (Real(1) / h_) * moved;
  }

  /// How a place moves with what the zone follows, and turns with it.
  [[nodiscard]] Vec3 way_with_leader(DVec3 place, const Zone& zone) const {
    const Vec3 moved = way_of_leader(zone);
    if (zone.leader == kNobody || zone.leader < points_) return moved;
    const Pose begin = begin_of(zone.leader - points_);
    const Pose now = state::pose_now(t_.bodies, zone.leader - points_);
    if (now.rotation == begin.rotation) return moved;
    const Vec3 arm = vector_cast<Real>(place - begin.position);
    return moved + (rotate(now.rotation * conjugate(begin.rotation), arm) - arm);
  }

  [[nodiscard]] DVec3 origin_of(std::uint32_t point) const {
    const auto object =
        std::upper_bound(t_.objects.begin(), t_.objects.end(), point,
                         [](std::uint32_t p, const state::Deformable& o) { return p < o.particles.end(); });
    HOOKE_ASSERT(object != t_.objects.end());
    return object->origin;
  }

  state::Tables& t_;
  std::vector<std::uint8_t> whole_;  ///< By object: it is solved as a whole, and is in no zone yet.
  BodyPassFinder& f_;
  state::BodyManifolds& manifolds_;
  Real h_;
  std::uint32_t points_;
  base::DisjointSets sets_;
  std::vector<std::uint8_t> is_in_;
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> tied_;  ///< Scratch memory: what a hook ties.
  std::vector<Member> brought_;      ///< By member.
  std::vector<Zone> zones_;          ///< By root.
};

}  // namespace

HeldBack hold_back_passes(parallel::ThreadPool& pool, Real h, std::span<const std::uint8_t> solved_whole,
                          state::BodyManifolds& manifolds, BodyPassFinder& finder, state::Tables& t) {
  look_at_body_passes(pool, t, h, finder);
  if (finder.suspects.empty()) {
    end_body_passes(false, finder);
    return {};
  }
  PassZones zones(t, solved_whole, finder, manifolds, h);
  while (!finder.suspects.empty() && zones.add()) {
    do {
      zones.move();
    } while (zones.add_pressed());
    end_body_passes(true, finder);
    look_at_body_passes(pool, t, h, finder);
  }
  end_body_passes(true, finder);
  return {.moved = zones.count(), .left = zones.left()};
}

}  // namespace hooke::collision
