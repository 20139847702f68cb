#include "solver/soft/isometric_bending.h"

#include "hooke/desc.h"

#include "elements/isometric_bend.h"
#include "solver/pass_rows.h"
#include "solver/target_bits.h"

#include <array>
#include <doctest/doctest.h>
#include <numbers>
#include <vector>

namespace hooke::solver {
namespace {

using state::SpringClass;

constexpr Real kSubstep = Real(1) / Real(480);  // [s]

struct Net {
  state::Particles particles;
  state::Springs springs;
  state::Bends bends;
};

void add_particle(Net& net, Vec3 x, Vec3 v, Real inverse_mass) {
  net.particles.position.push_back({x});
  net.particles.velocity.push_back({v, inverse_mass});
}

void add_spring(Net& net, std::uint32_t a, std::uint32_t b, SpringClass kind, Real rest_length,
                Real stiffness) {
  append_spring(a, b, kind, rest_length, stiffness, net.springs);
}

void add_bend(Net& net, state::Bends::Stencil stencil, std::array<Real, 4> weights, Real stiffness) {
  net.bends.stencil.push_back(stencil);
  net.bends.rest_angle.push_back(Real(0));
  net.bends.stiffness.push_back(stiffness);
  net.bends.damping.push_back(Real(0.001));
  net.bends.weights.push_back(weights);
}

/// At rest: an edge of 1 m, with wings that are neither alike nor above its middle.
std::array<DVec3, 4> flat_hinge() {
  return {DVec3{0, 0, 0}, DVec3{1, 0, 0}, DVec3{0.4, 0.8, 0}, DVec3{0.7, -0.5, 0}};
}

std::array<DVec3, 4> folded_hinge(double angle) {
  std::array<DVec3, 4> x = flat_hinge();
  x[2] = {x[2].x, x[2].y * std::cos(angle), x[2].y * std::sin(angle)};
  return x;
}

std::array<double, 4> weights_of(const std::array<DVec3, 4>& x) {
  return elements::isometric_bend(x[0], x[1], x[2], x[3]);
}

/// The hinge folded by `angle`, with weights of its flat form.
Net hinge(double angle, Real stiffness) {
  Net net;
  const Real inverse_mass[4] = {Real(1), Real(2), Real(0.5), Real(4)};
  const std::array<DVec3, 4> x = folded_hinge(angle);
  std::array<Real, 4> weights = {};
  for (std::size_t i = 0; i < 4; ++i) {
    add_particle(net, vector_cast<Real>(x[i]), {}, inverse_mass[i]);
    weights[i] = static_cast<Real>(weights_of(flat_hinge())[i]);
  }
  add_bend(net, {0, 1, 2, 3}, weights, stiffness);
  return net;
}

void solve(Net& net) {
  IsometricBendBlocks blocks;
  TakenRows taken = {std::vector<std::uint8_t>(static_cast<std::size_t>(net.springs.count()), 0),
                     std::vector<std::uint8_t>(static_cast<std::size_t>(net.bends.count()), 0)};
  build_isometric_bend_blocks(owner_of_all(net.particles, net.springs, net.bends), net.bends, net.springs,
                              taken, blocks);
  prepare_isometric_bends(blocks, kSubstep);
  for (const IsometricBendPass& pass : blocks.passes)
    solve_isometric_bends(blocks, pass, {pass.first, pass.end}, net.particles);
}

/// Bends between random four of many particles; springs of two materials along some edges and between some
/// wings, and some elsewhere; always the same.
Net random_net(std::uint32_t particles, int bends) {
  Net net;
  std::uint32_t seed = 4711;
  const auto next = [&seed] { return (seed = seed * 1664525U + 1013904223U) >> 8; };
  const auto real = [&next] { return static_cast<Real>(next()) / static_cast<Real>(1 << 24); };
  for (std::uint32_t i = 0; i < particles; ++i) {
    const Real x = real(), y = real(), z = real(), u = real(), v = real(), w = real();
    add_particle(net, {x, y, z}, {u, -v, w}, i % 17 == 0 ? Real(0) : Real(0.5) + w);
  }
  net.particles.position[5].x = net.particles.position[9].x;
  for (int i = 0; i < bends; ++i) {
    std::array<std::uint32_t, 4> p = {};
    for (std::uint32_t k = 0; k < 4; ++k) p[k] = 4 * (next() % (particles / 4)) + k;
    const Real k1 = real(), k2 = real() - Real(2), k3 = real() - Real(2);
    add_bend(net, {p[0], p[1], p[2], p[3]}, {-(k1 + k2 + k3), k1, k2, k3}, Real(100) * real());
    if (i % 3 != 0) add_spring(net, p[1], p[0], SpringClass::kStretch, real(), Real(1e4));
    if (i % 4 == 0) add_spring(net, p[2], p[3], SpringClass::kShear, real(), i % 8 == 0 ? Real(500) : kRigid);
    if (i % 5 == 0) add_spring(net, p[0], p[2], SpringClass::kStretch, real(), Real(1e4));
    if (i % 7 == 0) add_spring(net, p[0], p[1], SpringClass::kLimit, real(), kRigid);
  }
  return net;
}

}  // namespace

TEST_SUITE("solver/isometric_bending") {
  TEST_CASE(
      "the curvature of a fold is 2 l sin(theta / 2) long, and zero for any flat form turned or moved") {
    const std::array<double, 4> weights = weights_of(flat_hinge());
    CHECK(std::abs(weights[0] + weights[1] + weights[2] + weights[3]) < 1e-15);
    for (const double angle : {0.01, 0.5, -1.2, 2.5, std::numbers::pi}) {
      const double q = length(elements::curvature(weights, folded_hinge(angle)));
      CHECK(std::abs(q - 2 * std::abs(std::sin(angle / 2))) < 1e-14);
    }
    std::array<DVec3, 4> turned = flat_hinge();
    for (DVec3& x : turned) x = DVec3{3, -7, 5} + DVec3{0.6 * x.x - 0.8 * x.y, 0.8 * x.x + 0.6 * x.y, 0};
    CHECK(length(elements::curvature(weights, turned)) < 1e-14);
  }

  TEST_CASE("a triangle without extent has no weights") {
    for (const std::size_t flat : {1U, 2U, 3U}) {
      std::array<DVec3, 4> x = flat_hinge();
      x[flat] = x[0];
      CHECK(weights_of(x) == std::array<double, 4>{});
    }
  }

  TEST_CASE("a bend gives the impulse of implicit Euler along its curvature") {
    // From rest, damping c = k / 1000 s: lambda = -h k q / (1 + h (c + h k) sum w K^2), v_i = w_i K_i lambda.
    constexpr double kStiffness = 3000;
    for (const double angle : {-2.9, -0.4, 0.7, 2.4}) {
      Net net = hinge(angle, static_cast<Real>(kStiffness));
      solve(net);
      const std::array<double, 4> weights = weights_of(flat_hinge());
      const DVec3 q = elements::curvature(weights, folded_hinge(angle));
      const auto h = static_cast<double>(kSubstep);
      double w = 0;
      for (std::size_t i = 0; i < 4; ++i)
        w += static_cast<double>(net.particles.velocity[i].inverse_mass) * weights[i] * weights[i];
      const DVec3 lambda = (-h * kStiffness / (1 + h * (0.001 + h) * kStiffness * w)) * q;
      for (std::size_t i = 0; i < 4; ++i) {
        const DVec3 expected =
            (static_cast<double>(net.particles.velocity[i].inverse_mass) * weights[i]) * lambda;
        CHECK(length(vector_cast<double>(net.particles.velocity[i].v) - expected) < 1e-5 * length(lambda));
      }
    }
  }

  TEST_CASE("momentum stays what it was, and angular momentum does from rest") {
    Net net = hinge(1.1, Real(3000));
    add_spring(net, 0, 1, SpringClass::kStretch, Real(0.9), Real(1e4));
    add_spring(net, 3, 2, SpringClass::kShear, Real(1), kRigid);
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
    CHECK(length(momentum) < 1e-4);
    CHECK(length(spin) < 1e-4);
  }

  TEST_CASE("springs of a hinge are solved as springs are") {
    // No bend, so that a rigid spring along the edge is all there is: its ends keep their distance's rate.
    Net net = hinge(0.3, Real(0));
    add_spring(net, 1, 0, SpringClass::kStretch, Real(0.98), kRigid);
    solve(net);
    const Vec3 d = net.particles.position[1].x - net.particles.position[0].x;
    const Real rate = dot(d, net.particles.velocity[1].v - net.particles.velocity[0].v);
    CHECK(std::abs(rate + Real(0.02) / kSubstep) < Real(1e-3));  // back to 0.98 m within the substep
    CHECK(net.particles.velocity[2].v == Vec3{});
    CHECK(net.particles.velocity[3].v == Vec3{});
  }

  TEST_CASE("every hinge and every spring is in one place, and hinges of a pass share no particle") {
    const Net net = random_net(400, 777);
    const auto objects = owner_of_all(net.particles, net.springs, net.bends);
    IsometricBendBlocks isometric_bends;
    TakenRows taken = {std::vector<std::uint8_t>(static_cast<std::size_t>(net.springs.count()), 0),
                       std::vector<std::uint8_t>(static_cast<std::size_t>(net.bends.count()), 0)};
    build_isometric_bend_blocks(objects, net.bends, net.springs, taken, isometric_bends);
    CHECK(count_rows_apart(isometric_bends, 400) == 777);
    int springs = 0;
    for (const IsometricBendPass& pass : isometric_bends.passes) {
      const int count = kLanes * (pass.end - pass.first - 1) + pass.last_count;
      springs += count * ((pass.edge != kNoSpring ? 1 : 0) + (pass.wings != kNoSpring ? 1 : 0));
    }
    int rows = 0;
    for (std::size_t row = 0; row < taken.springs.size(); ++row) {
      rows += taken.springs[row];
      if (net.springs.kind[row] == SpringClass::kLimit) CHECK(taken.springs[row] == 0);
    }
    CHECK(springs == rows);
    CHECK(springs > 600);
    SpringBlocks others;
    build_spring_blocks(objects, net.springs, net.particles, taken.springs, others);
    for (const SpringPass& pass : others.passes)
      rows += kLanes * (pass.end - pass.first - 1) + pass.last_count;
    CHECK(rows == net.springs.count());
  }

  TEST_CASE("every instruction set gives the bits of the scalar twin") {
    check_bits_of_targets(random_net(400, 777), [](Net& net) {
      solve(net);
      wide::move(kSubstep, {0, 400}, net.particles);
    });
  }
}

}  // namespace hooke::solver
