/// Vectors of lanes as the Numbers of solver/simd/numbers.h. Included anew for each instruction set.
///
/// A body has one motion record of 16 numbers. The three quarters that rows read are loaded and transposed
/// one after the other, as records of four.

#if defined(HOOKE_SOLVER_SIMD_VECTORS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SIMD_VECTORS_H
#undef HOOKE_SOLVER_SIMD_VECTORS_H
#else
#define HOOKE_SOLVER_SIMD_VECTORS_H
#endif

#include "solver/simd/numbers.h"
#include "solver/simd/records.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

/// Two vectors in flight count as one number, where a block has as many: the processor works on one while it
/// waits for the other.
constexpr int kVectors = kWidth < kLanes ? 2 : 1;
constexpr int kStride = kVectors * kWidth;

/// Lane indices of a vector turned by one lane: 15 0 1 2 for 16.
struct LaneBefore {
  std::int32_t of[kWidth];

  constexpr LaneBefore() : of{} {
    for (int i = 0; i < kWidth; ++i) of[i] = (i + kWidth - 1) % kWidth;
  }
};
constexpr LaneBefore kLaneBefore;

struct Wide {
  Vector raw[kVectors];

  Wide() = default;
  HWY_INLINE explicit Wide(float x) {
    for (Vector& v : raw) v = hn::Set(kTag, x);
  }

  friend HWY_INLINE Wide operator+(const Wide& a, const Wide& b) {
    Wide r;
    for (int i = 0; i < kVectors; ++i) r.raw[i] = hn::Add(a.raw[i], b.raw[i]);
    return r;
  }
  friend HWY_INLINE Wide operator-(const Wide& a, const Wide& b) {
    Wide r;
    for (int i = 0; i < kVectors; ++i) r.raw[i] = hn::Sub(a.raw[i], b.raw[i]);
    return r;
  }
  friend HWY_INLINE Wide operator*(const Wide& a, const Wide& b) {
    Wide r;
    for (int i = 0; i < kVectors; ++i) r.raw[i] = hn::Mul(a.raw[i], b.raw[i]);
    return r;
  }
};

struct Mask {
  hn::Mask<Lanes> raw[kVectors];
};

HWY_INLINE void read(const float* from, Wide& to) {
  for (int i = 0; i < kVectors; ++i) to.raw[i] = hn::Load(kTag, from + i * kWidth);
}
HWY_INLINE void write(const Wide& value, float* to) {
  for (int i = 0; i < kVectors; ++i) hn::Store(value.raw[i], kTag, to + i * kWidth);
}
HWY_INLINE void read_anywhere(const float* from, Wide& to) {
  for (int i = 0; i < kVectors; ++i) to.raw[i] = hn::LoadU(kTag, from + i * kWidth);
}
HWY_INLINE Wide moved_on(const Wide& value, Wide& carried) {
  const auto to_next = hn::SetTableIndices(kTag, kLaneBefore.of);
  const auto first = hn::FirstN(kTag, 1);
  Wide r;
  for (int i = 0; i < kVectors; ++i) {
    const Vector turned = hn::TableLookupLanes(value.raw[i], to_next);
    r.raw[i] = hn::IfThenElse(first, carried.raw[0], turned);
    carried.raw[0] = turned;
  }
  return r;
}
HWY_INLINE float first_lane(const Wide& value) {
  return hn::GetLane(value.raw[0]);
}
HWY_INLINE Mask above(const Wide& a, const Wide& b) {
  Mask r;
  for (int i = 0; i < kVectors; ++i) r.raw[i] = hn::Gt(a.raw[i], b.raw[i]);
  return r;
}
HWY_INLINE bool any(const Mask& condition) {
  for (int i = 0; i < kVectors; ++i) {
    if (!hn::AllFalse(kTag, condition.raw[i])) return true;
  }
  return false;
}
HWY_INLINE Wide choose(const Mask& condition, const Wide& yes, const Wide& no) {
  Wide r;
  for (int i = 0; i < kVectors; ++i) r.raw[i] = hn::IfThenElse(condition.raw[i], yes.raw[i], no.raw[i]);
  return r;
}
HWY_INLINE Wide quotient(const Wide& a, const Wide& b) {
  Wide r;
  for (int i = 0; i < kVectors; ++i) r.raw[i] = hn::Div(a.raw[i], b.raw[i]);
  return r;
}
HWY_INLINE Wide root(const Wide& a) {
  Wide r;
  for (int i = 0; i < kVectors; ++i) r.raw[i] = hn::Sqrt(a.raw[i]);
  return r;
}

template <>
inline constexpr int kLanesOf<Wide> = kStride;
template <>
inline constexpr bool kIsSingle<Wide> = true;

HWY_INLINE void read_quad(const float* base, const std::uint32_t* record, Quad<Wide>& q) {
  for (int i = 0; i < kVectors; ++i) {
    const Columns c = load_columns(base, record + i * kWidth);
    q.x.raw[i] = c.x;
    q.y.raw[i] = c.y;
    q.z.raw[i] = c.z;
    q.w.raw[i] = c.w;
  }
}

HWY_INLINE void read_offset(const float* base, const std::uint32_t* to, const std::uint32_t* from,
                            Triple<Wide>& offset) {
  for (int i = 0; i < kVectors; ++i) {
    const Columns c = load_offsets(base, to + i * kWidth, from + i * kWidth);
    offset.x.raw[i] = c.x;
    offset.y.raw[i] = c.y;
    offset.z.raw[i] = c.z;
  }
}

HWY_INLINE void write_quad(const Quad<Wide>& q, float* base, const std::uint32_t* record) {
  for (int i = 0; i < kVectors; ++i)
    store_columns({q.x.raw[i], q.y.raw[i], q.z.raw[i], q.w.raw[i]}, base, record + i * kWidth);
}

#endif

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
