#include "lab/rigid/region.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::lab {

namespace {

using Search = CollisionOptions::Search;
using Sweep = CollisionOptions::Sweep;

/// After this many impacts and limits of one region in one output step nothing bounces.
constexpr int kManyEvents = 1000;
constexpr double kDone = 1e-12;  ///< Share of an output step that counts as done.

}  // namespace

Region::Region(const CollisionSetting& setting, const std::vector<RigidBody>& bodies,
               std::vector<std::uint32_t> members, const std::vector<std::uint32_t>& others,
               std::vector<Part>& parts, CollisionReport& report)
    : setting_(setting),
      bodies_(bodies),
      members_(std::move(members)),
      others_(others),
      parts_(parts),
      report_(report),
      swept_(members_.size()) {}

Part& Region::part(std::uint32_t body) {
  return parts_[static_cast<std::size_t>(bodies_[body].part)];
}

/// This is listing 11. It tries what is left of the step. A try that ends too deep is canceled, and a shorter
/// one is made. A try that ends clear or in an impact stays.
Result<void> Region::advance(double t, double dt) {
  time_ = t;
  resting_.clear();
  double left = dt;
  int events = 0;
  double h = dt;
  for (bool first = true; left > kDone * dt; first = false) {
    Attempt attempt = {.h = h};
    carry(h);
    if (const auto moved = step_all(attempt); !moved) return moved.error();
    find_pairs(attempt);
    // What touches at the start is known only now, and exerted no force in this try.
    if (first && respond(0)) {
      reset();
      continue;
    }
    evaluate(attempt);
    if (attempt.deep) {
      cancel(attempt);
      if (++tries_ < setting_.options.iteration_limit) {
        h = shorter_step(attempt);
        continue;
      }
      give_up(attempt);
      ++events;
    } else {
      left -= h;
      if (keep(attempt)) ++events;
    }
    h = known_ > kDone * dt ? std::min(left, longer_step(attempt)) : left;
    if (events == kManyEvents && patient_) {
      ++report_.zeno;
      patient_ = false;  // From now on nothing bounces.
    }
    if (events == 2 * kManyEvents) break;  // The bodies stand still for the rest of the step.
  }
  finish(t + dt);
  return {};
}

void Region::cancel(const Attempt& attempt) {
  reset();
  ++report_.rollbacks;
  report_.resimulated_seconds += attempt.h * static_cast<double>(members_.size());
}

/// Accepts a try as it is, and lets what touches at its end respond. \return Whether something did.
bool Region::keep(const Attempt& attempt) {
  accept(attempt);
  known_ = std::max(0.0, known_ - attempt.h);
  respond(attempt.h);
  if (!attempt.touches) return false;
  known_ = 0;
  tries_ = 0;
  return true;
}

/// Resets what only counts within an output step, which ends at `end` [s].
void Region::finish(double end) {
  time_ = end;
  tries_ = 0;
  known_ = 0;
  patient_ = true;
}

Result<void> Region::step_all(Attempt& attempt) {
  attempt.ends.clear();
  for (const std::uint32_t body : members_) {
    Part& own = part(body);
    State y = own.y;
    if (const auto moved = take_steps(own, time_, attempt.h, y); !moved) return moved.error();
    attempt.ends.push_back(std::move(y));
  }
  attempt.motions.clear();
  std::size_t member = 0;
  for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
    if (member < members_.size() && members_[member] == body) {
      const Part& own = part(body);
      attempt.motions.emplace_back(own.system, time_, attempt.h, own.y, attempt.ends[member++]);
    } else {
      attempt.motions.emplace_back(bodies_[body].still);
    }
  }
  return {};
}

/// Returns the length of the next try after a canceled one [s].
double Region::shorter_step(const Attempt& attempt) {
  const double h = attempt.h;
  const double half = 0.5 * h;
  const Search search = setting_.options.search;
  known_ = h * attempt.first_share;
  depth_known_ = std::max(0.0, attempt.depth);
  pair_known_ = attempt.pair;
  if (search == Search::kHalving) return half;
  double step = 0;
  if (attempt.first_share < 1) {
    step = known_;  // The path reached a contact there.
  } else if (search == Search::kBackward) {
    if (tries_ == 1) report_.backward_error = std::max(report_.backward_error, backward_error(attempt));
    step = h - attempt.depth / attempt.closing_speed;
  } else if (tries_ % 3 == 0) {
    step = half;
  } else if (tries_ == 1 || search == Search::kAdvancement) {
    const double epsilon = setting_.options.epsilon;
    const DensePair pair = dense(attempt, attempt.pair);
    const auto share =
        search == Search::kEvent ? contact_root(pair, epsilon) : first_contact(pair, epsilon / 2);
    step = h * share.value_or(0.5);
  } else {
    const double gap = dense(attempt, attempt.pair).gap(0).distance;
    step = gap > 0 ? h * gap / (gap + attempt.depth) : half;
  }
  return step > 0.001 * h && step < 0.999999 * h ? step : half;
}

/// Returns the length of the next try after a clear one, shorter than the time to a known collision [s].
double Region::longer_step(const Attempt& attempt) {
  if (setting_.options.search == Search::kHalving) return setting_.dt;
  ++tries_;
  const double gap =
      gap_between(bodies_[pair_known_.a], now(pair_known_.a), bodies_[pair_known_.b], now(pair_known_.b),
                  ContactSearch(setting_.options), setting_.options.epsilon + attempt.h)
          .distance;
  if (!(gap > 0) || tries_ % 3 == 0) return 0.5 * known_;
  if (!(depth_known_ > 0)) return known_;
  return known_ * std::max(0.01, gap / (gap + depth_known_));
}

