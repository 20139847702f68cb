#include "solver/soft/spring_solve.h"

#include "base/assert.h"
#include "solver/soft/particle_kernels.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::SpringForm;

/// Solves rows whose direction is predicted or whose damping is isotropic, one at a time, in any build.
///
/// Predicted    d, C at x + h v; the bias then holds h n . v already:
///   lambda = -(b C + (1 - b h) n . dv) / (w + gamma)
/// Isotropic    the transverse relative velocity is damped too:
///   p_t = -dv_t / (w + 1 / (h c))
void solve_general(const SpringBlock& block, int count, const SpringMaterial& material, Real h,
                   const state::PositionRecord* position, state::VelocityRecord* velocity) {
  const bool predicted =
      material.form == SpringForm::kPredicted || material.form == SpringForm::kPredictedIsotropic;
  const bool isotropic =
      material.form == SpringForm::kExplicitIsotropic || material.form == SpringForm::kPredictedIsotropic;
  for (int lane = 0; lane < count; ++lane) {
    const std::uint32_t a = block.record_a[lane] / 4;
    const std::uint32_t b = block.record_b[lane] / 4;
    state::VelocityRecord& record_a = velocity[a];
    state::VelocityRecord& record_b = velocity[b];
    const Vec3 dv = record_a.v - record_b.v;
    const Vec3 d = (position[a].x - position[b].x) + (predicted ? h * dv : Vec3{});
    const Real l = length(d);
    const Real w = record_a.inverse_mass + record_b.inverse_mass;
    if (!(l > Real(0)) || !(w > Real(0))) continue;

    const Vec3 n = (Real(1) / l) * d;
    const Real vn = dot(n, dv);
    const Real rate = predicted ? (Real(1) - material.bias * h) * vn : vn;
    const Real most = material.recovery + material.recovery_time * std::max(vn, Real(0));
    const Real least = material.recovery_time * std::min(vn, Real(0)) - material.recovery;
    const Real error = std::clamp(l - block.rest_length[lane], least, most);
    Vec3 p = (-(rate + material.bias * error) / (w + material.gamma)) * n;
    if (isotropic && material.damping > Real(0)) {
      p -= (Real(1) / (w + Real(1) / (h * material.damping))) * (dv - vn * n);
    }
    record_a.v += record_a.inverse_mass * p;
    record_b.v -= record_b.inverse_mass * p;
  }
}

}  // namespace

void solve_springs(const SpringBlocks& springs, const SpringPass& pass, parallel::Range blocks, Real h,
                   state::Particles& particles) {
  HOOKE_ASSERT(blocks.begin >= pass.first && blocks.end <= pass.end);
  HOOKE_ASSERT(springs.first_particle < particles.position.size());
  const SpringMaterial& material = springs.materials[pass.material];
  const state::PositionRecord* position = particles.position.data() + springs.first_particle;
  state::VelocityRecord* velocity = particles.velocity.data() + springs.first_particle;
  for (int i = blocks.begin; material.form != SpringForm::kExplicit && i < blocks.end; ++i) {
    const int count = i + 1 == pass.end ? pass.last_count : kLanes;
    solve_general(springs.blocks[i], count, material, h, position, velocity);
  }
  if (material.form != SpringForm::kExplicit) return;

  const wide::SpringRun run = {
      .blocks = {springs.blocks.data() + blocks.begin, static_cast<std::size_t>(blocks.count())},
      .last_count = blocks.end == pass.end ? pass.last_count : kLanes};
  wide::solve_springs(run, material, position, velocity);
}

}  // namespace hooke::solver
