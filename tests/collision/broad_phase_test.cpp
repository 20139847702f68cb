#include "collision/broad_phase/broad_phase.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <map>
#include <random>

using hooke::DVec3;
using hooke::Real;
using hooke::Vec3;
using hooke::collision::BroadPhase;
using hooke::collision::ColliderPair;
using hooke::geometry::Box;
using hooke::geometry::RaySlabs;
using hooke::parallel::ThreadPool;

namespace {

constexpr Real kFar = Box::kFar;

Real signed_unit(std::mt19937& random) {
  return static_cast<Real>(static_cast<double>(random()) / 2147483648.0 - 1.0);
}
Vec3 random_vector(std::mt19937& random) {
  const Real x = signed_unit(random);
  const Real y = signed_unit(random);
  return {x, y, signed_unit(random)};
}
Box box_at(Vec3 center, Vec3 half) {
  return {center - half, center + half};
}
/// Of many sizes, some of them points, some the same.
Box random_box(std::mt19937& random, Real spread) {
  const auto kind = random() % 16;
  if (kind == 0) return box_at({}, {Real(1), Real(1), Real(1)});
  const Vec3 center = spread * random_vector(random);
  if (kind == 1) return {center, center};
  const Vec3 side = random_vector(random);
  const Real scale = kind == 2 ? Real(0.3) * spread : Real(1);
  return box_at(center, scale * Vec3{std::fabs(side.x), std::fabs(side.y), std::fabs(side.z)});
}

/// What a broad phase should hold, and its answers by looking at everything.
struct Model {
  struct Item {
    Box box = {};
    bool moves = false;
  };
  std::map<std::uint32_t, Item> items;
  std::uint32_t companies = 0;

  [[nodiscard]] std::int32_t company_of(std::uint32_t collider) const {
    return -static_cast<std::int32_t>(collider / 3 % (companies + 1));
  }
  [[nodiscard]] bool are_friends(std::uint32_t a, std::uint32_t b) const {
    return company_of(a) != 0 && company_of(a) == company_of(b);
  }

  [[nodiscard]] std::vector<ColliderPair> pairs() const {
    std::vector<ColliderPair> found;
    for (auto a = items.begin(); a != items.end(); ++a) {
      for (auto b = std::next(a); b != items.end(); ++b) {
        const bool one_moves = a->second.moves || b->second.moves;
        if (one_moves && !are_friends(a->first, b->first) && overlap(a->second.box, b->second.box))
          found.push_back({a->first, b->first});
      }
    }
    return found;
  }
  template <class Holds>
  [[nodiscard]] std::vector<std::uint32_t> all_that(const Holds& holds) const {
    std::vector<std::uint32_t> found;
    for (const auto& [collider, item] : items) {
      if (holds(item.box)) found.push_back(collider);
    }
    return found;
  }
};

/// A broad phase and what it should hold.
struct Twin {
  BroadPhase broad_phase;
  Model model;

