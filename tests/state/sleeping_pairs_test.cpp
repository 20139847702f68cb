#include "state/sleeping_pairs.h"

#include "collision/scene.h"

#include <doctest/doctest.h>
#include <vector>

using hooke::Real;
using hooke::Shape;
using hooke::state::Manifold;
using hooke::state::Pair;
using hooke::state::SleepingPairScratch;
using hooke::test::PairScene;

namespace {

const Shape kCube = Shape::box({Real(0.5), Real(0.5), Real(0.5)});

struct Line {
  std::uint32_t a = 0, b = 0;
  std::int32_t points = 0;
  Real separation = Real(0);
  bool operator==(const Line&) const = default;
};

/// A floor (body 0) and cubes on it in stacks of two: 1 under 2, 3 under 4, ...
struct Stacks : PairScene {
  SleepingPairScratch scratch;

  explicit Stacks(int count) {
    add_static(Shape::box({Real(1000), Real(0.5), Real(10)}), {0, -0.5, 0});
    for (int i = 0; i < count; ++i) {
      add_dynamic(kCube, {2.0 * i, 0.5, 0});
      add_dynamic(kCube, {2.0 * i, 1.5, 0});
    }
    std::vector<hooke::collision::ColliderPair> found;
    const auto last = static_cast<std::uint32_t>(2 * count);
    for (std::uint32_t i = 1; i < last; i += 2) found.push_back({0, i});
    for (std::uint32_t i = 1; i < last; i += 2) found.push_back({i, i + 1});
    narrow_phase.merge_pairs(found, pairs);
    narrow_phase.update_manifolds(pool, bodies, colliders, {}, {.dt = Real(0.01)}, pairs);
  }
  void fall_asleep(std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t body = first; body <= last; ++body) bodies.asleep[body] = 1;
  }
  void park() { hooke::state::put_pairs_to_sleep(bodies, colliders, pairs, scratch); }
  bool unpark(const std::vector<std::uint32_t>& moving) {
    return hooke::state::wake_pairs(moving, bodies, colliders, pairs, scratch);
  }
  [[nodiscard]] std::vector<Line> lines() const {
    std::vector<Line> lines;
    hooke::state::for_each_manifold(pairs, [&](const Manifold& m) {
      lines.push_back({m.collider_a, m.collider_b, m.point_count, m.point[0].separation});
    });
    return lines;
  }
};

}  // namespace

TEST_SUITE("state/sleeping_pairs") {
  TEST_CASE("asleep or not, all manifolds are visited in the same order") {
    Stacks scene(4);
    const std::vector<Line> before = scene.lines();
    REQUIRE(before.size() == 8);
    scene.park();
    CHECK(scene.pairs.sleeping.pair.empty());  // nobody sleeps

    for (Manifold& m : scene.pairs.manifold)
      m.route = hooke::state::ContactRoute::kCoupled;  // in the last step
    scene.fall_asleep(3, 6);
    scene.park();
    CHECK(scene.pairs.pair.size() == 4);
    CHECK(scene.pairs.manifold.size() == 4);
    CHECK(scene.pairs.sleeping.pair.size() == 4);
    CHECK(scene.pairs.sleeping.of_body == std::vector<std::uint32_t>{2, 0, 0, 2, 1, 2, 1, 0, 0});
    CHECK(scene.lines() == before);
    for (const Manifold& m : scene.pairs.sleeping.manifold) CHECK_FALSE(m.is_coupled());
    for (const Pair& pair : scene.pairs.pair)
      CHECK(scene.pairs.manifold.at(pair.first_manifold).collider_b == pair.collider_b);
  }

  TEST_CASE("pairs of a body that wakes come back, and those of others stay") {
    Stacks scene(4);
    const std::vector<Line> before = scene.lines();
    scene.fall_asleep(1, 8);
    scene.park();
    REQUIRE(scene.pairs.pair.empty());
    CHECK_FALSE(scene.unpark({0, 3, 4}));  // the floor stands, and the others sleep

    scene.bodies.asleep[4] = 0;
    CHECK_FALSE(scene.unpark({2, 6}));
    CHECK(scene.unpark({2, 4, 6}));
    REQUIRE(scene.pairs.pair.size() == 1);
    CHECK(scene.pairs.pair[0].collider_a == 3);
    CHECK(scene.pairs.pair[0].collider_b == 4);
    CHECK(scene.pairs.sleeping.of_body == std::vector<std::uint32_t>{4, 2, 1, 1, 0, 2, 1, 2, 1});
    CHECK(scene.lines() == before);

    // They sleep again, where there are gaps now.
    scene.bodies.asleep[4] = 1;
    scene.park();  // one waits for the others
    CHECK(scene.pairs.pair.size() == 0);
    CHECK(scene.lines() == before);
  }

  TEST_CASE("few pairs wait a step before they are put to sleep with many") {
    Stacks scene(40);
    scene.fall_asleep(1, 78);
    scene.park();
    REQUIRE(scene.pairs.sleeping.pair.size() == 78);
    scene.fall_asleep(79, 80);
    scene.park();
    CHECK(scene.pairs.pair.size() == 2);
    scene.park();
    CHECK(scene.pairs.pair.empty());
    CHECK(scene.pairs.sleeping.pair.size() == 80);
  }

  TEST_CASE("points that push are counted, and pairs of bodies that go are removed") {
    Stacks scene(2);
    for (Manifold& m : scene.pairs.manifold) m.point[0].normal_impulse = Real(1);
    scene.fall_asleep(1, 4);
    scene.park();
    CHECK(scene.pairs.sleeping.contacts == 4);
    scene.pairs.coupled = {{.body_a = 0, .body_b = 1}, {.body_a = 1, .body_b = 2}};
    hooke::state::remove_pairs(std::vector<std::uint8_t>{0, 0, 1, 0, 0}, scene.colliders, scene.pairs);
    CHECK(scene.pairs.sleeping.contacts == 3);
    REQUIRE(scene.pairs.coupled.size() == 1);
    CHECK(scene.pairs.coupled[0].body_b == 1);
    CHECK(scene.pairs.sleeping.pair.size() == 3);
    CHECK(scene.pairs.sleeping.of_body == std::vector<std::uint32_t>{2, 1, 0, 2, 1});
  }

  TEST_CASE("pairs of sensors are not put to sleep") {
    Stacks scene(2);
    scene.bodies.traits[1].sensor = true;
    scene.fall_asleep(1, 4);
    scene.park();
    CHECK(scene.pairs.pair.size() == 2);
    CHECK(scene.pairs.sleeping.pair.size() == 2);
  }
}
