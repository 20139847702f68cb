#include "collision/deformable/rope_contact_places.h"

#include "base/assert.h"
#include "collision/deformable/contact_frames.h"
#include "collision/deformable/deformable_tuning.h"
#include "collision/deformable/rope_pair.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

using state::RopeContact;

void leave(RopeContact& row) {
  row.separation = kNoContact;
  row.successor = RopeContact::kNone;
}

/// The search for the contact points of one row.
class RopeRowUpdate {
 public:
  RopeRowUpdate(const state::Tables& tables, Real h, RopeContact& row)
      : t_(tables),
        row_(row),
        h_(h),
        pair_(tables, h, row),
        longest_displacement_(pair_.longest_displacement()) {}

  void run() {
    if (row_.adjacent || stay_apart()) return leave(row_);
    const Vec3 before = row_.normal;
    at_ = pair_.nearest(Real(0));
    row_.clearance = at_.distance - row_.thickness;
    if (row_.clearance > pair_.closing_distance(at_.normal) + kRopeAsideShare * longest_displacement_ +
                             kRopeAheadShare * row_.thickness)
      return leave(row_);
    if (at_.normal == Vec3{}) at_.normal = before == Vec3{} ? Vec3{Real(0), Real(1), Real(0)} : before;
    at_ = pair_.advance(at_, row_.thickness);
    row_.normal = at_.normal;
    row_.separation = pair_.gap_at_start(at_) - row_.thickness;
    row_.weight = at_.weights();
    row_.successor = nearer_neighbor();
    if (row_.successor != RopeContact::kNone) {
      row_.normal = before;
      row_.separation = kNoContact;
      return;
    }
    row_.joined = true;
    if (dot(row_.normal, before) < kRopeSameSide) {
      row_.normal_force = Real(0);
      row_.friction_force = {};
    }
  }

 private:
  /// Whether the two cannot have met since their distance was found, and will not within h.
  bool stay_apart() {
    if (!(row_.clearance > Real(0))) return false;
    const Real displacement = Real(2) * longest_displacement_ + kRopeApartSpeed * h_;
    row_.clearance -= displacement;
    return row_.clearance > displacement + kRopeAheadShare * row_.thickness;
  }

  /// Change of the distance for a step along the next segment, or back along the one before, over the length
  /// of that segment. Side 0 is that of a, 1 that of b.
  [[nodiscard]] Real slope(std::size_t side, bool onward) const {
    const std::uint32_t end = row_.particle[2 * side + (onward ? 1 : 0)];
    const std::uint32_t next = onward ? end + 1 : end - 1;
    HOOKE_ASSERT(next - t_.objects[side == 0 ? row_.object_a : row_.object_b].particles.first <
                 t_.objects[side == 0 ? row_.object_a : row_.object_b].particles.count);
    const Vec3 moved = h_ * (t_.particles.velocity[next].v - t_.particles.velocity[end].v);
    const Vec3 along = t_.particles.position[next].x - t_.particles.position[end].x + at_.share * moved;
    const Real size = length(along);
    const Real rise = (side == 0 ? Real(1) : Real(-1)) * dot(along, row_.normal);
    return size > Real(0) ? rise / size : Real(0);
  }

  /// If a segment is nearest at its end, the next one may be nearer still. Then a row acts only on what is a
  /// little thinner: ropes that lie side by side touch all along. At a joint that is nearest itself only the
  /// first of the two acts, unless it is not clear which.
  [[nodiscard]] std::uint32_t nearer_neighbor() {
    std::uint32_t nearer = RopeContact::kNone;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t behind = row_.neighbor[2 * side + 1];
      const std::uint32_t ahead = row_.neighbor[2 * side];
      if (at_.fraction[side] >= Real(1) - kSegmentEndShare && behind != RopeContact::kNone) {
        if (slope(side, true) < -kClearlyNearer) nearer = behind;
      } else if (at_.fraction[side] <= kSegmentEndShare && ahead != RopeContact::kNone) {
        const Real rise = slope(side, false);
        if (rise > kClearlyNearer) return ahead;
        if (rise < -kClearlyNearer) nearer = ahead;
      }
    }
    if (nearer == RopeContact::kNone) return nearer;
    const Real thinner = row_.separation + kRopeSkinShare * row_.thickness;
    if (std::min(thinner, thinner + pair_.gap_growth(at_)) > Real(0)) return nearer;
    row_.separation = thinner;
    return RopeContact::kNone;
  }

  const state::Tables& t_;
  RopeContact& row_;
  Real h_;
  RopePair pair_;
  Real longest_displacement_;
  RopePair::Nearest at_;
};

}  // namespace

void update_rope_row(const state::Tables& tables, Real h, RopeContact& row) {
  RopeRowUpdate(tables, h, row).run();
}

}  // namespace hooke::collision
