/// Contact rows over lanes, then the dispatch. The arithmetic stands in solver/contact/body_contact_rows.h.

#include "solver/contact/body_contact_kernels.h"

#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/contact/body_contact_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Included after Highway, which includes this file again for each instruction set. Numbers come before what
// uses them.
// clang-format off
#include "solver/simd/vectors.h"
#include "solver/contact/body_contact_rows.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void compute_contact_rows_here(const ContactSource& source, ContactBlock& block) {
  compute_contact_rows_scalar(source, block);
}

void solve_contacts_here(std::span<ContactBlock> blocks, const ContactPass& pass,
                         state::MotionRecord* motion) {
  solve_contacts_scalar(blocks, pass, motion);
}

void warm_start_contacts_here(std::span<const ContactBlock> blocks, state::FreeMotionRecord* free_motion) {
  warm_start_contacts_scalar(blocks, free_motion);
}

#else

static_assert(kContactLanes == kLanes);

void compute_contact_rows_here(const ContactSource& source, ContactBlock& block) {
  for (int lane = 0; lane < kContactLanes; lane += kStride) {
    if (block.anchored) {
      compute_lanes<Wide, true>(source, lane, block);
    } else {
      compute_lanes<Wide, false>(source, lane, block);
    }
  }
}

void solve_contacts_here(std::span<ContactBlock> blocks, const ContactPass& pass,
                         state::MotionRecord* motion) {
  auto* records = reinterpret_cast<float*>(motion);
  for (ContactBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kStride) {
      if (block.anchored) {
        solve_lanes<Wide, true>(block, lane, pass, records);
      } else {
        solve_lanes<Wide, false>(block, lane, pass, records);
      }
    }
  }
}

void warm_start_contacts_here(std::span<const ContactBlock> blocks, state::FreeMotionRecord* free_motion) {
  auto* records = reinterpret_cast<float*>(free_motion);
  for (const ContactBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kStride) {
      if (block.anchored) {
        warm_start_lanes<Wide, true>(block, lane, records);
      } else {
        warm_start_lanes<Wide, false>(block, lane, records);
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

void solve_contacts(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionRecord* motion) {
  if (is_scalar()) return solve_contacts_scalar(blocks, pass, motion);
  HWY_DYNAMIC_DISPATCH(solve_contacts_here)(blocks, pass, motion);
}

void warm_start_contacts(std::span<const ContactBlock> blocks, state::FreeMotionRecord* free_motion) {
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

void solve_contacts(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionRecord* motion) {
  solve_contacts_scalar(blocks, pass, motion);
}

void warm_start_contacts(std::span<const ContactBlock> blocks, state::FreeMotionRecord* free_motion) {
  warm_start_contacts_scalar(blocks, free_motion);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
