/// Evaluates a try of a Region: which bodies are near each other, too deep, or touching.

#include "lab/rigid/region.h"

#include <algorithm>
#include <cmath>

namespace hooke::lab {

namespace {

using Sweep = CollisionOptions::Sweep;

Box grown(Box box, double by) {
  const DVec3 around = {by, by, by};
  return {box.lower - around, box.upper + around};
}

}  // namespace

/// Takes the shapes at the start, grown by how far they may rotate, along the path of the center.
Box swept_bounds(const RigidBody& body, const DenseMotion& motion) {
  if (!std::isfinite(body.radius)) return bounds_of(body, motion.at(0));
  const BodyMotion start = motion.at(0);
  const Box shape = bounds_of(body, start);
  const double turn = std::min(2.0, motion.largest_rotation()) * body.radius;
  const Box own = grown({shape.lower - start.center, shape.upper - start.center}, turn);
  Box box;
  for (const DVec3 c : motion.centers()) box = merge(box, Box{c + own.lower, c + own.upper});
  return box;
}

void Region::find_pairs(const Attempt& attempt) {
  pairs_.clear();
  const CollisionOptions& options = setting_.options;
  const auto collide = [&](std::uint32_t a, std::uint32_t b) {
    if (options.preselection == Preselection::kBox) {  // Swept boxes are tighter than a margin.
      return overlap(grown(swept_bounds(bodies_[a], attempt.motions[a]), options.epsilon),
                     swept_bounds(bodies_[b], attempt.motions[b]));
    }
    return may_collide(options.preselection, {setting_.volumes[a], attempt.motions[a], bodies_[a].radius},
                       {setting_.volumes[b], attempt.motions[b], bodies_[b].radius}, options.epsilon);
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (!bodies_[a].is_free && !bodies_[b].is_free) return;
    if (!state::filters_agree(bodies_[a].filter, bodies_[b].filter)) return;
    if (collide(a, b)) pairs_.push_back({std::min(a, b), std::max(a, b)});
  };
  for (std::size_t i = 0; i < members_.size(); ++i) {
    for (std::size_t j = i + 1; j < members_.size(); ++j) add(members_[i], members_[j]);
    for (const std::uint32_t other : others_) add(members_[i], other);
  }
  std::sort(pairs_.begin(), pairs_.end());
  report_.candidates += pairs_.size();
}

void Region::evaluate(Attempt& attempt) {
  for (const BodyPair pair : pairs_) evaluate_end(attempt, pair);
  if (!attempt.deep) evaluate_path(attempt);
}

void Region::evaluate_end(Attempt& attempt, BodyPair pair) {
  const CollisionOptions& options = setting_.options;
  const BodyMotion a = attempt.motions[pair.a].at(1);
  const BodyMotion b = attempt.motions[pair.b].at(1);
  const BodyGap gap =
      gap_between(bodies_[pair.a], a, bodies_[pair.b], b, ContactSearch(options), 2 * options.epsilon);
  if (gap.distance > options.epsilon) return;
  ++report_.touching;
  double closing_speed = 0;
  for (const Contact& contact : contacts_of(pair, a, b)) {
    const DVec3 v = b.velocity + cross(b.spin, contact.point - b.center) - a.velocity -
                    cross(a.spin, contact.point - a.center);
    const double speed = -dot(contact.normal, v);
    if (!rested(pair, contact, speed, attempt.h)) closing_speed = std::max(closing_speed, speed);
  }
  const bool comes = closing_speed > 0;
  if (gap.distance < 0) attempt.overlaps.push_back({pair, gap.distance, gap.normal});
  if (gap.distance >= -options.epsilon) {
    attempt.touches = attempt.touches || comes;
    return;
  }
  // Bodies that overlapped at the start already are moved apart, not tried again.
  if (!comes || dense(attempt, pair).gap(0).distance < -options.epsilon) return;
  if (attempt.deep && -gap.distance <= attempt.depth) return;
  attempt.deep = true;
  attempt.pair = pair;
  attempt.depth = -gap.distance;
  attempt.closing_speed = closing_speed;
}

void Region::evaluate_path(Attempt& attempt) {
  const CollisionOptions& options = setting_.options;
  if (options.sweep == Sweep::kNone || options.collider != CollisionOptions::Collider::kExact) return;
  for (const BodyPair pair : pairs_) {
    if (is_resting(pair)) continue;
    const DensePair both = dense(attempt, pair);
    if (options.sweep == Sweep::kExtruded && !may_collide(both, options.epsilon)) continue;
    const auto share = first_contact(both, options.epsilon);
    if (!share || !(*share < attempt.first_share)) continue;
    attempt.deep = true;
    attempt.pair = pair;
    attempt.depth = 0;
    attempt.first_share = *share;
  }
}

}  // namespace hooke::lab
