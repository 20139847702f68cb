#include "solver/contact/body_contact_rows.h"

// One lane at a time, in either precision.

namespace hooke::solver::wide {

void compute_contact_lane_scalar(const ContactSource& source, int lane, ContactBlock& block) {
  if (block.anchored) {
    HWY_NAMESPACE::compute_lanes<Real, true>(source, lane, block);
  } else {
    HWY_NAMESPACE::compute_lanes<Real, false>(source, lane, block);
  }
}

void compute_contact_rows_scalar(const ContactSource& source, ContactBlock& block) {
  for (int lane = 0; lane < kContactLanes; ++lane) compute_contact_lane_scalar(source, lane, block);
}

void solve_contacts_scalar(std::span<ContactBlock> blocks, const ContactPass& pass,
                           state::MotionRecord* motion) {
  auto* records = reinterpret_cast<Real*>(motion);
  for (ContactBlock& block : blocks) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.anchored) {
        HWY_NAMESPACE::solve_lanes<Real, true>(block, lane, pass, records);
      } else {
        HWY_NAMESPACE::solve_lanes<Real, false>(block, lane, pass, records);
      }
    }
  }
}

void warm_start_contacts_scalar(std::span<const ContactBlock> blocks, state::FreeMotionRecord* free_motion) {
  auto* records = reinterpret_cast<Real*>(free_motion);
  for (const ContactBlock& block : blocks) {
    for (int lane = 0; lane < block.count; ++lane) {
      if (block.anchored) {
        HWY_NAMESPACE::warm_start_lanes<Real, true>(block, lane, records);
      } else {
        HWY_NAMESPACE::warm_start_lanes<Real, false>(block, lane, records);
      }
    }
  }
}

}  // namespace hooke::solver::wide
