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

/// Turns four records of doubles into vectors of their components, and back: it is its own inverse. Hardware
/// gathers, and scatters that are stores one by one, take twice as long.
template <class D>
HWY_INLINE void transpose_doubles(D tag, hn::Vec<D>& r0, hn::Vec<D>& r1, hn::Vec<D>& r2, hn::Vec<D>& r3) {
  const auto low01 = hn::InterleaveLower(tag, r0, r1), high01 = hn::InterleaveUpper(tag, r0, r1);
  const auto low23 = hn::InterleaveLower(tag, r2, r3), high23 = hn::InterleaveUpper(tag, r2, r3);
  r0 = hn::ConcatLowerLower(tag, low23, low01);
  r1 = hn::ConcatLowerLower(tag, high23, high01);
  r2 = hn::ConcatUpperUpper(tag, low23, low01);
  r3 = hn::ConcatUpperUpper(tag, high23, high01);
}

template <class D>
HWY_INLINE void load_triple(D tag, const double* base, const std::uint32_t* record, Triple<hn::Vec<D>>& v) {
  if constexpr (hn::MaxLanes(D()) == 2) {
    const auto a = hn::LoadU(tag, base + record[0]), b = hn::LoadU(tag, base + record[1]);
    v.x = hn::InterleaveLower(tag, a, b);
    v.y = hn::InterleaveUpper(tag, a, b);
    v.z =
        hn::InterleaveLower(tag, hn::LoadU(tag, base + record[0] + 2), hn::LoadU(tag, base + record[1] + 2));
  } else if constexpr (hn::MaxLanes(D()) == 4) {
    v.x = hn::LoadU(tag, base + record[0]);
    v.y = hn::LoadU(tag, base + record[1]);
    v.z = hn::LoadU(tag, base + record[2]);
    auto rest = hn::LoadU(tag, base + record[3]);
    transpose_doubles(tag, v.x, v.y, v.z, rest);
  } else {
    constexpr hn::Half<D> kHalf;
    Triple<hn::Vec<hn::Half<D>>> low, high;
    load_triple(kHalf, base, record, low);
    load_triple(kHalf, base, record + hn::MaxLanes(kHalf), high);
    v = {hn::Combine(tag, high.x, low.x), hn::Combine(tag, high.y, low.y), hn::Combine(tag, high.z, low.z)};
  }
}

/// Records to which a triple was added, before they are stored.
template <class D>
struct RaisedRecords {
  hn::Vec<D> r0, r1, r2, r3;

  HWY_INLINE RaisedRecords(D tag, const Triple<hn::Vec<D>>& v, const double* base,
                           const std::uint32_t* record)
      : r0(v.x), r1(v.y), r2(v.z), r3(hn::Zero(tag)) {
    transpose_doubles(tag, r0, r1, r2, r3);
    r0 = hn::Add(hn::LoadU(tag, base + record[0]), r0);
    r1 = hn::Add(hn::LoadU(tag, base + record[1]), r1);
    r2 = hn::Add(hn::LoadU(tag, base + record[2]), r2);
    r3 = hn::Add(hn::LoadU(tag, base + record[3]), r3);
  }
  HWY_INLINE void store(D tag, double* base, const std::uint32_t* record) const {
    hn::StoreU(r0, tag, base + record[0]);
    hn::StoreU(r1, tag, base + record[1]);
    hn::StoreU(r2, tag, base + record[2]);
    hn::StoreU(r3, tag, base + record[3]);
  }
};

/// All records are read before one is stored.
template <class D>
HWY_INLINE void raise_triple(D tag, const Triple<hn::Vec<D>>& v, double* base, const std::uint32_t* record) {
  if constexpr (hn::MaxLanes(D()) == 2) {
    double *a = base + record[0], *b = base + record[1];
    const auto zero = hn::Zero(tag);
    const auto a_xy = hn::Add(hn::LoadU(tag, a), hn::InterleaveLower(tag, v.x, v.y));
    const auto b_xy = hn::Add(hn::LoadU(tag, b), hn::InterleaveUpper(tag, v.x, v.y));
    const auto a_z = hn::Add(hn::LoadU(tag, a + 2), hn::InterleaveLower(tag, v.z, zero));
    const auto b_z = hn::Add(hn::LoadU(tag, b + 2), hn::InterleaveUpper(tag, v.z, zero));
    hn::StoreU(a_xy, tag, a);
    hn::StoreU(a_z, tag, a + 2);
    hn::StoreU(b_xy, tag, b);
    hn::StoreU(b_z, tag, b + 2);
  } else if constexpr (hn::MaxLanes(D()) == 4) {
    RaisedRecords<D>(tag, v, base, record).store(tag, base, record);
  } else {
    using Half = hn::Half<D>;
    constexpr Half kHalf;
    constexpr int kOthers = hn::MaxLanes(kHalf);
    const RaisedRecords<Half> low(
        kHalf, {hn::LowerHalf(kHalf, v.x), hn::LowerHalf(kHalf, v.y), hn::LowerHalf(kHalf, v.z)}, base,
        record);
    const RaisedRecords<Half> high(
        kHalf, {hn::UpperHalf(kHalf, v.x), hn::UpperHalf(kHalf, v.y), hn::UpperHalf(kHalf, v.z)}, base,
        record + kOthers);
    low.store(kHalf, base, record);
    high.store(kHalf, base, record + kOthers);
  }
}

HWY_INLINE void read_triple(const double* base, const std::uint32_t* record, Triple<WideDouble>& v) {
  Triple<hn::Vec<DoubleLanes>> raw;
  load_triple(kDoubleTag, base, record, raw);
  v = {WideDouble(raw.x), WideDouble(raw.y), WideDouble(raw.z)};
}
/// Records have four numbers, of which the last stays. Those of lanes are different, or their vectors equal:
/// such a vector is added once.
HWY_INLINE void add_triple(const Triple<WideDouble>& v, double* base, const std::uint32_t* record) {
  raise_triple(kDoubleTag, {v.x.raw, v.y.raw, v.z.raw}, base, record);
}

#endif

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
