/// Tests bodies that stand on each other, and dominoes that fall one after the other.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::check {

namespace {

/// Cubes of 1 m stand on the ground, one on the other; the last is `ratio` times as heavy as the others.
struct Stack {
  Rig rig;
  BodyId ground;
  std::vector<BodyId> cubes;

  Stack(const CheckSetting& setting, int count, double ratio = 1) : rig(setting, sleepless()) {
    ground = rig.add(level_ground(0.6));
    for (int i = 0; i < count; ++i) {
      BodyDesc cube = moving(box_of({0.5, 0.5, 0.5}), {0, 0.5 + i, 0});
      cube.contact.friction = real(0.6);
      if (i == count - 1) cube.density *= real(ratio);
      cubes.push_back(rig.add(cube));
    }
  }

  /// Returns the largest |distance between neighbors / edge - 1|, the ground included.
  [[nodiscard]] double gap_error() const {
    double worst = 0;
    double below = -0.5;
    for (const BodyId cube : cubes) {
      const double y = rig.center(cube).y;
      worst = std::max(worst, std::abs(y - below - 1));
      below = y;
    }
    return worst;
  }
  [[nodiscard]] double drift() const {
    double worst = 0;
    for (const BodyId cube : cubes)
      worst = std::max(worst, std::hypot(rig.center(cube).x, rig.center(cube).z));
    return worst;
  }
  /// Stops when the top is a whole cube lower, because the stack has then fallen.
  void watch(int seconds) {
    const double top = rig.center(cubes.back()).y;
    for (int i = 0; i < seconds && rig.center(cubes.back()).y > top - 1; ++i) rig.run(1);
  }
};

/// Returns rows for the largest gap and drift of a stack in 60 s.
Rows stack_rows(const CheckSetting& setting, const std::string& title, int count, double ratio) {
  Stack stack(setting, count, ratio);
  stack.watch(60);
  return {
      absolute_row(title + ": gap after 60 s, share of a box", "", 0, stack.gap_error(), 0.01),
      known_miss_turned(setting, absolute_row(title + ": sideways in 60 s", "mm", 0, 1000 * stack.drift(), 1),
                        "boxes whose faces are rounded lean as those do")};
}

void append(Rows& rows, const Rows& more) {
  rows.insert(rows.end(), more.begin(), more.end());
}

/// Cards of 10 cm x 7 cm x 4 mm stand in pairs that lean 20 degrees, 10.2 cm apart. Flat cards between the
/// storeys reach over the upper edges of two pairs, and leave 2 mm to the next.
struct CardHouse {
  static constexpr double kHalf = 0.05;  ///< Half of a card's length [m].
  Rig rig;
  std::vector<BodyId> cards;
  std::vector<DVec3> start;

  CardHouse(const CheckSetting& setting, int storeys) : rig(setting, sleepless()) {
    const double lean = 20 * kTau / 360;
    const double thick = 0.002;
    const double high = 2 * (kHalf * std::cos(lean) + thick * std::sin(lean));
    const double apart = 2 * kHalf + 0.002;
    const double aside = kHalf * std::sin(lean) + thick * std::cos(lean);
    rig.add(level_ground(0.6));
    for (int row = 0; row < storeys; ++row) {
      const double floor = row * (high + 2 * thick);
      for (int k = 0; k < storeys - row; ++k) {
        const double x = (k - 0.5 * (storeys - row - 1)) * apart;
        add({thick, kHalf, 0.035}, {x - aside, floor + 0.5 * high, 0}, -lean);
        add({thick, kHalf, 0.035}, {x + aside, floor + 0.5 * high, 0}, lean);
        if (k > 0) add({kHalf, thick, 0.035}, {x - 0.5 * apart, floor + high + thick, 0}, 0);
      }
    }
  }

  /// Returns the largest displacement of a card, as a share of its length.
  [[nodiscard]] double moved() const {
    double worst = 0;
    for (std::size_t i = 0; i < cards.size(); ++i)
      worst = std::max(worst, length(rig.center(cards[i]) - start[i]) / (2 * kHalf));
    return worst;
  }

 private:
  void add(DVec3 half, DVec3 position, double angle) {
    BodyDesc card = moving(box_of(half), position);
    card.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, real(angle));
    card.density = real(700);
    card.contact.friction = real(0.6);
    cards.push_back(rig.add(card));
    start.push_back(position);
  }
};

/// Returns the sideways displacement of the worst box of a pyramid of 30 rows in 60 s [mm].
double pyramid_drift(const CheckSetting& setting) {
  Rig rig(setting, sleepless());
  rig.add(level_ground(0.6));
  std::vector<BodyId> boxes;
  std::vector<DVec3> start;
  for (int row = 0; row < 30; ++row) {
    for (int k = 0; k < 30 - row; ++k) {
      start.push_back({1.05 * (k - 0.5 * (29 - row)), 0.5 + row, 0});
      BodyDesc box = moving(box_of({0.5, 0.5, 0.5}), start.back());
      box.contact.friction = real(0.6);
      boxes.push_back(rig.add(box));
    }
  }
  rig.run(60);
  double worst = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const DVec3 way = rig.center(boxes[i]) - start[i];
    worst = std::max(worst, std::hypot(way.x, way.z));
  }
  return 1000 * worst;
}

