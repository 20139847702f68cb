/// Measures one pass over the contacts of a pyramid of 100 rows, in one thread, for each instruction set of
/// this machine.
///
/// 5050 cubes of edge 1 m and 100 kg touch their neighbors in the row and rest on two below. There are 14 950
/// manifolds of four points, in the order of their bodies, and only the solver's part of the step runs.
/// `solve` is the bias pass (normals alone), `relax` normals and friction, `prepare` coloring, rows and warm
/// start, `bodies` the passes over bodies of a substep, `store` the way back. The report's time is for all;
/// `ns_per_contact` divides it by 14 950.

#include "parallel/thread_pool.h"
#include "solver/body/body_motion.h"
#include "solver/contact/body_contacts.h"
#include "solver/soft/particle_kernels.h"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <string>
#include <vector>

namespace {

using namespace hooke;

constexpr int kRows = 100;

struct Pyramid {
  state::Bodies bodies;
  std::vector<std::uint32_t> awake;
  std::vector<state::Manifold> manifolds;
};

std::uint32_t add_body(Pyramid& pyramid, DVec3 center, Real mass) {
  state::Bodies& bodies = pyramid.bodies;
  const auto row = static_cast<std::uint32_t>(bodies.motion.size());
  state::Bodies::for_each_column(bodies, [](auto& column) { column.emplace_back(); });
  bodies.center[row] = center;
  if (!(mass > Real(0))) return row;
  const Real i = mass / Real(6);
  bodies.mass[row] = {.inertia = {i, i, i}, .mass = mass, .inverse_mass = Real(1) / mass};
  bodies.motion[row].inverse_mass = Real(1) / mass;
  bodies.traits[row].kind = BodyKind::kDynamic;
  pyramid.awake.push_back(row);
  return row;
}

/// Adds the face that cube `b` shares with `a`: the square around `center`, of half sizes across the normal
/// n.
void add_contact(Pyramid& pyramid, std::uint32_t a, std::uint32_t b, Vec3 n, Vec3 half) {
  state::Manifold m;
  m.body_a = a;
  m.body_b = b;
  m.normal = n;
  m.point_count = 4;
  m.friction = m.static_friction = Real(0.6);
  const DVec3 to_b = pyramid.bodies.center[b];
  const Vec3 d = vector_cast<Real>(to_b - pyramid.bodies.center[a]);
  // Cubes one above the other are half an edge apart sideways, so that they share half a face.
  const Vec3 middle = a == 0 ? d - Real(0.5) * n : Real(0.5) * d;
  for (int k = 0; k < 4; ++k) {
    const Real u = k % 2 == 0 ? Real(-1) : Real(1);
    const Real v = k / 2 == 0 ? Real(-1) : Real(1);
    const Vec3 corner =
        n.x > Real(0.5) ? Vec3{Real(0), u * half.y, v * half.z} : Vec3{u * half.x, Real(0), v * half.z};
    m.point[k].anchor_a = middle + corner;
    m.point[k].anchor_b = middle + corner - d;
    m.point[k].key = static_cast<std::uint32_t>(k);
  }
  pyramid.manifolds.push_back(m);
}

Pyramid make_pyramid() {
  Pyramid pyramid;
  add_body(pyramid, {}, Real(0));
  constexpr Vec3 kUp = {Real(0), Real(1), Real(0)};
  constexpr Vec3 kAside = {Real(1), Real(0), Real(0)};
  std::uint32_t below = 0;
  for (int i = 0; i < kRows; ++i) {
    std::uint32_t first = 0;
    for (int j = 0; j < kRows - i; ++j) {
      const std::uint32_t cube = add_body(pyramid, {0.5 * i + j, 0.5 + i, 0}, Real(100));
      if (j == 0) first = cube;
      if (i == 0) add_contact(pyramid, 0, cube, kUp, {Real(0.5), Real(0), Real(0.5)});
      for (int side = 0; i > 0 && side < 2; ++side) {
        const auto under = below + static_cast<std::uint32_t>(j + side);
        add_contact(pyramid, under, cube, kUp, {Real(0.25), Real(0), Real(0.5)});
      }
      if (j > 0) add_contact(pyramid, cube - 1, cube, kAside, {Real(0), Real(0.5), Real(0.5)});
    }
    below = first;
  }
  std::stable_sort(pyramid.manifolds.begin(), pyramid.manifolds.end(), [](const auto& a, const auto& b) {
    return a.body_a != b.body_a ? a.body_a < b.body_a : a.body_b < b.body_b;
  });
  return pyramid;
}

/// This is a pyramid at rest after a step of 8 substeps, with what the solver needs to go on.
struct Bench {
  Pyramid pyramid = make_pyramid();
  parallel::ThreadPool pool{1};
  solver::BodyContacts contacts;
  solver::ContactStep step = {.gravity = {Real(0), Real(-9.81), Real(0)}, .h = Real(1) / Real(480)};

  Bench() {
    solver::prepare_bodies(pyramid.awake, pyramid.bodies);
    prepare();
    for (int i = 0; i < 8; ++i) {
      accelerate(i == 0);
      solve();
      solver::move_bodies(pyramid.awake, step.h, pyramid.bodies);
      relax();
    }
  }

  void prepare() { solver::prepare_body_contacts(pool, pyramid.manifolds, pyramid.bodies, step, contacts); }
  void accelerate(bool first) {
    solver::accelerate_bodies(pyramid.awake, {.gravity = step.gravity, .h = step.h, .first = first},
                              pyramid.bodies);
  }
  void solve() {
    for (int c = 0; c < contacts.color_count(); ++c)
      solver::solve_body_contacts({contacts.color_begin[c], contacts.color_begin[c + 1]}, step, contacts,
                                  pyramid.bodies);
  }
  void relax() {
    for (int c = 0; c < contacts.color_count(); ++c)
      solver::relax_body_contacts({contacts.color_begin[c], contacts.color_begin[c + 1]}, step, contacts,
                                  pyramid.bodies);
  }
};

template <class Pass>
void measure(benchmark::State& state, const std::string& target, Pass&& pass) {
  solver::wide::use_target(target);
  Bench bench;
  for (auto _ : state) {
    pass(bench);
    benchmark::ClobberMemory();
  }
  const auto contacts = static_cast<double>(bench.pyramid.manifolds.size());
  state.counters["ns_per_contact"] = benchmark::Counter(
      contacts * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["bytes_per_contact"] = sizeof(solver::ContactBlock) / double{solver::kContactLanes};
  state.counters["colors"] = bench.contacts.color_count();
  solver::wide::use_target("");
}

template <class Pass>
void add(const std::string& name, Pass pass) {
  for (const std::string& target : solver::wide::targets()) {
    benchmark::RegisterBenchmark((name + "/" + target).c_str(),
                                 [target, pass](benchmark::State& state) { measure(state, target, pass); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  add("solve", [](Bench& bench) { bench.solve(); });
  add("relax", [](Bench& bench) { bench.relax(); });
  add("prepare", [](Bench& bench) { bench.prepare(); });
  add("bodies", [](Bench& bench) {
    bench.accelerate(false);
    solver::move_bodies(bench.pyramid.awake, bench.step.h, bench.pyramid.bodies);
  });
  add("store", [](Bench& bench) {
    solver::store_body_contacts({0, static_cast<int>(bench.contacts.blocks.size())}, bench.contacts,
                                bench.pyramid.manifolds);
  });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
