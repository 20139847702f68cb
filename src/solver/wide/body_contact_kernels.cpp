/// Contact rows over lanes, then the dispatch. The arithmetic stands in body_contact_rows.h.
///
/// A body is one line of 16 numbers; the three quarters that rows read are loaded and transposed one after
/// the other, as lines of four.

#include "solver/wide/body_contacts.h"
#include "solver/wide/wide.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/wide/body_contact_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set.
#include "solver/wide/body_contact_rows.h"
#include "solver/wide/lines.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void compute_contact_rows_here(const ContactSource& source, ContactBlock& block) {
  compute_contact_rows_scalar(source, block);
}

void solve_contacts_here(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionLine* motion) {
  solve_contacts_scalar(blocks, pass, motion);
}

void warm_start_contacts_here(std::span<const ContactBlock> blocks, state::FreeLine* free_motion) {
  warm_start_contacts_scalar(blocks, free_motion);
}

#else

static_assert(kContactLanes == kLanes);

/// Two vectors in flight as one number, where a block has as many: the processor works on one while it waits
/// for the other.
constexpr int kVectors = kWidth < kContactLanes ? 2 : 1;
constexpr int kStride = kVectors * kWidth;

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
HWY_INLINE Mask above(const Wide& a, const Wide& b) {
  Mask r;
  for (int i = 0; i < kVectors; ++i) r.raw[i] = hn::Gt(a.raw[i], b.raw[i]);
  return r;
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
constexpr int kLanesOf<Wide> = kStride;

HWY_INLINE void read_quad(const float* base, const std::uint32_t* line, Quad<Wide>& q) {
  for (int i = 0; i < kVectors; ++i) {
    const Columns c = load_columns(base, line + i * kWidth);
    q.x.raw[i] = c.x;
    q.y.raw[i] = c.y;
    q.z.raw[i] = c.z;
    q.w.raw[i] = c.w;
  }
}

HWY_INLINE void write_quad(const Quad<Wide>& q, float* base, const std::uint32_t* line) {
  for (int i = 0; i < kVectors; ++i)
    store_columns({q.x.raw[i], q.y.raw[i], q.z.raw[i], q.w.raw[i]}, base, line + i * kWidth);
}

void compute_contact_rows_here(const ContactSource& source, ContactBlock& block) {
  for (int lane = 0; lane < kContactLanes; lane += kStride) {
    if (block.anchored) {
      compute_lanes<Wide, true>(source, lane, block);
    } else {
      compute_lanes<Wide, false>(source, lane, block);
    }
  }
}

void solve_contacts_here(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionLine* motion) {
  auto* lines = reinterpret_cast<float*>(motion);
  for (ContactBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kStride) {
      if (block.anchored) {
        solve_lanes<Wide, true>(block, lane, pass, lines);
      } else {
        solve_lanes<Wide, false>(block, lane, pass, lines);
      }
    }
  }
}

void warm_start_contacts_here(std::span<const ContactBlock> blocks, state::FreeLine* free_motion) {
  auto* lines = reinterpret_cast<float*>(free_motion);
  for (const ContactBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kStride) {
      if (block.anchored) {
        warm_start_lanes<Wide, true>(block, lane, lines);
      } else {
        warm_start_lanes<Wide, false>(block, lane, lines);
      }
    }
  }
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace hooke::solver::wide {

HWY_EXPORT(compute_contact_rows_here);
HWY_EXPORT(solve_contacts_here);
HWY_EXPORT(warm_start_contacts_here);

void compute_contact_rows(const ContactSource& source, ContactBlock& block) {
  if (is_scalar()) return compute_contact_rows_scalar(source, block);
  HWY_DYNAMIC_DISPATCH(compute_contact_rows_here)(source, block);
}

void solve_contacts(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionLine* motion) {
  if (is_scalar()) return solve_contacts_scalar(blocks, pass, motion);
  HWY_DYNAMIC_DISPATCH(solve_contacts_here)(blocks, pass, motion);
}

void warm_start_contacts(std::span<const ContactBlock> blocks, state::FreeLine* free_motion) {
  if (is_scalar()) return warm_start_contacts_scalar(blocks, free_motion);
  HWY_DYNAMIC_DISPATCH(warm_start_contacts_here)(blocks, free_motion);
}

}  // namespace hooke::solver::wide

#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void compute_contact_rows(const ContactSource& source, ContactBlock& block) {
  compute_contact_rows_scalar(source, block);
}

void solve_contacts(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionLine* motion) {
  solve_contacts_scalar(blocks, pass, motion);
}

void warm_start_contacts(std::span<const ContactBlock> blocks, state::FreeLine* free_motion) {
  warm_start_contacts_scalar(blocks, free_motion);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
