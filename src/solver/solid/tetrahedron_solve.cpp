#include "solver/solid/tetrahedron_solve.h"

#include "base/assert.h"
#include "solver/solid/tetrahedron_kernels.h"

#include <cstddef>

namespace hooke::solver {

namespace {

wide::TetrahedronRun run_of(const TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass,
                            parallel::Range blocks) {
  HOOKE_ASSERT(blocks.begin >= pass.first && blocks.end <= pass.end);
  return {.blocks = {tetrahedra.blocks.data() + blocks.begin, static_cast<std::size_t>(blocks.count())},
          .last_count = blocks.end == pass.end ? pass.last_count : kTetrahedronLanes,
          .inverse_h = static_cast<double>(tetrahedra.inverse_h)};
}

}  // namespace

void solve_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                      state::Particles& particles) {
  wide::solve_tetrahedra(run_of(tetrahedra, pass, blocks),
                         particles.position.data() + tetrahedra.first_particle,
                         particles.velocity.data() + tetrahedra.first_particle);
}

void linearize_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                          state::Particles& particles) {
  wide::TetrahedronRun run = run_of(tetrahedra, pass, blocks);
  run.stress = tetrahedra.stiff.stress.data() + blocks.begin;
  run.force = tetrahedra.stiff.force.data();
  run.diagonal = tetrahedra.stiff.diagonal.data();
  wide::linearize_tetrahedra(run, particles.position.data() + tetrahedra.first_particle,
                             particles.velocity.data() + tetrahedra.first_particle);
}

void resist_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                       state::Particles& /*particles*/) {
  wide::TetrahedronRun run = run_of(tetrahedra, pass, blocks);
  run.stress = tetrahedra.stiff.stress.data() + blocks.begin;
  run.direction = tetrahedra.stiff.direction.data();
  run.image = tetrahedra.stiff.image.data();
  wide::resist_tetrahedra(run);
}

void damp_tetrahedra(const TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                     state::Particles& particles) {
  wide::damp_tetrahedra(run_of(tetrahedra, pass, blocks),
                        particles.position.data() + tetrahedra.first_particle,
                        particles.velocity.data() + tetrahedra.first_particle);
}

}  // namespace hooke::solver
