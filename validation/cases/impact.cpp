/// Tests bodies that collide with each other or the ground.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>

namespace hooke::check {

namespace {

constexpr double kBall = 0.1;  ///< Radius [m].

WorldDesc floating_balls() {
  WorldDesc desc = sleepless();
  desc.gravity = {};
  return desc;
}

BodyDesc bouncing(const Shape& shape, DVec3 position, double restitution) {
  BodyDesc desc = moving(shape, position);
  desc.contact = {.friction = real(0), .restitution = real(restitution)};
  return desc;
}

/// These are heights above the ground of a body that is released at `height` and bounces: tops between the
/// impacts, and the highest of all samples after the first impact.
struct Bounces {
  std::vector<double> tops;
  double highest = 0;
  double stop = 0;  ///< Last time with more than 1 cm/s [s].
};

Bounces bounce(Rig& rig, BodyId id, double ground, double seconds) {
  Bounces seen;
  bool hit = false;
  const Curve height = record(rig, seconds, [&] {
    const double now = rig.center(id).y - ground;
    hit = hit || rig.velocity(id).y > 0;
    if (hit) seen.highest = std::max(seen.highest, now);
    if (std::abs(rig.velocity(id).y) > 0.01) seen.stop = rig.time();
    return now;
  });
  seen.tops = height.peaks();
  return seen;
}

Bounces bounce_ball(const CheckSetting& setting, double height, double restitution, double seconds) {
  Rig rig(setting, sleepless());
  rig.add(level_ground(0));
  const BodyId ball = rig.add(bouncing(Shape::sphere(real(kBall)), {0, kBall + height, 0}, restitution));
  return bounce(rig, ball, kBall, seconds);
}

/// Returns zero for a bounce that did not come.
double at(const std::vector<double>& tops, std::size_t i) {
  return i < tops.size() ? tops[i] : 0;
}

/// Two balls move on one line.
struct HeadOn {
  double first = 0;  ///< Speeds after the impact [m/s].
  double second = 0;
};

HeadOn head_on(const CheckSetting& setting, double restitution) {
  Rig rig(setting, floating_balls());
  BodyDesc desc = bouncing(Shape::sphere(real(kBall)), {-0.5, 0, 0}, restitution);
  desc.mass = real(1);
  desc.velocity = real(DVec3{2, 0, 0});
  const BodyId first = rig.add(desc);
  desc.position = {0.5, 0, 0};
  desc.mass = real(3);
  desc.velocity = real(DVec3{-1, 0, 0});
  const BodyId second = rig.add(desc);
  rig.run(1);
  return {rig.velocity(first).x, rig.velocity(second).x};
}

/// Five balls touch, each on two strings of 1 m from points +-0.5 m aside, so that they swing in a plane. The
/// first `count` come from the side.
struct Cradle {
  static constexpr int kBalls = 5;
  Rig rig;
  std::vector<BodyId> ball;

  Cradle(const CheckSetting& setting, int count) : rig(setting, sleepless()) {
    const double angle = 0.2;
    for (int i = 0; i < kBalls; ++i) {
      const DVec3 pivot = {2 * kBall * i, 1, 0};
      const DVec3 arm = i < count ? DVec3{-std::sin(angle), -std::cos(angle), 0} : DVec3{0, -1, 0};
      ball.push_back(rig.add(bouncing(Shape::sphere(real(kBall)), pivot + arm, 1)));
      must(rig.world().add_hook({.kind = HookKind::kHinge,
                                 .b = {ball.back()},
                                 .anchor = pivot,
                                 .axis = {Real(0), Real(0), Real(1)}}));
    }
  }

