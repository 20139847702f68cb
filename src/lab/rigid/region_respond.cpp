/// Computes what bodies of a Region do to each other: impacts act at once, resting contacts through a step.

#include "lab/rigid/region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hooke::lab {

namespace {

/// Bounces that would last less than this share of an output step count as none (Zeno).
constexpr double kShortFlight = 0.01;
constexpr double kMore = 1.0001;         ///< A little more than the whole.
constexpr double kAtRest = 1e-12;        ///< Share of a speed that is rounding.
constexpr double kOfShortFlight = 1e-6;  ///< Share of the speed of a short flight that is rest.

}  // namespace

std::vector<Contact> Region::contacts_of(BodyPair pair, const BodyMotion& a, const BodyMotion& b) const {
  std::vector<Contact> contacts;
  const double epsilon = setting_.options.epsilon;
  // The search reaches farther than epsilon, so that a contact at the very limit still counts after rounding.
  const ContactQuery query = {ContactSearch(setting_.options), 2 * epsilon, 2 * epsilon, setting_.materials};
  find_contacts(bodies_[pair.a], a, bodies_[pair.b], b, query, contacts);
  return contacts;
}

bool Region::is_resting(BodyPair pair) const {
  return std::any_of(resting_.begin(), resting_.end(),
                     [&](const ImpulsePoint& p) { return p.a == pair.a && p.b == pair.b; });
}

/// Tells whether a contact point is one that rested at the last clear state, within what it may have slid in
/// `h`. Curved paths press resting bodies together, which is no impact. Their speed is then at most what the
/// rotation of the bodies in that time turns their velocities by; what closes faster has met another side.
bool Region::rested(BodyPair pair, const Contact& contact, double closing_speed, double h) const {
  if (!is_resting(pair)) return false;
  const auto speed = [&](std::uint32_t body) {
    const BodyMotion at = now(body);
    return length(at.velocity) + length(cross(at.spin, contact.point - at.center)) +
           length(pulls_[body].linear) * h;
  };
  const double speeds = speed(pair.a) + speed(pair.b);
  const double turned = h * (length(now(pair.a).spin) + length(now(pair.b).spin) +
                             (length(pulls_[pair.a].angular) + length(pulls_[pair.b].angular)) * h);
  if (closing_speed > 2 * turned * speeds + kAtRest * speeds && closing_speed * h > setting_.options.epsilon)
    return false;
  return std::any_of(resting_.begin(), resting_.end(), [&](const ImpulsePoint& p) {
    if (p.a != pair.a || p.b != pair.b) return false;
    return length(contact.point - p.contact.point) <= 2 * h * speeds + 10 * setting_.options.epsilon;
  });
}

std::vector<ImpulseBody> Region::impulse_bodies() const {
  std::vector<ImpulseBody> result;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) result.push_back(impulse_body(bodies_[i], now(i)));
  return result;
}

/// Returns the accelerations by forces, without those of resting contacts.
std::vector<Region::Pull> Region::pulls() {
  std::vector<Pull> result(bodies_.size());
  for (const std::uint32_t body : members_) {
    Part& own = part(body);
    if (own.y.size() == 0) continue;
    own.system.set_load({}, {});
    const auto [linear, angular] = own.system.body_acceleration(time_, own.y);
    result[body] = {linear, angular};
  }
  return result;
}

/// Resolves impacts where bodies close, and stores what then rests. `h` is the time since the last call [s].
/// \return Whether anything touches.
bool Region::respond(double h) {
  std::vector<ImpulseBody> bodies = impulse_bodies();
  std::vector<Pull> pull = pulls();
  std::vector<ImpulsePoint> points;
  std::vector<double> short_flight, no_bounce;  // Speeds [m/s].
  for (const BodyPair pair : pairs_) {
    for (const Contact& contact : contacts_of(pair, now(pair.a), now(pair.b))) {
      points.push_back({.a = pair.a, .b = pair.b, .contact = contact});
      // A bounce returns after 2 v / a, if one body stands and the other is pulled to it by a.
      const double a = std::max(length(pull[pair.a].linear), length(pull[pair.b].linear));
      short_flight.push_back(0.5 * a * kShortFlight * setting_.dt);
      const double speed = -normal_speed(bodies, points.back());
      const double pressed = rested(pair, contact, speed, h) ? kMore * speed : 0;
      no_bounce.push_back(patient_ ? std::max(short_flight.back(), pressed)
                                   : std::numeric_limits<double>::infinity());
    }
  }
  pulls_ = std::move(pull);
  const int hits = resolve_impacts(bodies, points, no_bounce);
  report_.hits += static_cast<std::uint64_t>(hits);
  if (hits > 0) report_.last_hit = time_;
  write_velocities(bodies);
  resting_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double moving = length(bodies[points[i].a].velocity - bodies[points[i].b].velocity);
    const double rounding = kAtRest * moving + kOfShortFlight * short_flight[i];
    if (normal_speed(bodies, points[i]) <= rounding) resting_.push_back(points[i]);
  }
  return hits > 0 || !resting_.empty();
}

void Region::write_velocities(const std::vector<ImpulseBody>& bodies) {
  for (const std::uint32_t body : members_) {
    if (!bodies_[body].is_free) continue;
    Part& own = part(body);
    const BodyMotion before = own.system.body(time_, own.y);
    if (before.velocity == bodies[body].velocity && before.spin == bodies[body].spin) continue;
    own.system.set_velocity(own.y, bodies[body].velocity, bodies[body].spin);
    own.work.reset();
  }
}

/// Resting contacts push through the step as a constant force, which leaves the bodies no closing speed at
/// its end (Moreau's time stepping, here with any method for the step).
void Region::carry(double h) {
  for (const std::uint32_t body : members_) part(body).system.set_load({}, {});
  if (resting_.empty()) return;
  std::vector<ImpulseBody> bodies = impulse_bodies();
  for (const std::uint32_t body : members_) {
    if (bodies_[body].is_free) {
      bodies[body].velocity += h * pulls_[body].linear;
      bodies[body].spin += h * pulls_[body].angular;
    } else {
      const BodyMotion end = part(body).system.body(time_ + h, part(body).y);
      bodies[body].velocity = end.velocity;
    }
  }
  for (ImpulsePoint& point : resting_) point.target = 0;
  solve_impulses(bodies, resting_);
  std::vector<DVec3> force(bodies.size()), torque(bodies.size());
  for (const ImpulsePoint& point : resting_) {
    if (!(point.lambda > 0)) continue;
    const DVec3 push = (1 / h) * (point.lambda * point.contact.normal + point.tangent);
    force[point.a] -= push;
    force[point.b] += push;
    torque[point.a] -= cross(point.contact.point - bodies[point.a].center, push);
    torque[point.b] += cross(point.contact.point - bodies[point.b].center, push);
  }
  for (const std::uint32_t body : members_) {
    if (force[body] == DVec3{} && torque[body] == DVec3{}) continue;
    part(body).system.set_load(force[body], torque[body]);
    part(body).work.reset();
  }
}

}  // namespace hooke::lab
