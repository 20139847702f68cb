#include "collision/deformable/rope_pair.h"

#include "collision/deformable/deformable_tuning.h"
#include "geometry/closest.h"

#include <algorithm>

namespace hooke::collision {

namespace {

Vec3 sum_of(const std::array<Real, 4>& weight, const std::array<Vec3, 4>& of) {
  Vec3 sum;
  for (std::size_t i = 0; i < 4; ++i) sum += weight[i] * of[i];
  return sum;
}

}  // namespace

RopePair::RopePair(const state::Tables& t, Real h, const state::RopeContact& row) {
  const Vec3 origin = t.particles.position[row.particle[0]].x;
  const Vec3 offset = vector_cast<Real>(t.objects[row.object_b].origin - t.objects[row.object_a].origin);
  for (std::size_t i = 0; i < 4; ++i) {
    corner_[i] = t.particles.position[row.particle[i]].x - origin;
    if (i >= 2) corner_[i] += offset;
    displacement_[i] = h * t.particles.velocity[row.particle[i]].v;
  }
}

RopePair::Nearest RopePair::nearest(Real share) const {
  const auto at = [&](std::size_t i) { return corner_[i] + share * displacement_[i]; };
  const auto found = geometry::closest_between_segments<Real>({at(0), at(1)}, {at(2), at(3)});
  const Vec3 apart = found.point_a - found.point_b;
  const Real distance = length(apart);
  return {.share = share,
          .distance = distance,
          .normal = distance > Real(0) ? (Real(1) / distance) * apart : Vec3{},
          .fraction = {found.fraction_a, found.fraction_b}};
}

Real RopePair::longest_displacement() const {
  Real most = Real(0);
  for (const std::size_t a : {0, 1}) {
    for (const std::size_t b : {2, 3})
      most = std::max(most, length_squared(displacement_[a] - displacement_[b]));
  }
  return std::sqrt(most);
}

Real RopePair::closing_distance(Vec3 normal) const {
  Real most = Real(0);
  for (const std::size_t a : {0, 1}) {
    for (const std::size_t b : {2, 3})
      most = std::max(most, -dot(normal, displacement_[a] - displacement_[b]));
  }
  return most;
}

RopePair::Nearest RopePair::advance(Nearest from, Real distance) const {
  Nearest at = from;
  for (int i = 0; i < kMostRopePairRounds && at.share < Real(1); ++i) {
    const Real gap = at.distance - distance;
    const Real most = closing_distance(at.normal);
    if (!(gap > kRopeTouchingShare * distance) || !(most * (Real(1) - at.share) > gap)) break;
    at = nearest(std::min(at.share + gap / most, Real(1)));
  }
  return at;
}

Real RopePair::gap_at_start(const Nearest& at) const {
  return dot(at.normal, sum_of(at.weights(), corner_));
}

Real RopePair::gap_growth(const Nearest& at) const {
  return dot(at.normal, sum_of(at.weights(), displacement_));
}

}  // namespace hooke::collision
