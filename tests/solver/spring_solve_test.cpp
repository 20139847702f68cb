#include "solver/soft/spring_solve.h"

#include "solver/pass_rows.h"
#include "solver/target_bits.h"

#include <doctest/doctest.h>
#include <limits>

namespace hooke::solver {
namespace {

constexpr Real kSubstep = Real(1) / Real(480);  // [s]
constexpr Real kStiff = std::numeric_limits<Real>::infinity();

/// Two particles at rest on the x axis joined by one spring.
struct Pair {
  state::Particles particles;
  state::Springs springs;
};

struct PairDesc {
  Real separation = Real(1);
  Real rest_length = Real(1);
  Real w_a = Real(1);
  Real w_b = Real(1);
  Real stiffness = Real(100);
  Real damping = Real(0);
  Real damped_mass = std::numeric_limits<Real>::infinity();
  state::SpringClass kind = state::SpringClass::kStretch;
  state::SpringForm form = state::SpringForm::kExplicit;
};

Pair make_pair(const PairDesc& d) {
  Pair pair;
  pair.particles.position = {{}, {{d.separation, Real(0), Real(0)}}};
  pair.particles.velocity = {{{}, d.w_a}, {{}, d.w_b}};
  pair.springs = {{0}, {1}, {d.rest_length}, {d.stiffness}, {d.damping}, {d.damped_mass}, {d.kind}, {d.form}};
  return pair;
}

void solve(Pair& pair) {
  SpringBlocks blocks;
  build_spring_blocks(owner_of_all(pair.particles, pair.springs, {}), pair.springs, pair.particles, {},
                      blocks);
  prepare_springs(blocks.materials, kSubstep);
  for (const SpringPass& pass : blocks.passes) {
    solve_springs(blocks, pass, {pass.first, pass.end}, kSubstep, pair.particles);
  }
}

/// Particles in a cube and springs between random pairs of them, always the same.
Pair random_net(int particles, int springs, state::SpringClass kind) {
  Pair net;
  std::uint32_t seed = 12345;
  const auto next = [&seed] { return seed = seed * 1664525U + 1013904223U; };
  const auto real = [&next] { return static_cast<Real>(next() >> 8) / static_cast<Real>(1 << 24); };
  for (int i = 0; i < particles; ++i) {
    const bool pinned = kind == state::SpringClass::kTether ? i < 4 : i % 17 == 0;
    net.particles.position.push_back({{real(), real(), real()}, Real(0.01)});
    net.particles.velocity.push_back({{real(), -real(), real()}, pinned ? Real(0) : Real(0.5) + real()});
  }
  for (int i = 0; i < springs; ++i) {
    const auto a = static_cast<std::uint32_t>(4 + next() % static_cast<unsigned>(particles - 4));
    const auto b =
        kind == state::SpringClass::kTether
            ? next() % 4
            : (a + 1 + next() % static_cast<unsigned>(particles - 1)) % static_cast<unsigned>(particles);
    net.springs.particle_a.push_back(a);
    net.springs.particle_b.push_back(b);
    net.springs.rest_length.push_back(Real(0.3) * real());
    net.springs.stiffness.push_back(i % 3 == 0 ? kStiff : Real(1000));
    net.springs.damping.push_back(i % 2 == 0 ? Real(0) : Real(0.1));
    net.springs.damped_mass.push_back(std::numeric_limits<Real>::infinity());
    net.springs.kind.push_back(kind);
    net.springs.form.push_back(state::SpringForm::kExplicit);
  }
  return net;
}

}  // namespace

TEST_SUITE("solver/spring_solve") {
  TEST_CASE("a rigid link closes its error within one substep, no faster than 100 m/s") {
    for (const double far : {0.002, 2.0}) {
      Pair pair = make_pair({.separation = static_cast<Real>(1 + far), .stiffness = kStiff});
      solve(pair);
      const Real closing = pair.particles.velocity[0].v.x - pair.particles.velocity[1].v.x;
      CHECK(closing == doctest::Approx(std::min(far / kSubstep, 100.0)).epsilon(1e-3));
    }
  }

  TEST_CASE("a soft spring gives the impulse of implicit Euler") {
    // Two free masses m: relative motion r'' = -2 k (r - L) / m. One implicit Euler step from rest:
    // v = -h (2 k / m) C / (1 + h^2 2 k / m), with C = 0.1 m, k = 100 N/m, m = 1 kg.
    for (const auto form : {state::SpringForm::kExplicit, state::SpringForm::kPredicted}) {
      Pair pair = make_pair({.separation = Real(1.1), .form = form});
      solve(pair);
      const Real rate = pair.particles.velocity[1].v.x - pair.particles.velocity[0].v.x;
      const Real expected = -kSubstep * Real(200) * Real(0.1) / (Real(1) + kSubstep * kSubstep * Real(200));
      CHECK(rate == doctest::Approx(static_cast<double>(expected)).epsilon(1e-4));
    }
  }

  TEST_CASE("damping alone takes its share of the relative velocity") {
    // Implicit step of c: v' = v / (1 + h c (w_a + w_b)).
    Pair pair = make_pair({.stiffness = Real(0), .damping = Real(24)});
    pair.particles.velocity[1].v = {Real(1), Real(0), Real(0)};
    solve(pair);
    const Real rate = pair.particles.velocity[1].v.x - pair.particles.velocity[0].v.x;
    CHECK(rate == doctest::Approx(1.0 / 1.1).epsilon(1e-5));
  }

  TEST_CASE("central damping leaves the transverse velocity alone and isotropic damping does not") {
    for (const bool isotropic : {false, true}) {
      Pair pair = make_pair(
          {.stiffness = Real(0),
           .damping = Real(24),
           .form = isotropic ? state::SpringForm::kExplicitIsotropic : state::SpringForm::kExplicit});
      pair.particles.velocity[1].v = {Real(0), Real(1), Real(0)};
      solve(pair);
      const Real rate = pair.particles.velocity[1].v.y - pair.particles.velocity[0].v.y;
      CHECK(rate == doctest::Approx(isotropic ? 1.0 / 1.1 : 1.0).epsilon(1e-5));
    }
  }

  TEST_CASE("momentum stays what it was") {
    Pair pair = make_pair({.separation = Real(3), .w_b = Real(0.25), .stiffness = kStiff});  // 1 kg and 4 kg
    solve(pair);
    const Real momentum = pair.particles.velocity[0].v.x + Real(4) * pair.particles.velocity[1].v.x;
    CHECK(std::abs(momentum) < Real(1e-3));  // of 768 kg m/s each way
  }

  TEST_CASE("a particle with infinite mass does not move") {
    Pair pair = make_pair({.separation = Real(3), .w_a = Real(0), .stiffness = kStiff});
    solve(pair);
    CHECK(pair.particles.velocity[0].v == Vec3{});
    CHECK(pair.particles.velocity[1].v.x == doctest::Approx(-100).epsilon(1e-6));
  }

  TEST_CASE("a limit pulls when it is too long and does nothing when it is short") {
    Pair slack =
        make_pair({.separation = Real(0.5), .stiffness = kStiff, .kind = state::SpringClass::kLimit});
    solve(slack);
    CHECK(slack.particles.velocity[0].v == Vec3{});
    Pair taut = make_pair({.separation = Real(1.5), .stiffness = kStiff, .kind = state::SpringClass::kLimit});
    solve(taut);
    CHECK(taut.particles.velocity[0].v.x > Real(0));
  }

  TEST_CASE("coincident particles stay finite and at rest") {
    Pair pair = make_pair({.separation = Real(0), .stiffness = kStiff});
    solve(pair);
    CHECK(pair.particles.velocity[0].v == Vec3{});
    CHECK(pair.particles.velocity[1].v == Vec3{});
  }

  TEST_CASE("rows of one pass share no particle that is written") {
    const Pair net = random_net(300, 1500, state::SpringClass::kStretch);
    SpringBlocks blocks;
    build_spring_blocks(owner_of_all(net.particles, net.springs, {}), net.springs, net.particles, {}, blocks);
    std::size_t rows = 0;
    for (const SpringPass& pass : blocks.passes) {
      std::vector<int> uses(300, 0);
      for (int i = pass.first; i < pass.end; ++i) {
        const int count = i + 1 == pass.end ? pass.last_count : kLanes;
        rows += static_cast<std::size_t>(count);
        for (int lane = 0; lane < count; ++lane) {
          CHECK(++uses[blocks.blocks[i].record_a[lane] / 4] == 1);
          CHECK(++uses[blocks.blocks[i].record_b[lane] / 4] == 1);
        }
      }
    }
    CHECK(rows == 1500);
  }

  TEST_CASE("a hub of a hundred springs is still solved") {
    Pair star;
    for (int i = 0; i < 101; ++i) {
      star.particles.position.push_back({{static_cast<Real>(i), Real(1), Real(0)}});
      star.particles.velocity.push_back({{}, Real(1)});
      if (i == 0) continue;
      star.springs.particle_a.push_back(0);
      star.springs.particle_b.push_back(static_cast<std::uint32_t>(i));
      star.springs.rest_length.push_back(Real(0.5));
      star.springs.stiffness.push_back(Real(10));
      star.springs.damping.push_back(Real(0));
      star.springs.damped_mass.push_back(std::numeric_limits<Real>::infinity());
      star.springs.kind.push_back(state::SpringClass::kStretch);
      star.springs.form.push_back(state::SpringForm::kExplicit);
    }
    solve(star);
    for (int i = 1; i < 101; ++i) CHECK(star.particles.velocity[i].v.x < Real(0));
  }

  TEST_CASE("every instruction set gives the bits of the scalar twin") {
    using state::SpringClass;
    for (const SpringClass kind : {SpringClass::kStretch, SpringClass::kLimit, SpringClass::kTether}) {
      check_bits_of_targets(random_net(200, 777, kind), [](Pair& net) {
        solve(net);
        wide::accelerate({Real(0.1), Real(-9.81), Real(0.3)}, kSubstep, {3, 200}, net.particles);
        wide::move(kSubstep, {0, 199}, net.particles);
      });
    }
    CHECK_FALSE(wide::use_target("abacus"));
  }
}

}  // namespace hooke::solver