/// Returns the speed of the wave through dominoes of height `size`, over sqrt(g size). It is measured between
/// the tenth and the seventieth of 80, each at the time when it has tilted by 15 degrees.
double domino_wave(const CheckSetting& setting, double size, double gravity) {
  WorldDesc desc = sleepless();
  desc.gravity = real(DVec3{0, -gravity, 0});
  Rig rig(setting, desc);
  rig.add(level_ground(0.6));
  const double spacing = 0.5 * size;
  std::vector<BodyId> stones;
  for (int i = 0; i < 80; ++i) {
    BodyDesc stone = moving(box_of({0.08 * size, 0.5 * size, 0.25 * size}), {spacing * i, 0.5 * size, 0});
    stone.contact.friction = real(0.3);
    // The first starts with 1.5 times the spin that brings it over its edge.
    if (i == 0) stone.angular_velocity = real(DVec3{0, 0, -1.5 * std::sqrt(gravity / size)});
    if (i == 0) stone.velocity = real(DVec3{0.75 * std::sqrt(gravity * size), 0, 0});
    stones.push_back(rig.add(stone));
  }
  const double unit = std::sqrt(size / gravity);
  const auto tilt_of = [&](BodyId id) { return rig.direction(id, {0, 1, 0}).x - std::sin(kTau / 24); };
  Curve first;
  Curve last;
  rig.run(70 * unit, [&] {
    first.add(rig.time(), tilt_of(stones[10]));
    last.add(rig.time(), tilt_of(stones[70]));
  });
  const std::vector<double> begin = first.zero_crossings();
  const std::vector<double> end = last.zero_crossings();
  if (begin.empty() || end.empty()) return std::numeric_limits<double>::quiet_NaN();
  return 60 * spacing / (end.front() - begin.front()) / std::sqrt(gravity * size);
}

}  // namespace

/// The ground carries the weight of all (statics).
Rows stack_force(const CheckSetting& setting) {
  Stack stack(setting, 10);
  stack.rig.run(10);
  double force = 0;
  for (const BodyContact& contact : stack.rig.world().body_contacts()) {
    if (contact.a != stack.ground && contact.b != stack.ground) continue;
    force += static_cast<double>(contact.normal_force) * std::abs(static_cast<double>(contact.normal.y));
  }
  return {
      relative_row("force of the ground on ten boxes of 1000 kg", "N", 10 * 1000 * kGravity, force, 0.001)};
}

/// A stack that stands at first remains standing. The cases are qu3e's issue 54, and Greenhill's limit of
/// soft columns.
Rows tall_stacks(const CheckSetting& setting) {
  Rows rows = stack_rows(setting, "stack of 10", 10, 1);
  append(rows, stack_rows(setting, "stack of 50", 50, 1));
  append(rows, stack_rows(setting, "stack of 100", 100, 1));
  rows.push_back(absolute_row("pyramid of 30 rows: sideways in 60 s", "mm", 0, pyramid_drift(setting), 20));
  return rows;
}

/// The last of ten boxes is the heavier one (statics): nothing may move.
Rows heavy_tops(const CheckSetting& setting) {
  Rows rows;
  for (const int ratio : {10, 100, 1000, 10000}) {
    append(rows, stack_rows(setting, "9 boxes under one of " + std::to_string(ratio) + " : 1", 10, ratio));
  }
  return rows;
}

/// A pair of cards stands for mu >= tan(lean) / 2, under a load for mu >= tan(lean) at most (statics): 0.36,
/// with mu = 0.6.
Rows card_house(const CheckSetting& setting) {
  Rows rows;
  for (const int storeys : {1, 3, 4}) {
    CardHouse house(setting, storeys);
    for (int second = 0; second < 60 && house.moved() < 1; ++second) house.rig.run(1);
    rows.push_back(absolute_row("house of cards, storeys: " + std::to_string(storeys) +
                                    ": farthest way of a card in 60 s, share of it",
                                "", 0, house.moved(), 0.05));
  }
  return rows;
}

/// v / sqrt(g H) does not depend on size or gravity (dimensional analysis; McLachlan and others 1983). The
/// step is 1/240 s times sqrt(H / g) relative to the smallest, so that every scale computes the same.
Rows domino_scaling(const CheckSetting& setting) {
  CheckSetting own = setting;
  const auto speed = [&](double size, double gravity) {
    own.dt = std::sqrt(size / gravity * kGravity / 0.1) / 240;
    return domino_wave(own, size, gravity);
  };
  const double expected = speed(0.1, kGravity);
  Rows rows = {relative_row("speed of dominoes 40 cm high over sqrt(g H), as of 10 cm", "", expected,
                            speed(0.4, kGravity)),
               relative_row("the same in a quarter of the gravity", "", expected, speed(0.1, kGravity / 4))};
  for (CheckRow& row : rows) row.dt = 1.0 / 120;
  return rows;
}

}  // namespace hooke::check
