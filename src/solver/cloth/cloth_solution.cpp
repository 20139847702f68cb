#include "solver/cloth/cloth_solution.h"

#include "base/assert.h"
#include "solver/cloth/cloth_tuning.h"

#include <algorithm>
#include <utility>

namespace hooke::solver {

namespace {

using wide::GridJob;
using wide::GridWork;

constexpr int kChunk = 16;  ///< Blocks of one sum.

/// The passes of one solution.
class Passes {
 public:
  Passes(GridThreads threads, ClothSolution& solution) : threads_(threads), solution_(solution) {}

  /// Does a pass over all blocks of a grid; returns its sum in the order of chunks and lanes.
  double run(GridJob job, bool has_sum = false) {
    const int chunks = (job.grid->blocks() + kChunk - 1) / kChunk;
    if (has_sum) solution_.sums.assign(static_cast<std::size_t>(chunks), PointLanes{});
    const auto run_chunks = [&](parallel::Range range) {
      for (int chunk = range.begin; chunk < range.end; ++chunk) {
        GridJob part = job;
        part.blocks = {chunk * kChunk, std::min((chunk + 1) * kChunk, job.grid->blocks())};
        if (has_sum) part.sums = &solution_.sums[static_cast<std::size_t>(chunk)];
        wide::run(part);
      }
    };
    if (threads_.pool == nullptr) {
      run_chunks({0, chunks});
    } else {
      parallel::for_ranges(*threads_.pool, chunks, 2, run_chunks);
    }
    double sum = 0;
    if (!has_sum) return sum;
    for (const PointLanes& lanes : solution_.sums) {
      for (const Real lane : lanes.of) sum += static_cast<double>(lane);
    }
    return sum;
  }

  /// Finds by grids what the residual of the finest asks for, in its `velocity`, and returns its product with
  /// the residual.
  double precondition() {
    std::vector<ClothGrid>& grids = solution_.grids.grids;
    for (std::size_t i = 0; i + 1 < grids.size(); ++i) {
      ClothGrid& grid = grids[i];
      run({.work = GridWork::kBegin,
           .grid = &grid,
           .residual = grid.residual.data(),
           .to = grid.velocity.data()});
      run({.work = GridWork::kLeave,
           .grid = &grid,
           .from = grid.velocity.data(),
           .residual = grid.residual.data(),
           .to = grid.scratch.data()});
      gather(grid, grids[i + 1]);
    }
    smooth_coarsest(grids.back());
    double size = 0;
    for (std::size_t i = grids.size() - 1; i-- > 0;) {
      ClothGrid& grid = grids[i];
      spread(grids[i + 1], grid);
      size = smooth(grid, i == 0);
    }
    return grids.size() > 1 ? size : product(grids[0].residual, grids[0].velocity);
  }

 private:
  double smooth(ClothGrid& grid, bool has_sum) {
    const double sum = run({.work = GridWork::kSmooth,
                            .grid = &grid,
                            .from = grid.velocity.data(),
                            .residual = grid.residual.data(),
                            .to = grid.scratch.data()},
                           has_sum);
    std::swap(grid.velocity, grid.scratch);
    return sum;
  }

  void smooth_coarsest(ClothGrid& grid) {
    run({.work = GridWork::kBegin,
         .grid = &grid,
         .residual = grid.residual.data(),
         .to = grid.velocity.data()});
    for (int sweep = 1; sweep < kCoarsestSweeps; ++sweep) smooth(grid, false);
  }

  static double product(const std::vector<PointVector>& a, const std::vector<PointVector>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(dot(a[i].of, b[i].of));
    return sum;
  }

  /// Sums what is left on a grid for the cells of the next one.
  static void gather(const ClothGrid& grid, ClothGrid& coarser) {
    for (std::uint32_t cell = 0; cell < coarser.count; ++cell) {
      Real sum[4] = {};
      for (std::uint32_t m = grid.first_member[cell]; m < grid.first_member[cell + 1]; ++m) {
        const auto* from = reinterpret_cast<const Real*>(&grid.scratch[grid.member[m]]);
        for (std::size_t k = 0; k < 4; ++k) sum[k] += from[k];
      }
      std::copy(sum, sum + 4, reinterpret_cast<Real*>(&coarser.residual[cell]));
    }
  }

  static void spread(const ClothGrid& coarser, ClothGrid& grid) {
    for (std::uint32_t point = 0; point < grid.count; ++point) {
      if (grid.cell[point] == ClothGrid::kNone) continue;
      const auto* from = reinterpret_cast<const Real*>(&coarser.velocity[grid.cell[point]]);
      auto* to = reinterpret_cast<Real*>(&grid.velocity[point]);
      for (std::size_t k = 0; k < 4; ++k) to[k] += from[k];
    }
  }