/// Measures the paper's backward step (4.5.1), which goes back from the overlap by its depth over its speed.
/// Returns how far from the method's own motion at that time it leaves the bodies [m]. Only methods that are
/// symmetric in time get there exactly.
double Region::backward_error(const Attempt& attempt) {
  const double back = attempt.depth / attempt.closing_speed;
  if (!(back > 0 && back < attempt.h)) return 0;
  double error = 0;
  for (const std::uint32_t body : {attempt.pair.a, attempt.pair.b}) {
    const auto member = std::find(members_.begin(), members_.end(), body);
    if (member == members_.end()) continue;
    Part& own = part(body);
    State before = own.y;
    State after = attempt.ends[static_cast<std::size_t>(member - members_.begin())];
    const double t = time_ + attempt.h - back;
    if (!take_steps(own, time_ + attempt.h, -back, after)) continue;
    if (!take_steps(own, time_, attempt.h - back, before)) continue;
    error = std::max(error, length(own.system.body(t, after).center - own.system.body(t, before).center));
  }
  return error;
}

/// The history that methods keep describes another motion.
void Region::reset() {
  for (const std::uint32_t body : members_) part(body).work.reset();
}

void Region::accept(const Attempt& attempt) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Part& own = part(members_[i]);
    own.y = attempt.ends[i];
    ++own.steps;
    if (own.y.size() > 0 && own.system.lay_chart(own.y)) own.work.reset();
    swept_[i] = merge(swept_[i], swept_bounds(bodies_[members_[i]], attempt.motions[members_[i]]));
  }
  time_ += attempt.h;
  for (const Overlap& overlap : attempt.overlaps) {
    report_.deepest = std::max(report_.deepest, -overlap.distance);
    project(overlap.pair, overlap.distance, overlap.normal);
  }
}

/// At the limit of tries the bodies are clear. They are moved together, and their impact is resolved there.
void Region::give_up(const Attempt& attempt) {
  ++report_.limit_reached;
  tries_ = 0;
  known_ = 0;
  const auto [a, b] = attempt.pair;
  const BodyGap gap =
      gap_between(bodies_[a], now(a), bodies_[b], now(b), ContactSearch(setting_.options),
                  setting_.options.epsilon + dense(attempt, attempt.pair).closing({}) * attempt.h);
  project(attempt.pair, gap.distance, gap.normal);
  respond(0);
}

/// Moves two bodies along n until they touch, shared by their inverse masses. A body with an axle rotates
/// instead.
void Region::project(BodyPair pair, double distance, DVec3 normal) {
  if (bodies_[pair.a].axle || bodies_[pair.b].axle) {
    project_by_rotating(pair);
    return;
  }
  const auto inverse = [&](std::uint32_t body) {
    return bodies_[body].is_free ? 1 / bodies_[body].mass : 0.0;
  };
  const double of_a = inverse(pair.a);
  const double sum = of_a + inverse(pair.b);
  if (!(sum > 0)) return;
  if (of_a > 0) part(pair.a).system.move_center(part(pair.a).y, (distance * of_a / sum) * normal);
  if (sum > of_a) part(pair.b).system.move_center(part(pair.b).y, (-distance * (sum - of_a) / sum) * normal);
}

/// Does the same at the deepest point. A body moves as an impulse there would change its velocity, but only a
/// body with an axle rotates.
void Region::project_by_rotating(BodyPair pair) {
  const std::vector<Contact> contacts = contacts_of(pair, now(pair.a), now(pair.b));
  const auto deepest =
      std::min_element(contacts.begin(), contacts.end(),
                       [](const Contact& x, const Contact& y) { return x.distance < y.distance; });
  if (deepest == contacts.end()) return;
  /// This is the response to a push of 1 along n: the rotation about the axle, and the displacement along n.
  struct Answer {
    double rotation = 0, displacement = 0;
  };
  const auto answer = [&](std::uint32_t body) -> Answer {
    const RigidBody& own = bodies_[body];
    if (!own.is_free) return {};
    if (!own.axle) return {0, 1 / own.mass};
    const double lever = dot(own.axle->axis, cross(deepest->point - now(body).center, deepest->normal));
    return {lever / own.axle->inertia, lever * lever / own.axle->inertia};
  };
  const Answer of_a = answer(pair.a), of_b = answer(pair.b);
  if (!(of_a.displacement + of_b.displacement > 0)) return;
  const double push = deepest->distance / (of_a.displacement + of_b.displacement);
  const auto move = [&](std::uint32_t body, const Answer& own, double size) {
    if (!(own.displacement > 0)) return;
    const System& system = part(body).system;
    if (bodies_[body].axle) {
      system.rotate_by(part(body).y, (size * own.rotation) * bodies_[body].axle->axis);
    } else {
      system.move_center(part(body).y, (size * own.displacement) * deepest->normal);
    }
  };
  move(pair.a, of_a, push);
  move(pair.b, of_b, -push);
}

BodyMotion Region::now(std::uint32_t body) const {
  const int index = bodies_[body].part;
  if (index < 0) return bodies_[body].still;
  const Part& own = parts_[static_cast<std::size_t>(index)];
  return own.system.body(time_, own.y);
}

DensePair Region::dense(const Attempt& attempt, BodyPair pair) const {
  return {bodies_[pair.a], attempt.motions[pair.a], bodies_[pair.b], attempt.motions[pair.b],
          ContactSearch(setting_.options)};
}

}  // namespace hooke::lab
