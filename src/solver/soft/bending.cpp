#include "solver/soft/bending.h"

#include "base/assert.h"
#include "base/counting_sort.h"
#include "solver/soft/particle_kernels.h"

#include <algorithm>
#include <numeric>

namespace hooke::solver {

namespace {

/// Copies a row of the table, of an object whose blocks are `of`.
void set_lane(const state::Bends& bends, std::uint32_t row, int lane, BendBlocks& of) {
  BendBlock& block = of.blocks.back();
  BendLaws& laws = of.laws.back();
  const state::Bends::Stencil& s = bends.stencil[row];
  const std::uint32_t ends[4] = {s.edge_a, s.edge_b, s.wing_a, s.wing_b};
  for (int k = 0; k < 4; ++k) block.record[k][lane] = 4 * (ends[k] - of.first_particle);
  block.rest_angle[lane] = bends.rest_angle[row];
  laws.row[lane] = row - of.first_row;
  laws.stiffness[lane] = bends.stiffness[row];
  laws.damping[lane] = bends.damping[row];
}

}  // namespace

void build_bend_blocks(std::span<const state::Deformable> objects, const state::Bends& bends,
                       BendBlocks& blocks) {
  const state::Rows source = rows_of(objects, &state::Deformable::bends);
  const state::Rows particles = rows_of(objects, &state::Deformable::particles);
  blocks = {};
  blocks.first_particle = particles.first;
  blocks.first_row = source.first;
  std::vector<std::uint32_t> rows;
  std::vector<state::Bends::Stencil> stencils;
  for (std::uint32_t row = source.first; row < source.end(); ++row) {
    if (bends.is_isometric(row)) continue;
    rows.push_back(row);
    stencils.push_back(bends.stencil[row]);
  }
  const std::vector<int> color = color_fours<state::Bends::Stencil>(stencils, particles);
  std::vector<std::size_t> order(color.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  base::counting_sort(order, count_colors(color), [&](std::size_t i) { return color[i]; });

  std::size_t i = 0;
  while (i < order.size()) {
    const int head = color[order[i]];
    BendPass pass{.first = static_cast<int>(blocks.blocks.size())};
    while (i < order.size() && color[order[i]] == head) {
      blocks.blocks.emplace_back();
      blocks.laws.emplace_back();
      pass.last_count = 0;
      for (int lane = 0; lane < kLanes; ++lane) {
        const bool more = i < order.size() && color[order[i]] == head;
        set_lane(bends, rows[order[more ? i++ : i - 1]], lane, blocks);
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
  HOOKE_ASSERT(bends.first_particle < particles.position.size());
  wide::solve_bends(run, particles.position.data() + bends.first_particle,
                    particles.velocity.data() + bends.first_particle);
}

}  // namespace hooke::solver
