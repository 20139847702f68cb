/// Symmetric matrices in the Numbers of solver/simd/numbers.h. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SIMD_SYMMETRIC_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SIMD_SYMMETRIC_LANES_H
#undef HOOKE_SOLVER_SIMD_SYMMETRIC_LANES_H
#else
#define HOOKE_SOLVER_SIMD_SYMMETRIC_LANES_H
#endif

#include "solver/simd/numbers.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

template <class Number>
HWY_INLINE Scale<Number> diagonal(Number s) {
  const Number zero(0.0);
  return {s, zero, zero, s, zero, s};
}
template <class Number>
HWY_INLINE Scale<Number> sum(const Scale<Number>& a, const Scale<Number>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
template <class Number>
HWY_INLINE Scale<Number> scaled(Number s, const Scale<Number>& a) {
  return {s * a.xx, s * a.xy, s * a.xz, s * a.yy, s * a.yz, s * a.zz};
}
template <class Number>
HWY_INLINE Scale<Number> cofactors(const Scale<Number>& m) {
  return {m.yy * m.zz - m.yz * m.yz, m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy,
          m.xx * m.zz - m.xz * m.xz, m.xy * m.xz - m.xx * m.yz, m.xx * m.yy - m.xy * m.xy};
}
template <class Number>
HWY_INLINE Number determinant(const Scale<Number>& m, const Scale<Number>& cofactors) {
  return m.xx * cofactors.xx + m.xy * cofactors.xy + m.xz * cofactors.xz;
}
/// Inverts by cofactors as math::inverse does, which is not compiled for the instruction set.
template <class Number>
HWY_INLINE Scale<Number> inverse(const Scale<Number>& m) {
  const Scale<Number> a = cofactors(m);
  return scaled(quotient(Number(1.0), determinant(m, a)), a);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
