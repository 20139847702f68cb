#pragma once

#include "solver/soft/spring_blocks.h"
#include "state/objects.h"
#include "state/tetrahedra.h"

#include <cstddef>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <vector>

namespace hooke::solver {

/// One object that owns all rows of the tables.
inline std::vector<state::Deformable> owner_of_all(const state::Particles& particles,
                                                   const state::Springs& springs, const state::Bends& bends,
                                                   const state::Tetrahedra& tetrahedra = {}) {
  const auto all = [](int count) { return state::Rows{0, static_cast<std::uint32_t>(count)}; };
  return {{.particles = {0, static_cast<std::uint32_t>(particles.position.size())},
           .springs = all(springs.count()),
           .bends = all(bends.count()),
           .tetrahedra = all(tetrahedra.count())}};
}

/// Appends a spring without damping.
inline void append_spring(std::uint32_t a, std::uint32_t b, state::SpringClass kind, Real rest_length,
                          Real stiffness, state::Springs& springs) {
  springs.particle_a.push_back(a);
  springs.particle_b.push_back(b);
  springs.rest_length.push_back(rest_length);
  springs.stiffness.push_back(stiffness);
  springs.damping.push_back(Real(0));
  springs.damped_mass.push_back(std::numeric_limits<Real>::infinity());
  springs.kind.push_back(kind);
  springs.form.push_back(state::SpringForm::kExplicit);
}

/// Checks that no two rows of one pass share a particle. Returns the number of rows in `blocks` over four
/// particles each.
template <class Blocks>
std::size_t count_rows_apart(const Blocks& blocks, std::size_t particles) {
  std::size_t rows = 0;
  for (const auto& pass : blocks.passes) {
    std::vector<int> uses(particles, 0);
    for (int i = pass.first; i < pass.end; ++i) {
      const int count = i + 1 == pass.end ? pass.last_count : kLanes;
      rows += static_cast<std::size_t>(count);
      for (int lane = 0; lane < count; ++lane) {
        for (const auto& record : blocks.blocks[i].record) CHECK(++uses[record[lane] / 4] == 1);
      }
    }
  }
  return rows;
}

}  // namespace hooke::solver