  void set(std::uint32_t collider, const Box& box, bool moves) {
    broad_phase.set(collider, box, moves, model.company_of(collider));
    model.items[collider] = {box, moves};
  }
  void remove(std::uint32_t collider) {
    broad_phase.remove(collider);
    model.items.erase(collider);
  }
  void check_pairs(ThreadPool& pool) {
    std::vector<ColliderPair> pairs = {{7, 9}};
    broad_phase.find_pairs(pool, pairs);
    CHECK(pairs == model.pairs());
  }
  void check_queries(std::mt19937& random, Real spread) const {
    std::vector<std::uint32_t> found = {7};
    const Box box = random_box(random, spread);
    broad_phase.query(box, found);
    CHECK(found == model.all_that([&](const Box& other) { return overlap(other, box); }));
    const std::uint32_t collider = model.items.begin()->first;
    std::erase_if(found, [&](std::uint32_t other) { return model.are_friends(collider, other); });
    std::vector<std::uint32_t> strangers = {7};
    broad_phase.query_for(collider, box, strangers);
    CHECK(strangers == found);
    const DVec3 origin = hooke::vector_cast<double>(Real(2) * spread * random_vector(random));
    DVec3 motion = hooke::vector_cast<double>(Real(2) * spread * random_vector(random)) - origin;
    if (random() % 4 == 0) motion.x = 0;
    if (random() % 4 == 0) motion.y = 0;
    const Real radius = random() % 2 == 0 ? Real(0) : Real(0.7);
    const RaySlabs ray = RaySlabs::of(origin, motion);
    broad_phase.query_sweep(origin, motion, radius, found);
    CHECK(found == model.all_that([&](const Box& other) { return ray.enter(other, double(radius)) <= 1.0; }));
  }
};

/// Half of the boxes drift, some leap, appear, vanish, or begin to move or to stand.
void change_some(Twin& twin, std::mt19937& random, Real spread) {
  const auto present = twin.model.items;
  for (const auto& [collider, item] : present) {
    const auto what = random() % 64;
    if (what < 28 && item.moves) {
      const Vec3 way = Real(0.02) * random_vector(random);
      twin.set(collider, {item.box.lower + way, item.box.upper + way}, true);
    } else if (what == 28) {
      twin.set(collider, random_box(random, spread), item.moves);
    } else if (what == 29) {
      twin.remove(collider);
    } else if (what == 30) {
      twin.set(collider, item.box, !item.moves);
    } else if (what == 31) {
      twin.remove(collider);
      twin.set(collider, random_box(random, spread), random() % 2 == 0);
    }
  }
  for (int i = 0; i < 4; ++i) {
    const auto collider = static_cast<std::uint32_t>(random() % 512);
    twin.set(collider, random_box(random, spread), random() % 3 != 0);
  }
}

}  // namespace

