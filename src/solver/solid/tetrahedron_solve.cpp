#include "solver/solid/tetrahedron_solve.h"

#include "base/assert.h"
#include "math/symmetric.h"
#include "solver/simd/lane_arrays.h"
#include "solver/solid/tetrahedron_kernels.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace hooke::solver {

namespace {

wide::TetrahedronRun run_of(const TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass,
                            parallel::Range blocks) {
  HOOKE_ASSERT(blocks.begin >= pass.first && blocks.end <= pass.end);
  return {.blocks = {tetrahedra.blocks.data() + blocks.begin, static_cast<std::size_t>(blocks.count())},
          .last_count = blocks.end == pass.end ? pass.last_count : kTetrahedronLanes};
}

/// Bit i: something presses on a corner of lane i.
std::uint8_t find_pressed_lanes(const TetrahedronBlocks& tetrahedra, const TetrahedronBlock& block) {
  std::uint32_t lanes = 0;
  for (int lane = 0; lane < kTetrahedronLanes; ++lane) {
    std::uint32_t pressed = 0;
    for (const auto& record : block.record) pressed |= tetrahedra.pressed_of[record[lane] / 4];
    lanes |= static_cast<std::uint32_t>(pressed != 0) << lane;
  }
  return static_cast<std::uint8_t>(lanes);
}

template <class T, std::size_t kCount>
void copy_lane(const T (&from)[kCount], int lane, T (&to)[kCount], int to_lane) {
  to[to_lane] = from[lane];
}
template <class T, std::size_t kRows, std::size_t kCount>
void copy_lane(const T (&from)[kRows][kCount], int lane, T (&to)[kRows][kCount], int to_lane) {
  for (std::size_t i = 0; i < kRows; ++i) copy_lane(from[i], lane, to[i], to_lane);
}

/// Copies what solutions read of a row.
void copy_row(const TetrahedronBlock& from, int lane, TetrahedronBlock& to, int to_lane) {
  copy_lane(from.record, lane, to.record, to_lane);
  copy_lane(from.b, lane, to.b, to_lane);
  copy_lane(from.gamma_volume, lane, to.gamma_volume, to_lane);
  copy_lane(from.gamma_shape, lane, to.gamma_shape, to_lane);
  copy_lane(from.implicit, lane, to.implicit, to_lane);
}
void copy_row(const TetrahedronImpulses& from, int lane, TetrahedronImpulses& to, int to_lane) {
  copy_lane(from.volume, lane, to.volume, to_lane);
  copy_lane(from.shape, lane, to.shape, to_lane);
}

/// Collects the rows of one color where something presses on a corner, and solves them side by side.
class PressedLot {
 public:
  PressedLot(TetrahedronBlocks& tetrahedra, state::Particles& particles)
      : tetrahedra_(tetrahedra), particles_(particles) {}

  void add(int block, int lane) {
    const int to = lot_.count++;
    const TetrahedronBlock& from = tetrahedra_.blocks[block];
    copy_row(from, lane, lot_.rows, to);
    copy_row(tetrahedra_.impulses[block], lane, lot_.done, to);
    for (int i = 0; i < 4; ++i) put(answer_of(from.record[i][lane] / 4), lot_.answer[i], to);
    block_[to] = block;
    lane_[to] = lane;
    if (lot_.count == kTetrahedronLanes) solve();
  }

  void solve() {
    if (lot_.count == 0) return;
    const int count = lot_.count;
    while (lot_.count < kTetrahedronLanes) copy_last_row();
    lot_.count = count;
    const std::uint32_t first = tetrahedra_.first_particle;
    wide::solve_pressed_tetrahedra(static_cast<double>(tetrahedra_.inverse_h), lot_,
                                   particles_.position.data() + first, particles_.velocity.data() + first);
    for (int i = 0; i < count; ++i) copy_row(lot_.done, i, tetrahedra_.impulses[block_[i]], lane_[i]);
    lot_.count = 0;
  }

 private:
  /// W of a particle, counted from the first one.
  [[nodiscard]] math::Symmetric3<double> answer_of(std::uint32_t particle) const {
    const std::uint32_t of = tetrahedra_.pressed_of[particle];
    if (of != 0) return tetrahedra_.pressed[of - 1].answer;
    const std::uint32_t row = tetrahedra_.first_particle + particle;
    return math::Symmetric3<double>::diagonal(static_cast<double>(particles_.velocity[row].inverse_mass));
  }

  void copy_last_row() {
    const int to = lot_.count++;
    const int from = to - 1;
    copy_row(lot_.rows, from, lot_.rows, to);
    copy_row(lot_.done, from, lot_.done, to);
    for (auto& answer : lot_.answer) copy_lane(answer, from, answer, to);
  }

  TetrahedronBlocks& tetrahedra_;
  state::Particles& particles_;
  wide::PressedTetrahedra lot_;
  int block_[kTetrahedronLanes];
  int lane_[kTetrahedronLanes];
};

/// Solves rows that nothing presses on, then the others: all of them, or the stiff ones again.
void sweep_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                      bool again, state::Particles& particles) {
  wide::TetrahedronRun run = run_of(tetrahedra, pass, blocks);
  run.skipped = tetrahedra.pressed_lanes.data() + blocks.begin;
  run.done = tetrahedra.impulses.data() + blocks.begin;
  run.inverse_h = static_cast<double>(tetrahedra.inverse_h);
  run.again = again;
  wide::solve_free_tetrahedra(run, particles.position.data() + tetrahedra.first_particle,
                              particles.velocity.data() + tetrahedra.first_particle);
  if (tetrahedra.pressed.empty()) return;
  PressedLot lot(tetrahedra, particles);
  for (int i = blocks.begin; i < blocks.end; ++i) {
    if (tetrahedra.pressed_lanes[i] == 0) continue;
    const int count = i + 1 == pass.end ? pass.last_count : kTetrahedronLanes;
    for (int lane = 0; lane < count; ++lane) {
      if (((tetrahedra.pressed_lanes[i] >> lane) & 1) == 0) continue;
      if (!again || tetrahedra.blocks[i].is_stiff(lane)) lot.add(i, lane);
    }
  }
  lot.solve();
}

}  // namespace

void solve_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                      state::Particles& particles) {
  for (int i = blocks.begin; i < blocks.end; ++i) {
    const TetrahedronBlock& block = tetrahedra.blocks[i];
    if (std::any_of(block.implicit, block.implicit + kTetrahedronLanes, [](Real x) { return x > Real(0); }))
      tetrahedra.impulses[i] = {};
    tetrahedra.pressed_lanes[i] = tetrahedra.pressed.empty() ? 0 : find_pressed_lanes(tetrahedra, block);
  }
  sweep_tetrahedra(tetrahedra, pass, blocks, false, particles);
}

void solve_stiff_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass,
                            parallel::Range blocks, state::Particles& particles) {
  sweep_tetrahedra(tetrahedra, pass, blocks, true, particles);
}

void damp_tetrahedra(const TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                     state::Particles& particles) {
  wide::damp_tetrahedra(run_of(tetrahedra, pass, blocks),
                        particles.position.data() + tetrahedra.first_particle,
                        particles.velocity.data() + tetrahedra.first_particle);
}

}  // namespace hooke::solver