  /// Returns the speed of ball i over the largest that the fall gives.
  [[nodiscard]] double speed(int i) const {
    const double fastest = std::sqrt(2 * kGravity * (1 - std::cos(0.2)));
    return length(rig.velocity(ball[static_cast<std::size_t>(i)])) / fastest;
  }
};

/// Returns the largest speed of a ball that should rest. It is measured a quarter period after each of ten
/// impacts, when as many balls as came are near their tops at one end.
double cradle_unrest(const CheckSetting& setting, int count) {
  Cradle cradle(setting, count);
  const double inertia = 1 + 0.4 * kBall * kBall;  // Moment of a ball about its pivot, over m L^2.
  const double quarter = 0.25 * kTau * std::sqrt(inertia / kGravity);
  double unrest = 0;
  cradle.rig.run(2 * quarter);
  for (int hit = 1; hit <= 10; ++hit) {
    const int first = hit % 2 == 1 ? 0 : count;
    for (int i = 0; i < Cradle::kBalls - count; ++i) unrest = std::max(unrest, cradle.speed(first + i));
    cradle.rig.run(2 * quarter);
  }
  return unrest;
}

/// Returns the largest error of speeds after `count` of five balls have come with 1 m/s; `gap` is between
/// neighbors [m].
double row_of_balls(const CheckSetting& setting, int count, double gap) {
  Rig rig(setting, floating_balls());
  std::vector<BodyId> ball;
  for (int i = 0; i < Cradle::kBalls; ++i) {
    const double way = i < count ? 0.3 : 0.0;
    BodyDesc desc = bouncing(Shape::sphere(real(kBall)), {(2 * kBall + gap) * i - way, 0, 0}, 1);
    if (i < count) desc.velocity = real(DVec3{1, 0, 0});
    ball.push_back(rig.add(desc));
  }
  rig.run(2);
  double error = 0;
  for (int i = 0; i < Cradle::kBalls; ++i) {
    const double expected = i >= Cradle::kBalls - count ? 1 : 0;
    error = std::max(error, std::abs(rig.velocity(ball[static_cast<std::size_t>(i)]).x - expected));
  }
  return error;
}

}  // namespace

/// h_n = e^(2n) h_0; with e < 1 the ball is at rest after sqrt(2 h_0 / g) (1 + e) / (1 - e) (textbook).
Rows bouncing_ball(const CheckSetting& setting) {
  const Bounces half = bounce_ball(setting, 5, 0.5, 6);
  const Bounces most = bounce_ball(setting, 5, 0.8, 12);
  const Bounces full = bounce_ball(setting, 1, 1, 70 * 2 * std::sqrt(2 / kGravity));
  Rows rows;
  for (std::size_t n = 1; n <= 3; ++n) {
    rows.push_back(relative_row("top after bounce " + std::to_string(n) + ", 5 m, e = 0.5", "m",
                                5 * std::pow(0.25, static_cast<double>(n)), at(half.tops, n - 1),
                                0.005 * static_cast<double>(n)));
  }
  rows.push_back(relative_row("at rest, e = 0.8", "s", std::sqrt(10 / kGravity) * 9, most.stop));
  rows.push_back(relative_row("last top of 70 bounces, 1 m, e = 1", "m", 1,
                              full.tops.size() < 60 ? 0.0 : full.tops.back(), 0.001));
  // The ball must never rise above the start; 0.01 % of the height is allowed.
  rows.push_back(
      absolute_row("rise above the start in 70 bounces", "m", 0, std::max(0.0, full.highest - 1), 1e-4));
  return rows;
}

/// A box with e = 1 returns to its height, also from a smaller box, where contacts are not at its corners.
Rows bouncing_box(const CheckSetting& setting) {
  Rows rows;
  for (const double half : {0.6, 0.25}) {
    Rig rig(setting, sleepless());
    rig.add({.shape = box_of({half, 0.25, half}), .contact = {.friction = real(0)}});
    const BodyId box = rig.add(bouncing(box_of({0.5, 0.5, 0.5}), {0, 1.25, 0}, 1));
    const Bounces seen = bounce(rig, box, 0.75, 6.3);
    const std::string on = half < 0.5 ? " on a smaller box" : " on a larger box";
    rows.push_back(relative_row("top after bounce 1" + on, "m", 0.5, at(seen.tops, 0)));
    rows.push_back(relative_row("top after bounce 9" + on, "m", 0.5, at(seen.tops, 8)));
    rows.push_back(absolute_row("spin after 9 bounces" + on, "rad/s", 0, length(rig.spin(box)), 0.01));
  }
  return rows;
}

/// v1' = ((m1 - e m2) v1 + (1 + e) m2 v2) / (m1 + m2) and the same for the other (textbook); 1 kg with 2 m/s
/// against 3 kg with -1 m/s.
Rows two_body_impact(const CheckSetting& setting) {
  Rows rows;
  for (const double e : {0.0, 0.5, 1.0}) {
    const HeadOn after = head_on(setting, e);
    const std::string title = "speed after a hit, e = " + std::to_string(e).substr(0, 3);
    rows.push_back(
        absolute_row(title + ", 1 kg", "m/s", ((1 - 3 * e) * 2 - (1 + e) * 3) / 4, after.first, 1e-5));
    rows.push_back(absolute_row(title + ", 3 kg", "m/s", (e - 3 + (1 + e) * 2) / 4, after.second, 1e-5));
  }
  return rows;
}

/// Two equal balls with e = 1 and no friction separate at right angles after an oblique impact. The one that
/// was at rest leaves along the line of centers at contact, sin(angle) = offset / (2 r) (textbook).
Rows oblique_impact(const CheckSetting& setting) {
  Rows rows;
  for (const double offset : {0.5, 1.0, 1.5}) {
    Rig rig(setting, floating_balls());
    const Shape ball = Shape::sphere(real(kBall));
    BodyDesc desc = bouncing(ball, {-1.03, offset * kBall, 0}, 1);
    desc.velocity = real(DVec3{2, 0, 0});
    const BodyId coming = rig.add(desc);
    const BodyId struck = rig.add(bouncing(ball, {}, 1));
    rig.run(1);
    const DVec3 a = rig.velocity(coming);
    const DVec3 b = rig.velocity(struck);
    const double degree = 360 / kTau;
    const std::string title = ", offset " + std::to_string(offset).substr(0, 3) + " r";
    rows.push_back(absolute_row("angle between two balls after a hit" + title, "deg", 90,
                                degree * std::acos(dot(normalize(a), normalize(b))), 0.1));
    rows.push_back(absolute_row("direction of the struck ball" + title, "deg",
                                -degree * std::asin(offset / 2), degree * std::atan2(b.y, b.x), 0.1));
  }
  return rows;
}

/// If k balls come in, k balls leave and the others rest: momentum and energy allow nothing else when impacts
/// happen one by one.
Rows newtons_cradle(const CheckSetting& setting) {
  Rows rows;
  for (const int count : {1, 2, 3}) {
    const std::string title = std::to_string(count) + " of 5 balls hit the rest: error of speeds";
    rows.push_back(absolute_row(title + ", 5 cm apart", "m/s", 0, row_of_balls(setting, count, 0.05), 0.01));
    rows.push_back(absolute_row(title + ", 2 mm apart", "m/s", 0, row_of_balls(setting, count, 0.002), 0.01));
  }
  for (const int count : {1, 2}) {
    rows.push_back(absolute_row("cradle of touching balls, " + std::to_string(count) +
                                    " in: speed of the others after each of 10 hits, share",
                                "", 0, cradle_unrest(setting, count), 0.01));
  }
  return rows;
}

}  // namespace hooke::check
