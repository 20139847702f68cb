#include "solver/wide/body_contacts.h"

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
