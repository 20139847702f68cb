#include "collision/manifold/manifold_match.h"

#include "base/assert.h"
#include "collision/manifold/manifold_tuning.h"

#include <algorithm>
#include <array>
#include <limits>

namespace hooke::collision {

namespace {

using state::ContactPoint;
using state::Manifold;

/// Result of the match by key; points that found no impulse are left to match_by_position. Bit i: point i of
/// the old manifold has been used, or point i of the new one has its impulse.
struct Matched {
  unsigned old_points = 0;
  unsigned new_points = 0;
};

Real distance_squared(const ContactPoint& p, const ContactPoint& q) {
  return std::min(length_squared(p.anchor_a - q.anchor_a), length_squared(p.anchor_b - q.anchor_b));
}

/// Two edges that are nearly parallel cross at one end in one step and at the other end in the next, and keep
/// their key.
bool is_same_point(const ContactPoint& p, const ContactPoint& q) {
  const bool crossing = (p.key & kNearest) == kCrossing;
  return p.key == q.key && (!crossing || distance_squared(p, q) < kSamePosition * kSamePosition);
}

Matched match_by_key(const Manifold& old, Manifold& manifold) {
  Matched matched;
  for (unsigned i = 0; i < static_cast<unsigned>(manifold.point_count); ++i) {
    for (unsigned k = 0; k < static_cast<unsigned>(old.point_count); ++k) {
      if ((matched.old_points >> k & 1u) != 0 || !is_same_point(manifold.point[i], old.point[k])) continue;
      manifold.point[i].normal_impulse = old.point[k].normal_impulse;
      matched.old_points |= 1u << k;
      matched.new_points |= 1u << i;
      break;
    }
  }
  return matched;
}

/// A clip of aligned faces calls the same point a vertex in one step and a crossing in the next, so the
/// position decides.
void match_by_position(const Manifold& old, Matched matched, Manifold& manifold) {
  for (unsigned round = 0; round < static_cast<unsigned>(manifold.point_count); ++round) {
    Real nearest = kSamePosition * kSamePosition;
    unsigned best_new = Manifold::kMaxPoints;
    unsigned best_old = Manifold::kMaxPoints;
    for (unsigned i = 0; i < static_cast<unsigned>(manifold.point_count); ++i) {
      for (unsigned k = 0; k < static_cast<unsigned>(old.point_count); ++k) {
        if ((matched.new_points >> i & 1u) != 0 || (matched.old_points >> k & 1u) != 0) continue;
        const Real apart = distance_squared(manifold.point[i], old.point[k]);
        if (!(apart < nearest)) continue;
        nearest = apart;
        best_new = i;
        best_old = k;
      }
    }
    if (best_new == Manifold::kMaxPoints) return;
    manifold.point[best_new].normal_impulse = old.point[best_old].normal_impulse;
    matched.new_points |= 1u << best_new;
    matched.old_points |= 1u << best_old;
  }
}

}  // namespace

void make_points(ContactResult& result, Real margin, const ContactFrame& frame, const Manifold* old,
                 Manifold& manifold) {
  std::array<std::uint32_t, Manifold::kMaxPoints> keys = {};
  HOOKE_ASSERT(old != &manifold && (old == nullptr || old->point_count <= Manifold::kMaxPoints));
  const std::size_t key_count = old != nullptr ? static_cast<std::size_t>(old->point_count) : 0;
  for (std::size_t i = 0; i < key_count; ++i) keys[i] = old->point[i].key;
  reduce_points(result, margin, std::span(keys.data(), key_count));
  HOOKE_ASSERT(result.count <= Manifold::kMaxPoints);
  manifold.normal = result.normal;
  manifold.point_count = result.count;
  for (std::size_t i = 0; i < static_cast<std::size_t>(result.count); ++i) {
    const ContactResultPoint& p = result.point[i];
    manifold.point[i] = {.anchor_a = p.on_a - frame.center_a,
                         .anchor_b = p.on_b - frame.center_b,
                         .separation = p.separation,
                         .key = p.key};
  }
  if (old == nullptr || !(dot(old->normal, manifold.normal) > kSameNormal)) return;
  const Matched matched = match_by_key(*old, manifold);
  if (matched.new_points != (1u << manifold.point_count) - 1) match_by_position(*old, matched, manifold);
  const Vec3 n = manifold.normal;
  manifold.friction_impulse = old->friction_impulse - dot(old->friction_impulse, n) * n;
  manifold.twist_impulse = old->twist_impulse;
  manifold.rolling_impulse = old->rolling_impulse;
  manifold.touching = old->touching;
}

}  // namespace hooke::collision
