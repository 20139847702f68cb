#include "solver/soft/bending.h"

#include "base/assert.h"
#include "solver/soft/particle_kernels.h"

#include <algorithm>
#include <numeric>

namespace hooke::solver {

namespace {

void set_lane(const state::Bends& bends, std::size_t row, int lane, BendBlock& block, BendLaws& laws) {
  const state::Bends::Stencil& s = bends.stencil[row];
  const std::uint32_t ends[4] = {s.edge_a, s.edge_b, s.wing_a, s.wing_b};
  for (int k = 0; k < 4; ++k) block.record[k][lane] = 4 * ends[k];
  block.rest_angle[lane] = bends.rest_angle[row];
  laws.row[lane] = static_cast<std::uint32_t>(row);
  laws.stiffness[lane] = bends.stiffness[row];
  laws.damping[lane] = bends.damping[row];
}

}  // namespace

void build_bend_blocks(const state::Bends& bends, int particle_count, BendBlocks& blocks) {
  blocks = {};
  std::vector<std::size_t> rows;
  std::vector<state::Bends::Stencil> stencils;
  for (std::size_t row = 0; row < bends.stencil.size(); ++row) {
    if (bends.is_isometric(row)) continue;
    rows.push_back(row);
    stencils.push_back(bends.stencil[row]);
  }
  const std::vector<int> color = color_fours(stencils, particle_count);
  std::vector<std::size_t> order(color.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return color[a] < color[b]; });

  std::size_t i = 0;
  while (i < order.size()) {
    const int head = color[order[i]];
    BendPass pass{.first = static_cast<int>(blocks.blocks.size())};
    while (i < order.size() && color[order[i]] == head) {
      BendBlock& block = blocks.blocks.emplace_back();
      BendLaws& laws = blocks.laws.emplace_back();
      pass.last_count = 0;
      for (int lane = 0; lane < kLanes; ++lane) {
        const bool more = i < order.size() && color[order[i]] == head;
        set_lane(bends, rows[order[more ? i++ : i - 1]], lane, block, laws);
        if (more) ++pass.last_count;
      }
    }
    pass.end = static_cast<int>(blocks.blocks.size());
    blocks.passes.push_back(pass);
  }
}

void prepare_bends(BendBlocks& bends, Real h) {
  HOOKE_ASSERT(bends.laws.size() == bends.blocks.size());
  for (std::size_t i = 0; i < bends.blocks.size(); ++i) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const Softness soft = softness(bends.laws[i].stiffness[lane], bends.laws[i].damping[lane], h);
      bends.blocks[i].bias[lane] = soft.bias;
      bends.blocks[i].gamma[lane] = soft.gamma;
    }
  }
}

void solve_bends(const BendBlocks& bends, const BendPass& pass, parallel::Range blocks,
                 state::Particles& particles) {
  HOOKE_ASSERT(blocks.begin >= pass.first && blocks.end <= pass.end);
  const wide::BendRun run = {
      .blocks = {bends.blocks.data() + blocks.begin, static_cast<std::size_t>(blocks.count())},
      .last_count = blocks.end == pass.end ? pass.last_count : kLanes};
  wide::solve_bends(run, particles.position.data(), particles.velocity.data());
}

}  // namespace hooke::solver
