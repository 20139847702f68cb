/// Records of four numbers, loaded whole and transposed in registers: hardware gathers are slower than this
/// on every machine measured. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SIMD_RECORDS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SIMD_RECORDS_H
#undef HOOKE_SOLVER_SIMD_RECORDS_H
#else
#define HOOKE_SOLVER_SIMD_RECORDS_H
#endif

#include "solver/simd/lanes.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, kLanes>;
using Vector = hn::Vec<Lanes>;
using Line = hn::FixedTag<float, 4>;

constexpr Lanes kTag;
constexpr int kWidth = hn::MaxLanes(Lanes());
constexpr int kRecordCount = kWidth / 4;  // Records in one vector.

/// Loads a vector whose k-th record begins at number index[4 k] of `base`, anywhere.
template <class D>
HWY_INLINE hn::Vec<D> load_records(D tag, const float* base, const std::uint32_t* index) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(tag, base + *index);
  } else {
    const hn::Half<D> half;
    constexpr int kHalf = hn::MaxLanes(D()) / 2;
    return hn::Combine(tag, load_records(half, base, index + kHalf), load_records(half, base, index));
  }
}

/// Turns four vectors of records into four of components, and back: the transposition is its own inverse.
template <class D>
HWY_INLINE void transpose(D tag, hn::Vec<D>& r0, hn::Vec<D>& r1, hn::Vec<D>& r2, hn::Vec<D>& r3) {
  const hn::Repartition<double, D> pairs;
  const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(tag, r0, r1));
  const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(tag, r2, r3));
  const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(tag, r0, r1));
  const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(tag, r2, r3));
  r0 = hn::BitCast(tag, hn::InterleaveLower(pairs, low01, low23));
  r1 = hn::BitCast(tag, hn::InterleaveUpper(pairs, low01, low23));
  r2 = hn::BitCast(tag, hn::InterleaveLower(pairs, high01, high23));
  r3 = hn::BitCast(tag, hn::InterleaveUpper(pairs, high01, high23));
}

template <class D>
HWY_INLINE void store_records(D tag, hn::Vec<D> records, float* base, const std::uint32_t* index) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    hn::Store(records, tag, base + *index);
  } else {
    const hn::Half<D> half;
    constexpr int kHalf = hn::MaxLanes(D()) / 2;
    store_records(half, hn::LowerHalf(half, records), base, index);
    store_records(half, hn::UpperHalf(half, records), base, index + kHalf);
  }
}

/// The components of kWidth records.
struct Columns {
  Vector x, y, z, w;
};

HWY_INLINE Columns load_columns(const float* base, const std::uint32_t* index) {
  Columns c = {load_records(kTag, base, index), load_records(kTag, base, index + 1),
               load_records(kTag, base, index + 2), load_records(kTag, base, index + 3)};
  transpose(kTag, c.x, c.y, c.z, c.w);
  return c;
}

/// The components of records less others. The difference is taken before the transposition, which saves one
/// transposition.
HWY_INLINE Columns load_offsets(const float* base, const std::uint32_t* to, const std::uint32_t* from) {
  const auto offset = [&](int j) HWY_ATTR {
    return hn::Sub(load_records(kTag, base, to + j), load_records(kTag, base, from + j));
  };
  Columns c = {offset(0), offset(1), offset(2), offset(3)};
  transpose(kTag, c.x, c.y, c.z, c.w);
  return c;
}

HWY_INLINE void store_columns(Columns c, float* base, const std::uint32_t* index) {
  transpose(kTag, c.x, c.y, c.z, c.w);
  store_records(kTag, c.x, base, index);
  store_records(kTag, c.y, base, index + 1);
  store_records(kTag, c.z, base, index + 2);
  store_records(kTag, c.w, base, index + 3);
}

#endif

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