TEST_SUITE("collision/broad_phase") {
  TEST_CASE("pairs and queries are those that looking at every two boxes finds, however boxes change") {
    for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u}) {
      std::mt19937 random(seed);
      ThreadPool pool(2);
      const auto spread = static_cast<Real>(4 * seed);
      Twin twin;
      twin.model.companies = seed > 2 ? seed - 2 : 0;
      for (std::uint32_t c = 0; c < 300; ++c) twin.set(c, random_box(random, spread), c % 3 != 0);
      for (int step = 0; step < 60; ++step) {
        twin.check_queries(random, spread);  // with loose leaves
        twin.check_pairs(pool);
        for (int i = 0; i < 4; ++i) twin.check_queries(random, spread);
        change_some(twin, random, spread);
      }
    }
  }

  TEST_CASE("the pairs are the same for any number of workers and any history") {
    std::mt19937 random(4);
    std::vector<Box> boxes;
    for (int i = 0; i < 3000; ++i) boxes.push_back(random_box(random, Real(12)));
    std::vector<ColliderPair> expected;
    ThreadPool single(1);
    BroadPhase fresh;
    for (std::uint32_t c = 0; c < 3000; ++c) fresh.set(c, boxes[c], c % 4 != 0);
    fresh.find_pairs(single, expected);
    CHECK(expected.size() > 3000);
    CHECK(std::is_sorted(expected.begin(), expected.end()));
    for (const int workers : {1, 2, 3, 8}) {
      ThreadPool pool(workers);
      BroadPhase other;
      std::vector<ColliderPair> pairs;
      // Everything begins elsewhere, in another order, and comes near in steps.
      for (int step = 0; step <= 3; ++step) {
        const Real away = Real(3 - step);
        for (std::uint32_t c = 3000; c-- > 0;) {
          const Vec3 shift = {away * signed_unit(random), Real(0), Real(0)};
          other.set(c, {boxes[c].lower + shift, boxes[c].upper + shift}, c % 4 != 0);
        }
        other.find_pairs(pool, pairs);
      }
      CHECK(pairs == expected);
    }
  }

  TEST_CASE("boxes that stand are no pair, and become one when one of them moves") {
    ThreadPool pool(1);
    Twin twin;
    const Box box = box_at({}, {Real(1), Real(1), Real(1)});
    for (std::uint32_t c = 0; c < 20; ++c) twin.set(c, box, false);
    twin.check_pairs(pool);
    CHECK(twin.model.pairs().empty());
    twin.set(5, box, true);
    twin.check_pairs(pool);
    CHECK(twin.model.pairs().size() == 19);
    twin.set(5, box, false);
    twin.check_pairs(pool);
  }

  TEST_CASE("asked for some, it finds the pairs of those alone, with whom they met before, too") {
    ThreadPool pool(1);
    BroadPhase phase;
    std::vector<ColliderPair> pairs;
    for (std::uint32_t i = 0; i < 4; ++i) phase.set(i, box_at({Real(i), 0, 0}, {Real(0.6), 1, 1}), true);
    phase.find_pairs(pool, pairs);
    CHECK(pairs == std::vector<ColliderPair>{{0, 1}, {1, 2}, {2, 3}});
    phase.find_pairs_of(pool, std::vector<std::uint8_t>{1, 0, 0, 0}, pairs);
    CHECK(pairs == std::vector<ColliderPair>{{0, 1}});
    phase.set(2, box_at({Real(5), 0, 0}, {Real(0.6), 1, 1}), true);
    phase.find_pairs_of(pool, std::vector<std::uint8_t>{0, 0, 1, 0}, pairs);
    CHECK(pairs.empty());
    phase.find_pairs(pool, pairs);
    CHECK(pairs == std::vector<ColliderPair>{{0, 1}});
  }

  TEST_CASE("boxes that touch are a pair, and those a hair apart are none") {
    ThreadPool pool(1);
    Twin twin;
    twin.set(0, {{Real(0), Real(0), Real(0)}, {Real(1), Real(1), Real(1)}}, true);
    twin.set(1, {{Real(1), Real(1), Real(1)}, {Real(2), Real(2), Real(2)}}, true);
    twin.check_pairs(pool);
    CHECK(twin.model.pairs().size() == 1);
    twin.set(1, {{std::nextafter(Real(1), Real(2)), Real(1), Real(1)}, {Real(2), Real(2), Real(2)}}, true);
    twin.check_pairs(pool);
    CHECK(twin.model.pairs().empty());
  }

  TEST_CASE("a thousand boxes in one place pair with each other") {
    ThreadPool pool(3);
    Twin twin;
    for (std::uint32_t c = 0; c < 1000; ++c)
      twin.set(c, {{Real(1), Real(2), Real(3)}, {Real(1), Real(2), Real(3)}}, true);
    std::vector<ColliderPair> pairs;
    twin.broad_phase.find_pairs(pool, pairs);
    CHECK(pairs.size() == 1000 * 999 / 2);
    CHECK(std::is_sorted(pairs.begin(), pairs.end()));
    CHECK(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end());
  }

  TEST_CASE("infinite and huge boxes pair with what they overlap and spoil nothing") {
    std::mt19937 random(5);
    ThreadPool pool(2);
    Twin twin;
    for (std::uint32_t c = 0; c < 200; ++c) twin.set(c, random_box(random, Real(5)), c % 2 == 0);
    twin.set(300, {{-kFar, -kFar, -kFar}, {kFar, Real(0), kFar}}, false);  // a half-space
    twin.set(301, {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}}, true);
    const Real huge = std::numeric_limits<Real>::max();
    twin.set(302, {{-huge, -huge, -huge}, {huge, huge, Real(1)}}, true);
    twin.set(303, box_at({Real(1e17), Real(-1e17), Real(0)}, {Real(1e17), Real(1e17), Real(1e17)}), true);
    twin.set(304, box_at({Real(1e9), Real(1e9), Real(0)}, {Real(1), Real(1), Real(1)}), true);
    for (int step = 0; step < 20; ++step) {
      twin.check_pairs(pool);
      twin.check_queries(random, Real(5));
      change_some(twin, random, Real(5));
      twin.set(300, {{-kFar, -kFar, -kFar}, {kFar, Real(0.2) * Real(step), kFar}}, false);
      if (step == 10) twin.remove(301);
      if (step == 12) twin.set(302, random_box(random, Real(5)), true);
      if (step == 14) twin.set(304, {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}}, false);
    }
  }

  TEST_CASE("far from the origin, where a margin vanishes in rounding, pairs are right") {
    std::mt19937 random(6);
    ThreadPool pool(1);
    Twin twin;
    const Vec3 far = {Real(1e8), Real(-1e8), Real(1e8)};
    for (int step = 0; step < 5; ++step) {
      for (std::uint32_t c = 0; c < 100; ++c) {
        const Box box = random_box(random, Real(20));
        twin.set(c, {box.lower + far, box.upper + far}, true);
      }
      twin.check_pairs(pool);
    }
  }

  TEST_CASE("boxes that come one at a time, in a row, do not make the tree too deep") {
    ThreadPool pool(1);
    std::mt19937 random(7);
    Twin twin;
    for (std::uint32_t c = 0; c < 700; ++c) {
      const Real x = static_cast<Real>(std::pow(1.02, double(c)));
      twin.set(c, box_at({x, Real(0), Real(0)}, {Real(0.02) * x, Real(1), Real(1)}), true);
      std::vector<ColliderPair> pairs;
      twin.broad_phase.find_pairs(pool, pairs);
      if (c % 100 == 99) twin.check_queries(random, x);
    }
    twin.check_pairs(pool);
  }

  TEST_CASE("what was removed is gone, and nothing is left after clear") {
    ThreadPool pool(1);
    Twin twin;
    for (std::uint32_t c = 0; c < 64; ++c) twin.set(c, box_at({}, {Real(1), Real(1), Real(1)}), true);
    twin.check_pairs(pool);
    for (std::uint32_t c = 0; c < 64; c += 2) twin.remove(c);
    twin.remove(2);
    twin.remove(1000);
    twin.check_pairs(pool);
    twin.broad_phase.clear();
    twin.model.items.clear();
    twin.check_pairs(pool);
    twin.set(3, box_at({}, {Real(1), Real(1), Real(1)}), true);
    twin.set(4, box_at({}, {Real(1), Real(1), Real(1)}), false);
    twin.check_pairs(pool);
  }

  TEST_CASE("a company of a thousand boxes in one place is searched for strangers alone") {
    ThreadPool pool(2);
    BroadPhase broad_phase;
    const Box box = box_at({}, {Real(1), Real(1), Real(1)});
    for (std::uint32_t c = 0; c < 1000; ++c) broad_phase.set(c, box, true, -7);
    broad_phase.set(1000, box, true, -8);
    broad_phase.set(1001, box, false);
    std::vector<ColliderPair> pairs;
    broad_phase.find_pairs(pool, pairs);
    CHECK(pairs.size() == 2001);
    broad_phase.remove(5);
    broad_phase.set(5, box, true);  // it comes back as a stranger
    broad_phase.find_pairs(pool, pairs);
    CHECK(pairs.size() == 2001 + 999);
  }

  TEST_CASE("a sweep that is cut short by its visitor comes to the nearest first of what is in its way") {
    Twin twin;
    for (std::uint32_t c = 0; c < 1000; ++c) {
      twin.set(c, box_at({Real(3) * Real((c * 7) % 1000), Real(0), Real(0)}, {Real(1), Real(1), Real(1)}),
               false);
    }
    twin.broad_phase.update();
    int visits = 0;
    double nearest = 1;
    std::uint32_t first = 0;
    const DVec3 origin = {-10, 0, 0};
    const DVec3 motion = {10000, 0, 0};
    twin.broad_phase.visit_sweep(origin, motion, Real(0), [&](std::uint32_t collider) {
      ++visits;
      const double at = RaySlabs::of(origin, motion).enter(twin.model.items[collider].box);
      if (at < nearest) first = collider;
      nearest = std::min(nearest, at);
      return nearest;
    });
    CHECK(first == 0);
    CHECK(nearest == doctest::Approx(9.0 / 10000));
    CHECK(visits < 20);
  }
}
