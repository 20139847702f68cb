#include "collision/deformable/pass_zones.h"

#include "base/assert.h"
#include "base/disjoint_sets.h"
#include "collision/deformable/body_passes.h"
#include "math/rotation.h"
#include "state/body_frames.h"

#include <algorithm>

namespace hooke::collision {

namespace {

/// Points and bodies that go on as one.
class PassZones {
 public:
  PassZones(state::Tables& tables, BodyPassFinder& finder, Real h)
      : t_(tables), f_(finder), h_(h), points_(static_cast<std::uint32_t>(tables.particles.position.size())) {
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
      if (include(body)) {
        begin_of(body) = {pair.begin, pair.begin_theta};
        any = true;
      }
      for (std::uint32_t k = 0; k < e.count; ++k) {
        any = include(e.particle[k]) || any;
        any = any || sets_.root(e.particle[k]) != sets_.root(body);
        sets_.merge(e.particle[k], body);
      }
    }
    return any;
  }

  /// Moves all members from where they began.
  void move() {
    std::sort(members_.begin(), members_.end());
    zones_.assign(is_in_.size(), {});
    for (const std::uint32_t member : members_) gather(member, zones_[sets_.root(member)]);
    for (const std::uint32_t member : members_) {
      const Zone& zone = zones_[sets_.root(member)];
      if (member < points_) {
        move_point(member, zone);
      } else if (state::gives_way(t_.bodies, member - points_)) {
        move_body(member - points_, begin_of(member), zone);
      }
    }
  }

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(members_.size()); }

 private:
  struct Zone {
    DVec3 momentum = {};
    double mass = 0;
    bool held = false;                  ///< Something in it moves as told.
    std::uint32_t leader = 0xFFFFFFFF;  ///< Member that moves as told; a body if there is one.
  };

  bool include(std::uint32_t member) {
    if (is_in_[member] != 0) return false;
    is_in_[member] = 1;
    members_.push_back(member);
    return true;
  }

  /// Where a body began the particle substep.
  struct Begin {
    Pose pose = {};
    Vec3 theta_scaled = {};
  };

  Begin& begin_of(std::uint32_t body) {
    begin_.resize(t_.bodies.motion.size());
    return begin_[body - points_];
  }

  /// Members come in order, points before bodies, so that a body leads where there is one.
  void gather(std::uint32_t member, Zone& zone) {
    const bool is_point = member < points_;
    Real inverse_mass = Real(0);
    Vec3 v = {};
    if (is_point) {
      inverse_mass = t_.particles.velocity[member].inverse_mass;
      v = t_.particles.velocity[member].v;
    } else if (state::gives_way(t_.bodies, member - points_)) {
      inverse_mass = t_.bodies.motion[member - points_].inverse_mass;
      v = t_.bodies.motion[member - points_].v;
    }
    if (!(inverse_mass > Real(0))) {
      zone.held = true;
      zone.leader = member;
      return;
    }
    const double mass = 1.0 / static_cast<double>(inverse_mass);
    zone.momentum += mass * vector_cast<double>(v);
    zone.mass += mass;
  }

  [[nodiscard]] Vec3 displacement_of(const Zone& zone) {
    if (!zone.held) return vector_cast<Real>((static_cast<double>(h_) / zone.mass) * zone.momentum);
    if (zone.leader < points_) return t_.particles.position[zone.leader].x - f_.start[zone.leader].x;
    const Pose now = state::pose_now(t_.bodies, zone.leader - points_);
    return vector_cast<Real>(now.position - begin_of(zone.leader).pose.position);
  }

  /// Points follow the rotation of a body that moves as told.
  void move_point(std::uint32_t point, const Zone& zone) {
    state::VelocityRecord& record = t_.particles.velocity[point];
    if (!(record.inverse_mass > Real(0))) return;
    Vec3 moved = displacement_of(zone);
    if (zone.held && zone.leader >= points_) {
      const Pose begin = begin_of(zone.leader).pose;
      const Pose now = state::pose_now(t_.bodies, zone.leader - points_);
      const DVec3 lever = origin_of(point) + vector_cast<double>(f_.start[point].x) - begin.position;
      const Quat turn = now.rotation * conjugate(begin.rotation);
      const Vec3 arm = vector_cast<Real>(lever);
      if (!(now.rotation == begin.rotation)) moved += rotate(turn, arm) - arm;
    }
    t_.particles.position[point].x = f_.start[point].x + moved;
    record.v = (Real(1) / h_) * moved;
  }

  [[nodiscard]] DVec3 origin_of(std::uint32_t point) const {
    const auto object =
        std::upper_bound(t_.objects.begin(), t_.objects.end(), point,
                         [](std::uint32_t p, const state::Deformable& o) { return p < o.particles.end(); });
    HOOKE_ASSERT(object != t_.objects.end());
    return object->origin;
  }

  void move_body(std::uint32_t body, const Begin& begin, const Zone& zone) {
    state::MotionRecord& m = t_.bodies.motion[body];
    const Vec3 moved = displacement_of(zone);
    const DVec3 center = begin.pose.position + vector_cast<double>(moved);
    m.dx = vector_cast<Real>(center - t_.bodies.center[body]);
    m.v = (Real(1) / h_) * moved;
    t_.bodies.free_motion[body].v = m.v;
    if (state::is_gyroscopic_now(t_.bodies, body)) {
      t_.bodies.rotation[body] = begin.pose.rotation;
    } else {
      m.theta_scaled = begin.theta_scaled;
    }
  }

  state::Tables& t_;
  BodyPassFinder& f_;
  Real h_;
  std::uint32_t points_;
  base::DisjointSets sets_;
  std::vector<std::uint8_t> is_in_;
  std::vector<std::uint32_t> members_;
  std::vector<Zone> zones_;   ///< By root.
  std::vector<Begin> begin_;  ///< By body.
};

}  // namespace

HeldBack hold_back_passes(parallel::ThreadPool& pool, Real h, BodyPassFinder& finder, state::Tables& t) {
  look_at_body_passes(pool, t, h, finder);
  if (finder.suspects.empty()) {
    end_body_passes(false, finder);
    return {};
  }
  PassZones zones(t, finder, h);
  while (!finder.suspects.empty() && zones.add()) {
    zones.move();
    end_body_passes(true, finder);
    look_at_body_passes(pool, t, h, finder);
  }
  end_body_passes(true, finder);
  return {.moved = zones.count(), .left = static_cast<std::uint32_t>(finder.suspects.size())};
}

}  // namespace hooke::collision
