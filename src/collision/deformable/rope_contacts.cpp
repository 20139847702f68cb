#include "collision/deformable/rope_contacts.h"

#include "base/assert.h"
#include "base/take_turns.h"
#include "collision/deformable/contact_frames.h"
#include "collision/deformable/deformable_tuning.h"
#include "collision/deformable/rope_contact_places.h"
#include "geometry/box.h"
#include "parallel/range.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace hooke::collision {

namespace {

using state::RopeContact;
using state::Tables;

constexpr int kRopeContactGrain = 32;

auto key_of(const RopeContact& row) {
  return std::tie(row.segment_a, row.segment_b);
}

bool may_touch(const state::Deformable& object) {
  return object.kind == PointRef::Kind::kRope && object.touches_ropes;
}

Vec3 mean_velocity(const Tables& t, const std::vector<std::uint32_t>& ropes) {
  HOOKE_ASSERT(!ropes.empty());
  DVec3 sum;
  double count = 0;
  for (const std::uint32_t o : ropes) {
    const state::Rows rows = t.objects[o].particles;
    for (std::uint32_t p = rows.first; p < rows.end(); ++p)
      sum += vector_cast<double>(t.particles.velocity[p].v);
    count += rows.count;
  }
  return vector_cast<Real>((1 / count) * sum);
}

/// Notes the positions of the rope's points and how far they may move, and the boxes around its segments.
/// Coordinates are offsets from `origin`.
void set_boxes(const Tables& t, std::uint32_t object, DVec3 origin, Real dt, RopeContactFinder& finder) {
  const state::Deformable& rope = t.objects[object];
  const Vec3 offset = vector_cast<Real>(rope.origin - origin);
  const Real fall = length(t.desc.gravity) * dt * dt;
  for (std::uint32_t p = rope.particles.first; p < rope.particles.end(); ++p) {
    const state::PositionRecord& at = t.particles.position[p];
    finder.start[p] = at.x;
    finder.margin[p] = at.radius + fall + dt * length(t.particles.velocity[p].v - finder.drift);
  }
  Real arc = Real(0);
  for (std::uint32_t i = 0; i < rope.segments.count; ++i) {
    const std::uint32_t row = rope.segments.first + i;
    const std::uint32_t p = rope.particles.first + i;
    const Vec3 a = offset + t.particles.position[p].x;
    const Vec3 b = offset + t.particles.position[p + 1].x;
    const Real grown = t.particles.position[p].radius + std::max(finder.margin[p], finder.margin[p + 1]);
    const Vec3 all = {grown, grown, grown};
    finder.object_of[row] = object;
    finder.arc[row] = arc;
    arc += t.segments.rest_length[row];
    // A place that is not finite waits for the step's quarantine; until then its segment keeps its old box.
    if (!is_finite(a) || !is_finite(b) || !std::isfinite(grown)) continue;
    const geometry::Box box = geometry::box_of(a, b, b);
    finder.broad_phase.set(row, {box.lower - all, box.upper + all}, true);
  }
}

bool any_free(const Tables& t, const RopeContact& row) {
  return std::any_of(row.particle.begin(), row.particle.end(),
                     [&](std::uint32_t p) { return t.particles.velocity[p].inverse_mass > Real(0); });
}

void add_row(const Tables& t, ColliderPair pair, RopeContactFinder& finder) {
  RopeContact row = {.segment_a = pair.first, .segment_b = pair.second};
  row.object_a = finder.object_of[pair.first];
  row.object_b = finder.object_of[pair.second];
  HOOKE_ASSERT(pair.first < pair.second && row.object_a <= row.object_b);
  const state::Deformable& a = t.objects[row.object_a];
  const state::Deformable& b = t.objects[row.object_b];
  const std::uint32_t first_a = a.particles.first + row.segment_a - a.segments.first;
  const std::uint32_t first_b = b.particles.first + row.segment_b - b.segments.first;
  row.particle = {first_a, first_a + 1, first_b, first_b + 1};
  const Real radius = t.particles.position[first_a].radius;
  row.thickness = radius + t.particles.position[first_b].radius;
  row.least = kPassKeptShare * row.thickness;
  if (row.object_a == row.object_b) {
    const Real between =
        finder.arc[row.segment_b] - finder.arc[row.segment_a] - t.segments.rest_length[row.segment_a];
    if (row.segment_b == row.segment_a + 1) return;
    row.adjacent = between < std::numbers::pi_v<Real> * radius;
    row.least = std::min(row.least, kPassKeptShare * between);
  }
  row.friction = std::sqrt(a.friction * b.friction);
  if (any_free(t, row)) finder.contacts.push_back(row);
}

void find_neighbors(std::vector<RopeContact>& rows) {
  const auto find = [&](const RopeContact& of, std::uint32_t a, std::uint32_t b) {
    const auto at =
        std::lower_bound(rows.begin(), rows.end(), std::pair(a, b),
                         [](const RopeContact& row, const std::pair<std::uint32_t, std::uint32_t>& key) {
                           return std::pair(row.segment_a, row.segment_b) < key;
                         });
    const bool found = at != rows.end() && at->segment_a == a && at->segment_b == b &&
                       at->object_a == of.object_a && at->object_b == of.object_b && !at->adjacent;
    return found ? static_cast<std::uint32_t>(at - rows.begin()) : RopeContact::kNone;
  };
  for (RopeContact& row : rows) {
    const auto [a, b] = std::pair(row.segment_a, row.segment_b);
    row.neighbor = {find(row, a - 1, b), find(row, a + 1, b), find(row, a, b - 1), find(row, a, b + 1)};
  }
}

/// Carries over what is known of a pair. Rows of both tables stand in order, so one walk is enough.
void carry(const std::vector<RopeContact>& from, std::vector<RopeContact>& to) {
  auto old = from.begin();
  for (RopeContact& row : to) {
    while (old != from.end() && key_of(*old) < key_of(row)) ++old;
    if (old == from.end()) return;
    if (key_of(*old) != key_of(row)) continue;
    row.weight = old->weight;
    row.normal = old->normal;
    row.separation = old->separation;
    row.normal_force = old->normal_force;
    row.friction_force = old->friction_force;
    row.joined = old->joined;
  }
}

void find(parallel::ThreadPool& pool, Real dt, RopeContactFinder& finder, Tables& t) {
  finder.ropes.clear();
  for (std::uint32_t o = 0; o < t.objects.size(); ++o) {
    if (may_touch(t.objects[o])) finder.ropes.push_back(o);
  }
  finder.contacts.clear();
  if (!finder.ropes.empty()) {
    if (finder.revision != t.revision) finder.broad_phase.clear();
    finder.revision = t.revision;
    finder.object_of.resize(t.segments.rest_length.size());
    finder.arc.resize(t.segments.rest_length.size());
    finder.start.resize(t.particles.position.size());
    finder.margin.resize(t.particles.position.size());
    finder.drift = mean_velocity(t, finder.ropes);
    finder.elapsed = Real(0);
    const DVec3 origin = t.objects[finder.ropes.front()].origin;
    for (const std::uint32_t o : finder.ropes) set_boxes(t, o, origin, dt, finder);
    finder.broad_phase.find_pairs(pool, finder.pairs);
    for (const ColliderPair pair : finder.pairs) {
      const bool any_gone = !t.segments.joins(pair.first) || !t.segments.joins(pair.second);
      if (!any_gone) add_row(t, pair, finder);
    }
    find_neighbors(finder.contacts);
  }
  carry(t.rope_contacts, finder.contacts);
  base::take_turns(t.rope_contacts, finder.contacts);
}

/// Whether something may, within `h`, get to where its rows are not known.
bool left_margin(const Tables& t, Real h, const RopeContactFinder& finder) {
  const Vec3 drifted = (finder.elapsed + h) * finder.drift;
  for (const std::uint32_t o : finder.ropes) {
    const state::Rows rows = t.objects[o].particles;
    for (std::uint32_t p = rows.first; p < rows.end(); ++p) {
      const Vec3 then = t.particles.position[p].x + h * t.particles.velocity[p].v;
      if (length_squared(then - finder.start[p] - drifted) > finder.margin[p] * finder.margin[p]) return true;
    }
  }
  return false;
}

/// The row that acts in place of one that does not, or kNone.
std::uint32_t successor_of(const std::vector<RopeContact>& rows, std::uint32_t row) {
  for (int i = 0; i < kMostSuccessorSteps && row != RopeContact::kNone; ++i) {
    if (rows[row].separation < kNoContact) return row;
    row = rows[row].successor;
  }
  return RopeContact::kNone;
}

/// Rows that act no more hand their forces over to their successors.
void hand_over(std::vector<RopeContact>& rows) {
  for (RopeContact& row : rows) {
    if (row.separation < kNoContact || row.normal == Vec3{}) continue;
    const std::uint32_t successor = successor_of(rows, row.successor);
    HOOKE_ASSERT(successor == RopeContact::kNone || &rows[successor] != &row);
    if (successor != RopeContact::kNone && dot(rows[successor].normal, row.normal) > kRopeSameSide) {
      rows[successor].normal_force += row.normal_force;
      rows[successor].friction_force += row.friction_force;
    }
    row.normal = {};
    row.normal_force = Real(0);
    row.friction_force = {};
  }
}

}  // namespace

void find_rope_contacts(parallel::ThreadPool& pool, Real dt, RopeContactFinder& finder, Tables& t) {
  find(pool, dt, finder, t);
  // Rows that acted in the last substep of the step before are solved with the others from the start.
  for (RopeContact& row : t.rope_contacts) row.joined = row.normal != Vec3{};
}

bool renew_rope_contacts(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder, Tables& t) {
  if (finder.ropes.empty() || !left_margin(t, h, finder)) return false;
  find(pool, Real(kRopeSearchSubsteps) * h, finder, t);
  return true;
}

void update_rope_contacts(parallel::ThreadPool& pool, Real h, RopeContactFinder& finder, Tables& t) {
  if (finder.ropes.empty()) return;
  renew_rope_contacts(pool, h, finder, t);
  finder.elapsed += h;
  parallel::for_ranges(pool, static_cast<int>(t.rope_contacts.size()), kRopeContactGrain,
                       [&](parallel::Range range) {
                         for (int i = range.begin; i < range.end; ++i)
                           update_rope_row(t, h, t.rope_contacts[i]);
                       });
  hand_over(t.rope_contacts);
}

}  // namespace hooke::collision