  GridThreads threads_;
  ClothSolution& solution_;
};

/// to += share * from
void add(Real share, const std::vector<PointVector>& from, std::vector<PointVector>& to) {
  const auto* a = reinterpret_cast<const Real*>(from.data());
  auto* b = reinterpret_cast<Real*>(to.data());
  for (std::size_t i = 0; i < 4 * to.size(); ++i) b[i] += share * a[i];
}

/// to = from + share * to
void turn(Real share, const std::vector<PointVector>& from, std::vector<PointVector>& to) {
  const auto* a = reinterpret_cast<const Real*>(from.data());
  auto* b = reinterpret_cast<Real*>(to.data());
  for (std::size_t i = 0; i < 4 * to.size(); ++i) b[i] = a[i] + share * b[i];
}

/// Finds B of the finest grid and the impulse of the rows for the velocities of particles, with limits as the
/// change so far wants them. Returns how many limits are otherwise than before, counted from both ends.
double linearize(Passes& passes, Real h, const state::Particles& particles, ClothSolution& solution) {
  ClothGrid& grid = solution.grids.finest();
  return passes.run({.work = GridWork::kLinearize,
                     .grid = &grid,
                     .to = solution.force.data(),
                     .rows = solution.grids.rows.data(),
                     .guess = solution.change.data(),
                     .position = particles.position.data() + solution.grids.first_particle,
                     .velocity = particles.velocity.data() + solution.grids.first_particle,
                     .h = h},
                    true);
}

void prepare_grids(Passes& passes, ClothSolution& solution) {
  std::vector<ClothGrid>& grids = solution.grids.grids;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    if (i > 0) coarsen_rows(grids[i - 1], grids[i]);
    passes.run({.work = GridWork::kInvert, .grid = &grids[i]});
  }
}

/// Goes along `direction` as far as lowers the energy most, if the product of the direction with the residual
/// is `size`. Returns false if nothing resists it.
bool advance(Passes& passes, double size, ClothSolution& solution) {
  ClothGrid& grid = solution.grids.finest();
  const double curvature = passes.run({.work = GridWork::kResist,
                                       .grid = &grid,
                                       .from = solution.direction.data(),
                                       .to = solution.image.data()},
                                      true);
  if (!(curvature > 0)) return false;
  const auto share = static_cast<Real>(size / curvature);
  add(share, solution.direction, solution.change);
  add(-share, solution.image, grid.residual);
  return true;
}

/// Begins with the change of the substep before.
void begin_with_last(Passes& passes, ClothSolution& solution) {
  ClothGrid& grid = solution.grids.finest();
  std::swap(solution.direction, solution.change);
  std::fill(solution.change.begin(), solution.change.end(), PointVector{});
  double size = 0;
  for (std::size_t i = 0; i < grid.residual.size(); ++i)
    size += static_cast<double>(dot(solution.direction[i].of, grid.residual[i].of));
  if (size != 0) advance(passes, size, solution);
}

/// Begins again with the change so far, after limits have changed.
void begin_again(Passes& passes, ClothSolution& solution) {
  ClothGrid& grid = solution.grids.finest();
  passes.run({.work = GridWork::kResist,
              .grid = &grid,
              .from = solution.change.data(),
              .to = solution.image.data()});
  grid.residual = solution.force;
  add(Real(-1), solution.image, grid.residual);
}

/// What the solution may lack in the end, in the norm of energy [J].
double allowed_error(Real h, const ClothSolution& solution) {
  double mass = 0;
  for (const PointLanes& lanes : solution.grids.grids.front().mass) {
    for (const Real lane : lanes.of) mass += static_cast<double>(lane);
  }
  const double speed = kClothError * static_cast<double>(solution.grids.edge / h);
  return mass * speed * speed;
}

/// Goes along conjugate directions until the change is exact enough.
void find_change(Passes& passes, double enough, ClothSolution& solution) {
  ClothGrid& grid = solution.grids.finest();
  double size = 0;
  for (int directions = 0;; ++directions) {
    const double next = passes.precondition();
    if (!(next > enough)) return;
    if (directions == kMostClothDirections) break;
    turn(static_cast<Real>(directions == 0 ? 0 : next / size), grid.velocity, solution.direction);
    size = next;
    ++solution.directions;
    if (!advance(passes, size, solution)) return;
  }
  solution.unconverged = true;
}

}  // namespace

void build_cloth_solution(const state::Deformable& object, const state::Springs& springs,
                          const state::Particles& particles, ClothSolution& solution) {
  build_cloth_grids(object, springs, particles, solution.grids);
  const std::size_t size = solution.grids.finest().residual.size();
  for (auto* vectors : {&solution.change, &solution.direction, &solution.image, &solution.force})
    vectors->assign(size, {});
  solution.is_active = true;
}

void solve_cloth(GridThreads threads, Real h, state::Deformable& object, state::Particles& particles,
                 ClothSolution& solution) {
  ClothGrid& grid = solution.grids.finest();
  Passes passes(threads, solution);
  HOOKE_ASSERT(object.particles.first == solution.grids.first_particle);
  HOOKE_ASSERT(object.stretch.change.size() == object.particles.count);
  for (std::uint32_t i = 0; i < object.particles.count; ++i) solution.change[i].of = object.stretch.change[i];
  take_masses(particles, object.particles.first, grid);
  linearize(passes, h, particles, solution);
  prepare_grids(passes, solution);
  grid.residual = solution.force;
  begin_with_last(passes, solution);
  const double enough = allowed_error(h, solution);
  find_change(passes, enough, solution);
  for (int round = 1; solution.grids.has_limits && round < kMostClothRounds; ++round) {
    if (linearize(passes, h, particles, solution) == 0) break;
    prepare_grids(passes, solution);
    begin_again(passes, solution);
    find_change(passes, enough, solution);
  }
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    particles.velocity[object.particles.first + i].v += solution.change[i].of;
    object.stretch.change[i] = solution.change[i].of;
  }
}

}  // namespace hooke::solver
