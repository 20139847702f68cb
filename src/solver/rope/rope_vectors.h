/// solver/rope/rope_records.h for vectors of double. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_ROPE_ROPE_VECTORS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_ROPE_ROPE_VECTORS_H
#undef HOOKE_SOLVER_ROPE_ROPE_VECTORS_H
#else
#define HOOKE_SOLVER_ROPE_ROPE_VECTORS_H
#endif

#include "solver/rope/rope_records.h"
#include "solver/simd/double_vectors.h"
#include "solver/simd/records.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

constexpr int kDoubles = hn::MaxLanes(DoubleLanes());
using HalfLanes = hn::CappedTag<float, kDoubles>;  ///< As many floats as doubles.
constexpr HalfLanes kHalfTag;

HWY_INLINE void read_record(const float* base, const std::uint32_t* record, Quad<WideDouble>& value) {
  if constexpr (kDoubles >= 4) {
    auto x = load_records(kHalfTag, base, record);
    auto y = load_records(kHalfTag, base, record + 1);
    auto z = load_records(kHalfTag, base, record + 2);
    auto w = load_records(kHalfTag, base, record + 3);
    transpose(kHalfTag, x, y, z, w);
    value = {WideDouble(hn::PromoteTo(kDoubleTag, x)), WideDouble(hn::PromoteTo(kDoubleTag, y)),
             WideDouble(hn::PromoteTo(kDoubleTag, z)), WideDouble(hn::PromoteTo(kDoubleTag, w))};
  } else {
    alignas(16) double lanes[4][kDoubles];
    for (int k = 0; k < kDoubles; ++k) {
      for (int j = 0; j < 4; ++j) lanes[j][k] = static_cast<double>(base[record[k] + j]);
    }
    value = {get<WideDouble>(lanes[0]), get<WideDouble>(lanes[1]), get<WideDouble>(lanes[2]),
             get<WideDouble>(lanes[3])};
  }
}

HWY_INLINE void round_record(const Quad<WideDouble>& value, StoredRecords<WideDouble>& records) {
  if constexpr (kDoubles >= 4) {
    auto x = hn::DemoteTo(kHalfTag, value.x.raw);
    auto y = hn::DemoteTo(kHalfTag, value.y.raw);
    auto z = hn::DemoteTo(kHalfTag, value.z.raw);
    auto w = hn::DemoteTo(kHalfTag, value.w.raw);
    transpose(kHalfTag, x, y, z, w);
    // The k-th record of x is that of lane 4 k, of y that of lane 4 k + 1, and so on.
    constexpr std::uint32_t kRecords[8] = {0, 4, 8, 12, 16, 20, 24, 28};
    store_records(kHalfTag, x, records.of[0], kRecords);
    store_records(kHalfTag, y, records.of[0], kRecords + 1);
    store_records(kHalfTag, z, records.of[0], kRecords + 2);
    store_records(kHalfTag, w, records.of[0], kRecords + 3);
  } else {
    alignas(16) double lanes[4][kDoubles];
    write(value.x, lanes[0]);
    write(value.y, lanes[1]);
    write(value.z, lanes[2]);
    write(value.w, lanes[3]);
    for (int k = 0; k < kDoubles; ++k) {
      for (int j = 0; j < 4; ++j) records.of[k][j] = static_cast<float>(lanes[j][k]);
    }
  }
}

#endif

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
