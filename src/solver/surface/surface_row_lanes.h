/// Rows of contacts of surfaces in the Numbers of solver/simd/numbers.h. Included anew for each instruction
/// set.

#if defined(HOOKE_SOLVER_SURFACE_SURFACE_ROW_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SURFACE_SURFACE_ROW_LANES_H
#undef HOOKE_SOLVER_SURFACE_SURFACE_ROW_LANES_H
#else
#define HOOKE_SOLVER_SURFACE_SURFACE_ROW_LANES_H
#endif

#include "solver/simd/numbers.h"
#include "solver/surface/surface_kernels.h"
#include "solver/surface/surface_tuning.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

template <class Number>
HWY_INLINE void prepare_surface_row_blocks(std::span<SurfaceRowBlock> blocks, Real h,
                                           const state::PositionRecord* positions,
                                           const state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  const auto* velocity = reinterpret_cast<const Real*>(velocities);
  const Number zero(Real(0));
  const Number frequency(Real(1) / h);
  for (SurfaceRowBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kLanesOf<Number>) {
      Triple<Number> between = {zero, zero, zero};
      Number w = zero;
      for (int k = 0; k < 4; ++k) {
        const Number weight = get<Number>(block.weight[k] + lane);
        Quad<Number> x, v;
        read_quad(position, block.record[k] + lane, x);
        read_quad(velocity, block.record[k] + lane, v);
        add(weight, Triple<Number>{x.x, x.y, x.z}, between);
        w = w + weight * weight * v.w;
      }
      const Number s = dot(get3<Number>(block.normal, lane), between) - get<Number>(block.distance + lane);
      const Number rate = (zero - s) * frequency;
      const Number recovery = smaller(Number(kSurfaceRecovery) * rate, Number(kSurfaceRecoverySpeed));
      write(choose(above(s, zero), rate, recovery), block.least_speed + lane);
      write(choose(above(w, zero), quotient(Number(Real(1)), w), zero), block.mass + lane);
      write(zero, block.pushed + lane);
      put3(Triple<Number>{zero, zero, zero}, block.rubbed, lane);
    }
  }
}

template <class Number>
HWY_INLINE void solve_surface_row_lanes(SurfaceRowBlock& block, int lane, Real* velocity) {
  const Number zero(Real(0));
  Quad<Number> v[4];
  Triple<Number> relative = {zero, zero, zero};
  for (int k = 0; k < 4; ++k) {
    read_quad(velocity, block.record[k] + lane, v[k]);
    add(get<Number>(block.weight[k] + lane), Triple<Number>{v[k].x, v[k].y, v[k].z}, relative);
  }
  const Triple<Number> n = get3<Number>(block.normal, lane);
  const Number mass = get<Number>(block.mass + lane);
  const Number before = get<Number>(block.pushed + lane);
  const Number speed = dot(n, relative);
  const Number pushed = larger(before + (get<Number>(block.least_speed + lane) - speed) * mass, zero);
  if (!any(above(pushed + before, zero))) return;
  write(pushed, block.pushed + lane);
  Triple<Number> impulse = scaled(pushed - before, n);
  const Triple<Number> sliding = difference(relative, scaled(speed, n));
  const Triple<Number> rubbed = get3<Number>(block.rubbed, lane);
  Triple<Number> wanted = rubbed;
  take(mass, sliding, wanted);
  const Number size = root(dot(wanted, wanted));
  const Number most = get<Number>(block.friction + lane) * pushed;
  const Number share = choose(above(size, most), quotient(most, size), Number(Real(1)));
  wanted = scaled(share, wanted);
  put3(wanted, block.rubbed, lane);
  impulse = sum(impulse, difference(wanted, rubbed));
  for (int k = 0; k < 4; ++k) {
    const Number s = get<Number>(block.weight[k] + lane) * v[k].w;
    write_quad(Quad<Number>{v[k].x + s * impulse.x, v[k].y + s * impulse.y, v[k].z + s * impulse.z, v[k].w},
               velocity, block.record[k] + lane);
  }
}

template <class Number>
HWY_INLINE void solve_surface_row_blocks(std::span<SurfaceRowBlock> blocks,
                                         state::VelocityRecord* velocities) {
  auto* velocity = reinterpret_cast<Real*>(velocities);
  for (SurfaceRowBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kLanesOf<Number>)
      solve_surface_row_lanes<Number>(block, lane, velocity);
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
