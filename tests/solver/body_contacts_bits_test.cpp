#include "solver/body_scene.h"
#include "solver/contact/body_contacts.h"
#include "solver/soft/particle_kernels.h"

#include <algorithm>
#include <cstring>
#include <doctest/doctest.h>
#include <string>

namespace hooke::solver {
namespace {

using testing::BodyScene;
using testing::Manifold;

/// Numbers that are always the same.
struct Random {
  std::uint32_t seed = 12345;

  std::uint32_t next() { return seed = seed * 1664525U + 1013904223U; }
  std::uint32_t below(std::uint32_t n) { return (next() >> 8) % n; }
  Real unit() { return static_cast<Real>(next() >> 8) / static_cast<Real>(1 << 24); }
  Real sign() { return Real(2) * unit() - Real(1); }
  Vec3 vector() { return {sign(), sign(), sign()}; }
};

Manifold random_manifold(Random& random, std::uint32_t a, std::uint32_t b) {
  Manifold m;
  m.body_a = std::min(a, b);
  m.body_b = std::max(a, b);
  m.point_count = 1 + static_cast<std::int32_t>(random.below(4));
  m.normal = normalize(random.vector() + Vec3{Real(0.1), Real(0), Real(0)});
  for (int k = 0; k < m.point_count; ++k) {
    state::ContactPoint& p = m.point[k];
    p.anchor_a = Real(0.5) * random.vector();
    p.anchor_b = Real(0.5) * random.vector();
    p.separation = Real(0.02) * random.sign();
    p.normal_impulse = random.below(2) == 0 ? Real(0) : Real(0.1) * random.unit();
  }
  m.friction = random.unit();
  m.static_friction = m.friction + Real(0.1);
  m.restitution = random.below(3) == 0 ? random.unit() : Real(0);
  m.rolling_friction = random.below(4) == 0 ? Real(0.01) : Real(0);
  m.spinning_friction = random.below(4) == 0 ? Real(0.01) : Real(0);
  m.surface_velocity = random.below(8) == 0 ? random.vector() : Vec3{};
  return m;
}

void add_random_bodies(BodyScene& scene, Random& random, int count) {
  for (int i = 0; i < count; ++i) {
    const bool moves = i % 9 != 0;
    const Vec3 inertia = {Real(0.2) + random.unit(), Real(0.2) + random.unit(), Real(0.2) + random.unit()};
    const std::uint32_t row = scene.add({moves ? Real(0.5) + random.unit() : Real(0), inertia}, {});
    if (moves) {
      scene.spin(row, random.vector());
      scene.bodies.motion[row].v = random.vector();
    } else if (i % 2 == 0) {
      scene.bodies.traits[row].kind = BodyKind::kKinematic;
      scene.bodies.motion[row].v = random.vector();
      scene.bodies.angular_velocity[row] = random.vector();
      scene.awake.push_back(row);
    }
  }
}

/// Bodies and contacts of every sort, without geometry that holds together.
void add_tangle(BodyScene& scene) {
  Random random;
  constexpr std::uint32_t kBodies = 300;
  add_random_bodies(scene, random, kBodies);
  for (int i = 0; i < 1500; ++i) {
    const std::uint32_t a = random.below(kBodies);
    const std::uint32_t b = (a + 1 + random.below(kBodies - 1)) % kBodies;
    scene.manifolds.push_back(random_manifold(random, a, b));
    scene.places.emplace_back([](BodyScene&, Manifold&) {});
  }
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

struct Outcome {
  std::vector<Vec3> velocity;
  std::vector<DVec3> center;
  std::vector<Vec3> momentum;
  std::vector<Real> impulses;
};

Outcome outcome_of(const BodyScene& scene) {
  Outcome outcome;
  outcome.center = scene.bodies.center;
  outcome.momentum = scene.bodies.angular_momentum;
  for (const state::MotionRecord& record : scene.bodies.motion) outcome.velocity.push_back(record.v);
  for (const Manifold& m : scene.manifolds) {
    for (const Vec3 v : {m.friction_impulse, m.rolling_impulse})
      outcome.impulses.insert(outcome.impulses.end(), {v.x, v.y, v.z});
    outcome.impulses.push_back(m.twist_impulse);
    for (const state::ContactPoint& p : m.point) outcome.impulses.push_back(p.normal_impulse);
  }
  return outcome;
}

void check_same(const Outcome& a, const Outcome& b) {
  CHECK(same_bits(a.velocity, b.velocity));
  CHECK(same_bits(a.center, b.center));
  CHECK(same_bits(a.momentum, b.momentum));
  CHECK(same_bits(a.impulses, b.impulses));
}

}  // namespace

TEST_SUITE("solver/body_contacts_bits") {
  TEST_CASE("every instruction set gives the bits of the scalar twin") {
    Outcome scalar;
    for (const std::string& target : wide::targets()) {
      CAPTURE(target);
      REQUIRE(wide::use_target(target));
      BodyScene scene;
      scene.settings.friction_in_bias = true;
      add_tangle(scene);
      scene.run(3);
      const Outcome outcome = outcome_of(scene);
      for (const Vec3 v : outcome.velocity) CHECK(is_finite(v));
      if (scalar.velocity.empty()) scalar = outcome;
      check_same(outcome, scalar);
    }
    wide::use_target("");
  }

  TEST_CASE("any number of workers gives the same bits") {
    Outcome alone;
    for (const int workers : {1, 2, 3, 8}) {
      CAPTURE(workers);
      BodyScene scene(workers);
      add_tangle(scene);
      scene.run(3);
      if (workers == 1) alone = outcome_of(scene);
      check_same(outcome_of(scene), alone);
    }
  }

  TEST_CASE("the lane a contact stands in does not matter") {
    Outcome in_order;
    for (const int shift : {0, 1, 7, 23}) {
      CAPTURE(shift);
      Random random;
      BodyScene scene;
      add_random_bodies(scene, random, 72);
      std::vector<Manifold> pairs;
      for (std::uint32_t i = 1; i + 1 < 72; i += 2) pairs.push_back(random_manifold(random, i, i + 1));
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        scene.manifolds.push_back(pairs[(i + static_cast<std::size_t>(shift)) % pairs.size()]);
        scene.places.emplace_back([](BodyScene&, Manifold&) {});
      }
      scene.run(3);
      Outcome outcome = outcome_of(scene);
      outcome.impulses.clear();
      if (shift == 0) in_order = outcome;
      check_same(outcome, in_order);
    }
  }

