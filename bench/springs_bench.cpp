/// One pass over the springs of a 100 x 100 cloth, one thread, for each instruction set of this machine.
///
/// The list is scene "cloth": spacing 2 cm, 19 800 structural, 19 602 shear and 19 600 bend springs. The
/// report's time is for the whole list; `ns_per_spring` divides it by 59 002. Counters `bytes_per_spring` and
/// `bytes_per_particle` are what the solver reads.

#include "cloth_list.h"
#include "solver/springs.h"
#include "solver/wide/wide.h"

#include <benchmark/benchmark.h>
#include <string>

namespace {

using namespace hooke;

void spring_pass(benchmark::State& state, const std::string& target) {
  bench::ClothList cloth = bench::cloth_100();
  solver::SpringBlocks blocks;
  solver::build_spring_blocks(cloth.springs, cloth.particles, blocks);
  constexpr Real kSubstep = Real(1) / Real(480);
  solver::prepare_springs(blocks, kSubstep);
  solver::wide::use_target(target);
  for (auto _ : state) {
    for (const solver::SpringPass& pass : blocks.passes) {
      solver::solve_springs(blocks, pass, {pass.first, pass.end}, kSubstep, cloth.particles);
    }
    benchmark::ClobberMemory();
  }
  const auto springs = static_cast<double>(cloth.springs.count());
  state.counters["ns_per_spring"] = benchmark::Counter(
      springs * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["bytes_per_spring"] =
      static_cast<double>(blocks.blocks.size() * sizeof(solver::SpringBlock)) / springs;
  state.counters["bytes_per_particle"] = sizeof(state::PositionLine) + sizeof(state::VelocityLine);
  solver::wide::use_target("");
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string& target : hooke::solver::wide::targets()) {
    benchmark::RegisterBenchmark(("cloth_springs/" + target).c_str(),
                                 [target](benchmark::State& state) { spring_pass(state, target); });
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
