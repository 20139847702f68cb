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

void solve_free_here(const TetrahedronRun& run, const state::PositionRecord* position,
                     state::VelocityRecord* velocity) {
  solve_free_tetrahedron_blocks<TetrahedronNumber>(run, position, velocity);
}

void solve_pressed_here(double inverse_h, PressedTetrahedra& rows, const state::PositionRecord* position,
                        state::VelocityRecord* velocity) {
  solve_pressed_tetrahedron_rows<TetrahedronNumber>(inverse_h, rows, position, velocity);
}

void damp_here(const TetrahedronRun& run, const state::PositionRecord* position,
               state::VelocityRecord* velocity) {
  damp_tetrahedron_blocks<TetrahedronNumber>(run, position, velocity);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hooke::solver::wide {

HWY_EXPORT(solve_free_here);
HWY_EXPORT(solve_pressed_here);
HWY_EXPORT(damp_here);

void solve_free_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                           state::VelocityRecord* velocity) {
  if (is_scalar()) return solve_free_tetrahedra_scalar(run, position, velocity);
  HWY_DYNAMIC_DISPATCH(solve_free_here)(run, position, velocity);
}

void solve_pressed_tetrahedra(double inverse_h, PressedTetrahedra& rows,
                              const state::PositionRecord* position, state::VelocityRecord* velocity) {
  if (is_scalar()) return solve_pressed_tetrahedra_scalar(inverse_h, rows, position, velocity);
  HWY_DYNAMIC_DISPATCH(solve_pressed_here)(inverse_h, rows, position, velocity);
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

void solve_free_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                           state::VelocityRecord* velocity) {
  solve_free_tetrahedra_scalar(run, position, velocity);
}

void solve_pressed_tetrahedra(double inverse_h, PressedTetrahedra& rows,
                              const state::PositionRecord* position, state::VelocityRecord* velocity) {
  solve_pressed_tetrahedra_scalar(inverse_h, rows, position, velocity);
}

void damp_tetrahedra(const TetrahedronRun& run, const state::PositionRecord* position,
                     state::VelocityRecord* velocity) {
  damp_tetrahedra_scalar(run, position, velocity);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
