#include "solver/soft/bending.h"

#include "elements/dihedral.h"
#include "solver/pass_rows.h"
#include "solver/target_bits.h"

#include <array>
#include <doctest/doctest.h>
#include <limits>
#include <numbers>

namespace hooke::solver {
namespace {

constexpr Real kSubstep = Real(1) / Real(480);  // [s]

struct Net {
  state::Particles particles;
  state::Bends bends;
};

void add_bend(Net& net, state::Bends::Stencil stencil, Real rest_angle, Real stiffness, Real damping) {
  net.bends.stencil.push_back(stencil);
  net.bends.rest_angle.push_back(rest_angle);
  net.bends.stiffness.push_back(stiffness);
  net.bends.damping.push_back(damping);
  net.bends.weights.push_back({});
}

void add_particle(Net& net, Vec3 x, Vec3 v, Real inverse_mass) {
  net.particles.position.push_back({x});
  net.particles.velocity.push_back({v, inverse_mass});
}

/// One bend between two triangles that meet at `angle`; the edge lies along x.
Net hinge(double angle, Real rest_angle, Real stiffness, Real damping = Real(0)) {
  Net net;
  add_particle(net, {Real(0), Real(0), Real(0)}, {}, Real(1));
  add_particle(net, {Real(1), Real(0.1), Real(0)}, {}, Real(2));
  add_particle(net, {Real(0.4), static_cast<Real>(std::cos(angle)), static_cast<Real>(-std::sin(angle))}, {},
               Real(0.5));
  add_particle(net, {Real(0.7), Real(-1), Real(0)}, {}, Real(4));
  add_bend(net, {0, 1, 2, 3}, rest_angle, stiffness, damping);
  return net;
}

void solve(Net& net) {
  BendBlocks blocks;
  build_bend_blocks(owner_of_all(net.particles, {}, net.bends), net.bends, blocks);
  prepare_bends(blocks, kSubstep);
  for (const BendPass& pass : blocks.passes) {
    solve_bends(blocks, pass, {pass.first, pass.end}, net.particles);
  }
}

elements::Dihedral<double> measure(const Net& net, std::size_t row) {
  const state::Bends::Stencil& s = net.bends.stencil[row];
  const auto x = [&](std::uint32_t p) { return vector_cast<double>(net.particles.position[p].x); };
  return elements::dihedral(x(s.edge_a), x(s.edge_b), x(s.wing_a), x(s.wing_b));
}

/// Particles in a cube and bends between random four of them, some flat or without extent, always the same.
Net random_net(int particles, int bends) {
  Net net;
  std::uint32_t seed = 4711;
  const auto next = [&seed] { return (seed = seed * 1664525U + 1013904223U) >> 8; };
  const auto real = [&next] { return static_cast<Real>(next()) / static_cast<Real>(1 << 24); };
  for (int i = 0; i < particles; ++i) {
    const Real height = i % 3 == 0 ? Real(0) : real();
    add_particle(net, {real(), real(), height}, {real(), -real(), real()},
                 i % 17 == 0 ? Real(0) : Real(0.5) + real());
  }
  net.particles.position[5].x = net.particles.position[9].x;
  for (int i = 0; i < bends; ++i) {
    std::array<std::uint32_t, 4> p = {};
    for (std::uint32_t k = 0; k < 4; ++k) p[k] = 4 * (next() % static_cast<unsigned>(particles / 4)) + k;
    const Real rest = i % 3 == 0 ? Real(0) : Real(6) * real() - Real(3);
    add_bend(net, {p[0], p[1], p[2], p[3]}, rest, i % 5 == 0 ? Real(0) : real(),
             i % 2 == 0 ? Real(0) : real());
  }
  add_bend(net, {5, 9, 2, 3}, Real(0), Real(1), Real(0));
  return net;
}

}  // namespace

TEST_SUITE("solver/bending") {
  TEST_CASE("a bend gives the impulse of implicit Euler along the gradient of its angle") {
    // From rest: lambda = -h k C / (1 + h^2 k sum w |G|^2), v_i = w_i lambda G_i.
    constexpr Real kStiffness = Real(3000);
    for (const double angle : {-2.9, -1.6, -0.4, -1e-3, 0.0, 0.7, 1.5, 2.4, 3.1}) {
      Net net = hinge(angle, Real(0.25), kStiffness);
      const auto d = measure(net, 0);
      solve(net);
      const auto h = static_cast<double>(kSubstep);
      const double k = static_cast<double>(kStiffness);
      double w = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        w += static_cast<double>(net.particles.velocity[i].inverse_mass) * length_squared(d.gradient[i]);
      }
      double error = d.angle - 0.25;
      if (error <= -std::numbers::pi) error += 2 * std::numbers::pi;
      const double lambda = -h * k * error / (1 + h * h * k * w);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto weight = static_cast<double>(net.particles.velocity[i].inverse_mass);
        const DVec3 off = vector_cast<double>(net.particles.velocity[i].v) - weight * lambda * d.gradient[i];
        // Angles near 0 and 0.25 are known to 1e-7 of a turn only; impulses are about 1.
        CHECK(length(off) < 2e-5);
      }
    }
  }

  TEST_CASE("damping alone takes its share of the rate of the angle") {
    // Implicit step of c: rate' = rate / (1 + h c sum w |G|^2).
    constexpr double kDamping = 100;
    Net net = hinge(0.8, Real(-1), Real(0), static_cast<Real>(kDamping));
    net.particles.velocity[2].v = {Real(0.3), Real(-1), Real(2)};
    const auto d = measure(net, 0);
    const auto rate = [&] {
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i)
        sum += dot(d.gradient[i], vector_cast<double>(net.particles.velocity[i].v));
      return sum;
    };
    double w = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      w += static_cast<double>(net.particles.velocity[i].inverse_mass) * length_squared(d.gradient[i]);
    }
    const double before = rate();
    solve(net);
    CHECK(rate() ==
          doctest::Approx(before / (1 + static_cast<double>(kSubstep) * kDamping * w)).epsilon(1e-4));
  }

  TEST_CASE("momentum and angular momentum stay what they were") {
    Net net = hinge(1.1, Real(-0.6), Real(3000));
    solve(net);
    DVec3 momentum = {};
    DVec3 spin = {};
    for (std::size_t i = 0; i < 4; ++i) {
      const DVec3 p = (1.0 / static_cast<double>(net.particles.velocity[i].inverse_mass)) *
                      vector_cast<double>(net.particles.velocity[i].v);
      momentum += p;
      spin += cross(vector_cast<double>(net.particles.position[i].x), p);
    }
    CHECK(length(net.particles.velocity[2].v) > Real(0.5));
    CHECK(length(momentum) < 1e-5);
    CHECK(length(spin) < 1e-5);
  }

  TEST_CASE("triangles without extent are left alone") {
    for (const std::size_t flat : {1U, 2U, 3U}) {
      Net net = hinge(1.0, Real(0), Real(100));
      net.particles.position[flat].x = net.particles.position[0].x;
      net.particles.velocity[2].v = {Real(1), Real(2), Real(3)};
      solve(net);
      CHECK(net.particles.velocity[0].v == Vec3{});
      CHECK(net.particles.velocity[2].v == Vec3{Real(1), Real(2), Real(3)});
    }
  }

  TEST_CASE("rows of one pass share no particle, and every row is there once") {
    const Net net = random_net(200, 777);
    BendBlocks blocks;
    build_bend_blocks(owner_of_all(net.particles, {}, net.bends), net.bends, blocks);
    CHECK(count_rows_apart(blocks, 200) == net.bends.stencil.size());
  }

  TEST_CASE("every instruction set gives the bits of the scalar twin") {
    check_bits_of_targets(random_net(200, 777), [](Net& net) {
      solve(net);
      wide::move(kSubstep, {0, 200}, net.particles);
    });
  }
}

}  // namespace hooke::solver