  TEST_CASE("no two contacts of a color share a body that moves, and none is lost") {
    BodyScene scene;
    add_tangle(scene);
    scene.step();
    std::size_t rows = 0;
    for (int color = 0; color < scene.contacts.color_count(); ++color) {
      std::vector<int> uses(scene.bodies.motion.size(), 0);
      const int begin = scene.contacts.color_begin[color] * kContactLanes;
      const int end = scene.contacts.color_begin[color + 1] * kContactLanes;
      for (int i = begin; i < end; ++i) {
        const std::uint32_t row = scene.contacts.manifold_of[i];
        if (row == BodyContacts::kNoManifold) continue;
        ++rows;
        for (const std::uint32_t body : {scene.manifolds[row].body_a, scene.manifolds[row].body_b})
          if (scene.bodies.motion[body].inverse_mass > Real(0)) CHECK(++uses[body] == 1);
      }
    }
    const auto moves = [&](std::uint32_t body) { return scene.bodies.motion[body].inverse_mass > Real(0); };
    const auto expected =
        std::count_if(scene.manifolds.begin(), scene.manifolds.end(),
                      [&](const Manifold& m) { return moves(m.body_a) || moves(m.body_b); });
    CHECK(rows == static_cast<std::size_t>(expected));
  }

  TEST_CASE("contacts with what stands are solved after those between bodies that move") {
    BodyScene scene;
    add_tangle(scene);
    scene.step();
    const ContactBlock& last = scene.contacts.blocks.back();
    CHECK(last.anchored);
    CHECK_FALSE(scene.contacts.blocks.front().anchored);
  }

  TEST_CASE("a body with a hundred contacts is still solved, and momentum kept") {
    BodyScene scene;
    scene.settings.gravity = {};
    const std::uint32_t hub = scene.add(testing::solid_sphere(Real(10), Real(1)), {});
    Random random;
    for (int i = 0; i < 100; ++i) {
      const Vec3 n = normalize(random.vector());
      const std::uint32_t ball =
          scene.add(testing::solid_sphere(Real(1), Real(0.1)), vector_cast<double>(Real(1.1) * n));
      scene.bodies.motion[ball].v = -n;
      scene.add_contact(hub, ball, {}, [](BodyScene& s, Manifold& m) {
        testing::place_sphere(s, m, {}, Real(1), Real(0.1));
      });
    }
    DVec3 before = {};
    for (int i = 0; i < 101; ++i)
      before += static_cast<double>(scene.bodies.mass[i].mass) * vector_cast<double>(scene.velocity(i));
    scene.step();
    DVec3 after = {};
    for (int i = 0; i < 101; ++i)
      after += static_cast<double>(scene.bodies.mass[i].mass) * vector_cast<double>(scene.velocity(i));
    CHECK(scene.contacts.color_count() == 100);
    CHECK(length(after - before) < 1e-4);  // of 100 kg m/s each way
    for (int i = 1; i < 101; ++i) {
      const Vec3 n = normalize(vector_cast<Real>(scene.bodies.center[i] - scene.bodies.center[0]));
      CHECK(dot(n, scene.velocity(i) - scene.velocity(0)) > Real(-0.05));
    }
  }

  TEST_CASE("bodies that stand, sleep or are moved by hand are not written") {
    BodyScene scene;
    add_tangle(scene);
    scene.bodies.asleep[5] = 1;
    scene.bodies.motion[5].v = {};
    scene.bodies.angular_momentum[5] = {};
    std::erase(scene.awake, 5U);
    const std::vector<state::MotionRecord> before = scene.bodies.motion;
    scene.step();
    for (std::uint32_t i = 0; i < before.size(); ++i) {
      if (i == 5 || !(before[i].inverse_mass > Real(0))) CHECK(scene.velocity(i) == before[i].v);
    }
    CHECK(scene.bodies.free_motion[5].v == Vec3{});
  }
}

}  // namespace hooke::solver
