/// Tetrahedra in double over lanes, then the dispatch. The arithmetic stands in
/// solver/solid/tetrahedron_rows.h.

#include "solver/solid/tetrahedron_kernels.h"

#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/solid/tetrahedron_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Included after Highway, which includes this file again for each instruction set. Numbers come before what
// uses them.
// clang-format off
#include "solver/simd/double_vectors.h"
#include "solver/simd/double_records.h"
#include "solver/solid/tetrahedron_corners.h"
#include "solver/solid/tetrahedron_rows.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
using TetrahedronNumber = double;
#else
using TetrahedronNumber = WideDouble;
#endif

void solve_here(const TetrahedronRun& run, const state::PositionRecord* position,
                state::VelocityRecord* velocity) {
  solve_tetrahedron_blocks<TetrahedronNumber>(run, position, velocity);
}

void linearize_here(const TetrahedronRun& run, const state::PositionRecord* position,
                    const state::VelocityRecord* velocity) {
  linearize_tetrahedron_blocks<TetrahedronNumber>(run, position, velocity);
}

void resist_here(const TetrahedronRun& run) {
  resist_tetrahedron_blocks<TetrahedronNumber>(run);
}

void damp_here(const TetrahedronRun& run, const state::PositionRecord* position,
               state::VelocityRecord* velocity) {
  damp_tetrahedron_blocks<TetrahedronNumber>(run, position, velocity);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(solve_here);
HWY_EXPORT(linearize_here);
HWY_EXPORT(resist_here);
HWY_EXPORT(damp_here);

void solve_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                      state::VelocityRecord* velocity) {
  if (is_scalar()) return solve_tetrahedra_scalar(run, position, velocity);
  HWY_DYNAMIC_DISPATCH(solve_here)(run, position, velocity);
}

void linearize_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                          const state::VelocityRecord* velocity) {
  if (is_scalar()) return linearize_tetrahedra_scalar(run, position, velocity);
  HWY_DYNAMIC_DISPATCH(linearize_here)(run, position, velocity);
}

void resist_tetrahedra(const TetrahedronRun& run) {
  if (is_scalar()) return resist_tetrahedra_scalar(run);
  HWY_DYNAMIC_DISPATCH(resist_here)(run);
}

void damp_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                     state::VelocityRecord* velocity) {
  if (is_scalar()) return damp_tetrahedra_scalar(run, position, velocity);
  HWY_DYNAMIC_DISPATCH(damp_here)(run, position, velocity);
}

}  // namespace hooke::solver::wide
#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void solve_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                      state::VelocityRecord* velocity) {
  solve_tetrahedra_scalar(run, position, velocity);
}

void linearize_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                          const state::VelocityRecord* velocity) {
  linearize_tetrahedra_scalar(run, position, velocity);
}

void resist_tetrahedra(const TetrahedronRun& run) {
  resist_tetrahedra_scalar(run);
}

void damp_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                     state::VelocityRecord* velocity) {
  damp_tetrahedra_scalar(run, position, velocity);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
