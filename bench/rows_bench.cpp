/// Measures one pass over the rows of a 100 x 100 cloth in one thread, for each instruction set of this
/// machine.
///
/// `springs` is scene "cloth": spacing 2 cm, 19 800 structural, 19 602 shear and 19 600 bend springs. `bends`
/// is the same cloth, waved, with an angle at each of its 29 205 inner edges; `hinges` has an isometric bend
/// at each, with the springs that lie there. The report's time is for the whole list; `ns_per_row` divides it
/// by the number of rows, `bytes_per_row` is what the solver reads of each.

#include "cloth_list.h"
#include "solver/soft/bending.h"
#include "solver/soft/isometric_bending.h"
#include "solver/soft/particle_kernels.h"
#include "solver/soft/spring_solve.h"

#include <benchmark/benchmark.h>
#include <string>

namespace {

using namespace hooke;

constexpr Real kSubstep = Real(1) / Real(480);

template <class Blocks>
void count_rows(benchmark::State& state, const Blocks& blocks, int rows) {
  state.counters["ns_per_row"] = benchmark::Counter(
      rows * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["bytes_per_row"] =
      static_cast<double>(blocks.blocks.size() * sizeof(blocks.blocks[0])) / static_cast<double>(rows);
}

void springs(benchmark::State& state) {
  bench::ClothList cloth = bench::cloth_100();
  solver::SpringBlocks blocks;
  solver::build_spring_blocks(bench::owner_of_all(cloth), cloth.springs, cloth.particles, {}, blocks);
  solver::prepare_springs(blocks.materials, kSubstep);
  for (auto _ : state) {
    for (const solver::SpringPass& pass : blocks.passes) {
      solver::solve_springs(blocks, pass, {pass.first, pass.end}, kSubstep, cloth.particles);
    }
    benchmark::ClobberMemory();
  }
  count_rows(state, blocks, cloth.springs.count());
}

void bends(benchmark::State& state) {
  bench::ClothList cloth = bench::cloth_100();
  const state::Bends list = bench::wave_cloth(cloth, false);
  solver::BendBlocks blocks;
  solver::build_bend_blocks(bench::owner_of_all(cloth, list), list, blocks);
  solver::prepare_bends(blocks, kSubstep);
  for (auto _ : state) {
    for (const solver::BendPass& pass : blocks.passes) {
      solver::solve_bends(blocks, pass, {pass.first, pass.end}, cloth.particles);
    }
    benchmark::ClobberMemory();
  }
  count_rows(state, blocks, list.count());
}

void isometric_bends(benchmark::State& state) {
  bench::ClothList cloth = bench::cloth_100();
  const state::Bends list = bench::wave_cloth(cloth, true);
  solver::IsometricBendBlocks blocks;
  solver::TakenRows taken = {std::vector<std::uint8_t>(static_cast<std::size_t>(cloth.springs.count()), 0),
                             std::vector<std::uint8_t>(static_cast<std::size_t>(list.count()), 0)};
  solver::build_isometric_bend_blocks(bench::owner_of_all(cloth, list), list, cloth.springs, taken, blocks);
  solver::prepare_isometric_bends(blocks, kSubstep);
  for (auto _ : state) {
    for (const solver::IsometricBendPass& pass : blocks.passes) {
      solver::solve_isometric_bends(blocks, pass, {pass.first, pass.end}, cloth.particles);
    }
    benchmark::ClobberMemory();
  }
  count_rows(state, blocks, list.count());
}

void add_benchmark(const std::string& name, const std::string& target, void (*run)(benchmark::State&)) {
  benchmark::RegisterBenchmark((name + "/" + target).c_str(), [target, run](benchmark::State& state) {
    solver::wide::use_target(target);
    run(state);
    solver::wide::use_target("");
  });
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string& target : hooke::solver::wide::targets()) {
    add_benchmark("springs", target, springs);
    add_benchmark("bends", target, bends);
    add_benchmark("hinges", target, isometric_bends);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
