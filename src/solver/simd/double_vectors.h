/// Vectors of double as the Numbers of solver/simd/numbers.h. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SIMD_DOUBLE_VECTORS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SIMD_DOUBLE_VECTORS_H
#undef HOOKE_SOLVER_SIMD_DOUBLE_VECTORS_H
#else
#define HOOKE_SOLVER_SIMD_DOUBLE_VECTORS_H
#endif

#include "solver/simd/lanes.h"
#include "solver/simd/numbers.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

using DoubleLanes = hn::CappedTag<double, kDoubleLanes>;
constexpr DoubleLanes kDoubleTag;

struct WideDouble {
  hn::Vec<DoubleLanes> raw;

  WideDouble() = default;
  HWY_INLINE explicit WideDouble(double x) : raw(hn::Set(kDoubleTag, x)) {}
  HWY_INLINE explicit WideDouble(hn::Vec<DoubleLanes> v) : raw(v) {}

  friend HWY_INLINE WideDouble operator+(const WideDouble& a, const WideDouble& b) {
    return WideDouble(hn::Add(a.raw, b.raw));
  }
  friend HWY_INLINE WideDouble operator-(const WideDouble& a, const WideDouble& b) {
    return WideDouble(hn::Sub(a.raw, b.raw));
  }
  friend HWY_INLINE WideDouble operator*(const WideDouble& a, const WideDouble& b) {
    return WideDouble(hn::Mul(a.raw, b.raw));
  }
};

using DoubleMask = hn::Mask<DoubleLanes>;

HWY_INLINE void read(const double* from, WideDouble& to) {
  to.raw = hn::LoadU(kDoubleTag, from);
}
HWY_INLINE void write(const WideDouble& value, double* to) {
  hn::StoreU(value.raw, kDoubleTag, to);
}
HWY_INLINE DoubleMask above(const WideDouble& a, const WideDouble& b) {
  return hn::Gt(a.raw, b.raw);
}
HWY_INLINE bool any(DoubleMask condition) {
  return !hn::AllFalse(kDoubleTag, condition);
}
HWY_INLINE WideDouble choose(DoubleMask condition, const WideDouble& yes, const WideDouble& no) {
  return WideDouble(hn::IfThenElse(condition, yes.raw, no.raw));
}
HWY_INLINE WideDouble quotient(const WideDouble& a, const WideDouble& b) {
  return WideDouble(hn::Div(a.raw, b.raw));
}
HWY_INLINE WideDouble root(const WideDouble& a) {
  return WideDouble(hn::Sqrt(a.raw));
}

template <>
inline constexpr int kLanesOf<WideDouble> = hn::MaxLanes(DoubleLanes());

#endif

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
