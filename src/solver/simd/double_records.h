/// Records of four numbers of the state as Numbers in double, and back. Included anew for each instruction
/// set.

#if defined(HOOKE_SOLVER_SIMD_DOUBLE_RECORDS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SIMD_DOUBLE_RECORDS_H
#undef HOOKE_SOLVER_SIMD_DOUBLE_RECORDS_H
#else
#define HOOKE_SOLVER_SIMD_DOUBLE_RECORDS_H
#endif

#include "solver/simd/double_vectors.h"
#include "solver/simd/numbers.h"
#include "solver/simd/records.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

HWY_INLINE void read_widened(const Real* from, double& to) {
  to = static_cast<double>(*from);
}
HWY_INLINE void read_quad_widened(const Real* base, const std::uint32_t* record, Quad<double>& q) {
  const Real* from = base + *record;
  q = {static_cast<double>(from[0]), static_cast<double>(from[1]), static_cast<double>(from[2]),
       static_cast<double>(from[3])};
}
HWY_INLINE void write_quad_narrowed(const Quad<double>& q, Real* base, const std::uint32_t* record) {
  Real* to = base + *record;
  to[0] = static_cast<Real>(q.x);
  to[1] = static_cast<Real>(q.y);
  to[2] = static_cast<Real>(q.z);
  to[3] = static_cast<Real>(q.w);
}

HWY_INLINE void read_triple(const double* base, const std::uint32_t* record, Triple<double>& v) {
  const double* from = base + *record;
  v = {from[0], from[1], from[2]};
}
HWY_INLINE void add_triple(const Triple<double>& v, double* base, const std::uint32_t* record) {
  double* to = base + *record;
  to[0] += v.x;
  to[1] += v.y;
  to[2] += v.z;
}

#if HWY_TARGET != HWY_SCALAR

/// As many floats as a vector has doubles.
using SingleLanes = hn::Rebind<float, DoubleLanes>;
constexpr SingleLanes kSingleTag;

HWY_INLINE WideDouble widened(hn::Vec<SingleLanes> v) {
  return WideDouble(hn::PromoteTo(kDoubleTag, v));
}
HWY_INLINE hn::Vec<SingleLanes> narrowed(const WideDouble& x) {
  return hn::DemoteTo(kSingleTag, x.raw);
}

HWY_INLINE void read_widened(const float* from, WideDouble& to) {
  to = widened(hn::LoadU(kSingleTag, from));
}
template <class D>
HWY_INLINE Quad<WideDouble> load_widened(D tag, const float* base, const std::uint32_t* record) {
  if constexpr (hn::MaxLanes(D()) >= 4) {
    auto x = load_records(tag, base, record);
    auto y = load_records(tag, base, record + 1);
    auto z = load_records(tag, base, record + 2);
    auto w = load_records(tag, base, record + 3);
    transpose(tag, x, y, z, w);
    return {widened(x), widened(y), widened(z), widened(w)};
  } else {
    constexpr Line kLine;
    const auto a = hn::LoadU(kLine, base + record[0]);
    const auto b = hn::LoadU(kLine, base + record[1]);
    const auto x_y = hn::InterleaveLower(kLine, a, b);
    const auto z_w = hn::InterleaveUpper(kLine, a, b);
    return {widened(hn::LowerHalf(tag, x_y)), widened(hn::UpperHalf(tag, x_y)),
            widened(hn::LowerHalf(tag, z_w)), widened(hn::UpperHalf(tag, z_w))};
  }
}
template <class D>
HWY_INLINE void store_narrowed(D tag, const Quad<WideDouble>& q, float* base, const std::uint32_t* record) {
  hn::Vec<D> x = narrowed(q.x), y = narrowed(q.y), z = narrowed(q.z), w = narrowed(q.w);
  if constexpr (hn::MaxLanes(D()) >= 4) {
    transpose(tag, x, y, z, w);
    store_records(tag, x, base, record);
    store_records(tag, y, base, record + 1);
    store_records(tag, z, base, record + 2);
    store_records(tag, w, base, record + 3);
  } else {
    constexpr Line kLine;
    const auto x_y = hn::Combine(kLine, y, x);
    const auto z_w = hn::Combine(kLine, w, z);
    hn::Store(hn::ConcatEven(kLine, z_w, x_y), kLine, base + record[0]);
    hn::Store(hn::ConcatOdd(kLine, z_w, x_y), kLine, base + record[1]);
  }
}

HWY_INLINE void read_quad_widened(const float* base, const std::uint32_t* record, Quad<WideDouble>& q) {
  q = load_widened(kSingleTag, base, record);
}
HWY_INLINE void write_quad_narrowed(const Quad<WideDouble>& q, float* base, const std::uint32_t* record) {
  store_narrowed(kSingleTag, q, base, record);
}

/// As many indices of 64 bits as a vector has doubles.
using IndexLanes = hn::RebindToSigned<DoubleLanes>;
constexpr IndexLanes kIndexTag;

HWY_INLINE hn::Vec<IndexLanes> indices_of(const std::uint32_t* record) {
  constexpr hn::Rebind<std::uint32_t, IndexLanes> kRecordTag;
  return hn::BitCast(kIndexTag,
                     hn::PromoteTo(hn::RebindToUnsigned<IndexLanes>(), hn::LoadU(kRecordTag, record)));
}
HWY_INLINE void read_triple(const double* base, const std::uint32_t* record, Triple<WideDouble>& v) {
  const auto at = indices_of(record);
  v = {WideDouble(hn::GatherIndex(kDoubleTag, base, at)),
       WideDouble(hn::GatherIndex(kDoubleTag, base + 1, at)),
       WideDouble(hn::GatherIndex(kDoubleTag, base + 2, at))};
}
/// Records of lanes are different, or their vectors equal: such a vector is added once.
HWY_INLINE void add_triple(const Triple<WideDouble>& v, double* base, const std::uint32_t* record) {
  const auto at = indices_of(record);
  const WideDouble parts[3] = {v.x, v.y, v.z};
  for (int i = 0; i < 3; ++i) {
    const auto before = hn::GatherIndex(kDoubleTag, base + i, at);
    hn::ScatterIndex(hn::Add(before, parts[i].raw), kDoubleTag, base + i, at);
  }
}

#endif

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
