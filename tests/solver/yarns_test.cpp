#include "solver/soft/yarns.h"

#include "solver/pass_rows.h"
#include "solver/target_bits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <vector>

namespace hooke::solver {
namespace {

constexpr Real kSubstep = Real(1) / Real(480);  // [s]

struct Net {
  state::Particles particles;
  state::Springs springs;
  state::Bends bends;
  std::vector<state::Deformable> objects = std::vector<state::Deformable>(1);
};

struct Random {
  std::uint32_t seed = 4711;
  /// A number in [0, 1).
  double next() { return (seed = seed * 1664525U + 1013904223U) / 4294967296.0; }
  Real between(double low, double high) { return static_cast<Real>(low + (high - low) * next()); }
};

void add_spring(Net& net, std::uint32_t a, std::uint32_t b, state::SpringClass kind, Real rest_length,
                Real stiffness) {
  append_spring(a, b, kind, rest_length, stiffness, net.springs);
  ++net.objects[0].springs.count;
}

void add_bend(Net& net, const state::Bends::Stencil& stencil, Real length, Real stiffness) {
  net.bends.stencil.push_back(stencil);
  net.bends.rest_angle.push_back(Real(0));
  net.bends.stiffness.push_back(stiffness);
  net.bends.damping.push_back(Real(0.002));
  net.bends.weights.push_back({Real(-2) / length, Real(0), Real(1) / length, Real(1) / length});
  ++net.objects[0].bends.count;
}

/// A cloth of points that lie near a grid, cells 0.1 m wide, and move at random.
Net woven(std::uint32_t columns, std::uint32_t rows, Real stiffness, Real limit, Real rigidity) {
  Net net;
  Random random;
  state::Deformable& cloth = net.objects[0];
  cloth.kind = PointRef::Kind::kCloth;
  cloth.columns = columns;
  cloth.particles.count = columns * rows;
  for (std::uint32_t i = 0; i < columns * rows; ++i) {
    const Vec3 x = {Real(0.1) * static_cast<Real>(i % columns) + random.between(-0.01, 0.01),
                    random.between(-0.02, 0.02),
                    Real(0.1) * static_cast<Real>(i / columns) + random.between(-0.01, 0.01)};
    net.particles.position.push_back({x});
    const Vec3 v = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const bool is_pinned = random.next() < 0.05;
    net.particles.velocity.push_back(
        {is_pinned ? Vec3{} : v, is_pinned ? Real(0) : random.between(100, 400)});
  }
  for (std::uint32_t i = 0; i < columns * rows; ++i) {
    const bool has_right = i % columns + 1 < columns, has_below = i / columns + 1 < rows;
    for (const auto kind : {state::SpringClass::kStretch, state::SpringClass::kLimit}) {
      const bool is_limit = kind == state::SpringClass::kLimit;
      if (is_limit && !(limit < kRigid)) continue;
      const Real length = is_limit ? Real(0.1) * (1 + limit) : Real(0.1);
      const Real k = is_limit ? kRigid : stiffness;
      // A spring is missing here and there, as where a cloth is torn.
      if (has_right && i % 37 != 5) add_spring(net, i, i + 1, kind, length, k);
      if (has_below && i % 41 != 7) add_spring(net, i, i + columns, kind, length, k);
    }
    if (!(rigidity > Real(0))) continue;
    const std::uint32_t beside = has_below ? i + columns : i - columns;
    if (has_right && i % columns > 0) add_bend(net, {i, beside, i - 1, i + 1}, Real(0.1), rigidity);
  }
  return net;
}

TakenRows none_taken(const Net& net) {
  return {std::vector<std::uint8_t>(static_cast<std::size_t>(net.springs.count()), 0),
          std::vector<std::uint8_t>(static_cast<std::size_t>(net.bends.count()), 0)};
}

Yarns yarns_of(const Net& net, Real h = kSubstep) {
  Yarns yarns;
  TakenRows taken = none_taken(net);
  build_yarns(net.objects, net.springs, net.bends, net.particles, taken, yarns);
  CHECK(std::count(taken.springs.begin(), taken.springs.end(), 1) == net.springs.count());
  prepare_yarns(yarns, h);
  return yarns;
}

template <class Solve>
void for_passes(Yarns& yarns, Solve&& solve) {
  for (const YarnPass& pass : yarns.passes) solve(pass, parallel::Range{pass.first, pass.end});
}

/// A yarn of n links along x, a grid of two rows, the other of which is pinned.
Net straight_yarn(std::uint32_t links, Real stiffness, Real limit = kRigid) {
  Net net;
  state::Deformable& cloth = net.objects[0];
  cloth.kind = PointRef::Kind::kCloth;
  cloth.columns = links + 1;
  cloth.particles.count = 2 * (links + 1);
  for (std::uint32_t i = 0; i < cloth.particles.count; ++i) {
    const bool is_held = i % cloth.columns == 0 || i > links;
    net.particles.position.push_back({{Real(0.1) * static_cast<Real>(i % cloth.columns), 0, 0}});
    net.particles.velocity.push_back({{}, is_held ? Real(0) : Real(100)});
  }
  for (std::uint32_t i = 0; i < links; ++i) {
    add_spring(net, i, i + 1, state::SpringClass::kStretch, Real(0.1), stiffness);
    if (limit < kRigid)
      add_spring(net, i, i + 1, state::SpringClass::kLimit, Real(0.1) * (1 + limit), kRigid);
  }
  return net;
}

void fall(Net& net, Vec3 gravity, int substeps) {
  Yarns yarns = yarns_of(net);
  for (int i = 0; i < substeps; ++i) {
    for (auto& record : net.particles.velocity) {
      if (record.inverse_mass > Real(0)) record.v = Real(0.98) * (record.v + kSubstep * gravity);
    }
    for_passes(yarns, [&](const YarnPass& pass, parallel::Range blocks) {
      solve_yarns(yarns, pass, blocks, net.particles);
    });
    wide::move(kSubstep, {0, static_cast<int>(net.particles.position.size())}, net.particles);
  }
}

double stretch_of(const Net& net, std::uint32_t link) {
  const Vec3 d = net.particles.position[link + 1].x - net.particles.position[link].x;
  return static_cast<double>(length(d)) / 0.1 - 1;
}

}  // namespace

TEST_SUITE("solver/yarns") {
  TEST_CASE("a load at the end of a hanging yarn stretches each link by its weight over k") {
    // A load of 2000 nodes, 20 kg, whose weight travels through all 50 links in each substep.
    Net net = straight_yarn(50, Real(1e5));
    net.particles.velocity[50].inverse_mass = Real(0.05);
    fall(net, {Real(10), 0, 0}, 2000);
    for (const std::uint32_t link : {0U, 25U, 49U}) {
      const double weight = (20 + 0.01 * (49 - link)) * 10;
      CHECK(stretch_of(net, link) == doctest::Approx(weight / (1e5 * 0.1)).epsilon(0.01));
    }
  }

  TEST_CASE("links are no longer than their limit under any load") {
    Net net = straight_yarn(30, Real(100), Real(0.05));
    net.particles.velocity[30].inverse_mass = Real(0.05);  // 20 kg on springs of 100 N/m
    fall(net, {Real(10), 0, 0}, 2000);
    for (std::uint32_t link = 0; link < 30; ++link) CHECK(stretch_of(net, link) < 0.0505);
    CHECK(stretch_of(net, 0) > 0.0495);
  }

  TEST_CASE("a rigid yarn between two pins is taut and at rest") {
    Net net = straight_yarn(20, kRigid);
    net.particles.velocity[20].inverse_mass = Real(0);
    fall(net, {0, Real(-10), 0}, 500);
    for (std::uint32_t i = 0; i <= 20; ++i) {
      CHECK(std::abs(net.particles.position[i].x.y) < Real(0.01));
      CHECK(length(net.particles.velocity[i].v) < Real(0.05));
    }
  }

  TEST_CASE("a load that swings on a yarn a thousand times lighter keeps its energy, or loses a little") {
    Net net = straight_yarn(30, Real(1e6));
    net.particles.velocity[30].inverse_mass = Real(0.2);  // 5 kg
    Yarns yarns = yarns_of(net);
    double most = 0;
    for (int i = 0; i < 480 * 6; ++i) {
      for (auto& record : net.particles.velocity) {
        if (record.inverse_mass > Real(0)) record.v += kSubstep * Vec3{0, -10, 0};
      }
      for_passes(yarns, [&](const YarnPass& pass, parallel::Range blocks) {
        solve_yarns(yarns, pass, blocks, net.particles);
      });
      wide::move(kSubstep, {0, 62}, net.particles);
      const auto& load = net.particles.velocity[30].v;
      const double energy = 0.5 * 5 * static_cast<double>(dot(load, load)) +
                            5 * 10 * static_cast<double>(net.particles.position[30].x.y);
      most = std::max(most, energy);
    }
    CHECK(most < 1.5);  // of 150 J
    for (std::uint32_t link = 0; link < 30; ++link) CHECK(stretch_of(net, link) < 0.02);
  }

  TEST_CASE("a clamped yarn sags under its weight as a beam does") {
    // q L^4 / 8 EI of a clamped beam, with half a cell that bends at the clamp.
    Net net = straight_yarn(41, Real(1e4));
    const double rigidity = 2;
    for (std::uint32_t i = 1; i < 41; ++i)
      add_bend(net, {i, i + 42, i - 1, i + 1}, Real(0.1), static_cast<Real>(rigidity / 0.1));
    net.particles.velocity[1].inverse_mass = Real(0);
    Yarns yarns = yarns_of(net);
    const double q = 0.01 * 0.02 / 0.1;
    for (int i = 0; i < 40000; ++i) {
      for (auto& record : net.particles.velocity) {
        if (record.inverse_mass > Real(0))
          record.v = Real(0.999) * (record.v + kSubstep * Vec3{0, Real(-0.02), 0});
      }
      for_passes(yarns, [&](const YarnPass& pass, parallel::Range blocks) {
        bend_yarns(yarns, pass, blocks, net.particles);
        solve_yarns(yarns, pass, blocks, net.particles);
      });
      wide::move(kSubstep, {0, 84}, net.particles);
    }
    // The last node carries a whole cell, half a cell more than a beam's end has.
    const double sag =
        q * std::pow(4.0, 4) / (8 * rigidity) + 0.5 * q * 0.1 * std::pow(4.0, 3) / (3 * rigidity);
    CHECK(-static_cast<double>(net.particles.position[41].x.y) == doctest::Approx(sag).epsilon(0.01));
  }

  TEST_CASE("every instruction set gives the bits of the scalar twin") {
    for (const Real limit : {kRigid, Real(0.02)}) {
      for (const Real stiffness : {Real(50), Real(1e5), kRigid}) {
        check_bits_of_targets(woven(53, 21, stiffness, limit, Real(0.3)), [](Net& net) {
          Yarns yarns = yarns_of(net);
          for_passes(yarns, [&](const YarnPass& pass, parallel::Range blocks) {
            bend_yarns(yarns, pass, blocks, net.particles);
          });
          for_passes(yarns, [&](const YarnPass& pass, parallel::Range blocks) {
            solve_yarns(yarns, pass, blocks, net.particles);
          });
          wide::move(kSubstep, {0, 53 * 21}, net.particles);
        });
      }
    }
  }

  TEST_CASE("yarns keep momentum") {
    Net net = woven(30, 20, Real(1e4), Real(0.05), Real(0.3));
    for (auto& record : net.particles.velocity) {
      if (!(record.inverse_mass > Real(0))) record.inverse_mass = Real(200);
    }
    const auto momentum = [&] {
      DVec3 sum = {};
      for (const auto& record : net.particles.velocity)
        sum = sum + (1 / static_cast<double>(record.inverse_mass)) * vector_cast<double>(record.v);
      return sum;
    };
    const DVec3 before = momentum();
    Yarns yarns = yarns_of(net);
    for_passes(yarns, [&](const YarnPass& pass, parallel::Range blocks) {
      bend_yarns(yarns, pass, blocks, net.particles);
      solve_yarns(yarns, pass, blocks, net.particles);
    });
    CHECK(length(momentum() - before) < 1e-5);  // of 600 nodes of 5 g at 1 m/s
  }
}

}  // namespace hooke::solver
