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

void compute_contact_rows_here(const ContactInputs& inputs, ContactBlock& block) {
  compute_contact_rows_scalar(inputs, block);
}

void solve_contacts_here(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionLine* motion) {
  solve_contacts_scalar(blocks, pass, motion);
}

void warm_start_contacts_here(std::span<const ContactBlock> blocks, state::FreeLine* free_motion) {
  warm_start_contacts_scalar(blocks, free_motion);
}

#else

static_assert(kContactLanes == kLanes);

/// kWidth lanes as a number.
struct Wide {
  Vector raw;

  Wide() = default;
  HWY_INLINE explicit Wide(Vector v) : raw(v) {}
  HWY_INLINE explicit Wide(float x) : raw(hn::Set(kTag, x)) {}

  friend HWY_INLINE Wide operator+(Wide a, Wide b) { return Wide(hn::Add(a.raw, b.raw)); }
  friend HWY_INLINE Wide operator-(Wide a, Wide b) { return Wide(hn::Sub(a.raw, b.raw)); }
  friend HWY_INLINE Wide operator*(Wide a, Wide b) { return Wide(hn::Mul(a.raw, b.raw)); }
};

using Mask = hn::Mask<Lanes>;

HWY_INLINE void read(const float* from, Wide& to) {
  to.raw = hn::Load(kTag, from);
}
HWY_INLINE void write(Wide value, float* to) {
  hn::Store(value.raw, kTag, to);
}
HWY_INLINE Mask above(Wide a, Wide b) {
  return hn::Gt(a.raw, b.raw);
}
HWY_INLINE Wide choose(Mask condition, Wide yes, Wide no) {
  return Wide(hn::IfThenElse(condition, yes.raw, no.raw));
}
HWY_INLINE Wide quotient(Wide a, Wide b) {
  return Wide(hn::Div(a.raw, b.raw));
}
HWY_INLINE Wide root(Wide a) {
  return Wide(hn::Sqrt(a.raw));
}

HWY_INLINE void read_velocity(const Columns& first, const Columns& second, Velocity<Wide>& motion) {
  motion.v = {Wide(first.x), Wide(first.y), Wide(first.z)};
  motion.omega = {Wide(first.w), Wide(second.x), Wide(second.y)};
}

HWY_INLINE void read_line(const float* base, const std::uint32_t* line, Velocity<Wide>& motion,
                          Displacement<Wide>& moved) {
  const Columns second = load_columns(base + 4, line);
  const Columns third = load_columns(base + 8, line);
  read_velocity(load_columns(base, line), second, motion);
  moved.dx = {Wide(second.z), Wide(second.w), Wide(third.x)};
  moved.theta = {Wide(third.y), Wide(third.z), Wide(third.w)};
}

HWY_INLINE void write_line(const Velocity<Wide>& motion, const Displacement<Wide>& moved, float* base,
                           const std::uint32_t* line) {
  store_columns({motion.v.x.raw, motion.v.y.raw, motion.v.z.raw, motion.omega.x.raw}, base, line);
  store_columns({motion.omega.y.raw, motion.omega.z.raw, moved.dx.x.raw, moved.dx.y.raw}, base + 4, line);
}

/// Where free lines begin, from where motion lines do.
struct Halves {
  std::uint32_t line[kWidth];

  HWY_INLINE explicit Halves(const std::uint32_t* whole) {
    for (int i = 0; i < kWidth; ++i) line[i] = whole[i] / 2;
  }
};

HWY_INLINE void read_free(const float* base, const std::uint32_t* line, Velocity<Wide>& motion) {
  const Halves halves(line);
  read_velocity(load_columns(base, halves.line), load_columns(base + 4, halves.line), motion);
}

HWY_INLINE void write_free(const Velocity<Wide>& motion, float* base, const std::uint32_t* line) {
  const Halves halves(line);
  const Vector zero = hn::Zero(kTag);
  store_columns({motion.v.x.raw, motion.v.y.raw, motion.v.z.raw, motion.omega.x.raw}, base, halves.line);
  store_columns({motion.omega.y.raw, motion.omega.z.raw, zero, zero}, base + 4, halves.line);
}

void compute_contact_rows_here(const ContactInputs& inputs, ContactBlock& block) {
  for (int lane = 0; lane < kContactLanes; lane += kWidth) {
    if (block.anchored) {
      compute_lanes<Wide, true>(inputs, lane, block);
    } else {
      compute_lanes<Wide, false>(inputs, lane, block);
    }
  }
}

void solve_contacts_here(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionLine* motion) {
  auto* lines = reinterpret_cast<float*>(motion);
  for (ContactBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kWidth) {
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
    for (int lane = 0; lane < block.count; lane += kWidth) {
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

void compute_contact_rows(const ContactInputs& inputs, ContactBlock& block) {
  if (is_scalar()) return compute_contact_rows_scalar(inputs, block);
  HWY_DYNAMIC_DISPATCH(compute_contact_rows_here)(inputs, block);
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

void compute_contact_rows(const ContactInputs& inputs, ContactBlock& block) {
  compute_contact_rows_scalar(inputs, block);
}

void solve_contacts(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionLine* motion) {
  solve_contacts_scalar(blocks, pass, motion);
}

void warm_start_contacts(std::span<const ContactBlock> blocks, state::FreeLine* free_motion) {
  warm_start_contacts_scalar(blocks, free_motion);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
