#pragma once

#include "solver/body_contacts.h"
#include "state/bodies.h"

#include <span>

/// \file
/// Kernels over blocks of contacts; the formulas stand in solver/body_contacts.h. As in wide.h, every
/// instruction set gives the bits of the scalar twin, and wide::use_target chooses for these kernels too.

namespace hooke::solver::wide {

/// Inputs of a block's rows, lane by lane.
struct alignas(64) ContactInputs {
  using Lane = ContactBlock::Lane;

  Lane scale_a[6], scale_b[6];  ///< S of the bodies: xx, xy, xz, yy, yz, zz.
  Lane anchor_a[state::Manifold::kMaxPoints][3], anchor_b[state::Manifold::kMaxPoints][3];
  Lane present[state::Manifold::kMaxPoints];  ///< 1 for a point, 0 for one the manifold lacks.
  Lane friction_impulse[3];                   ///< On B [N s].
  Lane surface_velocity[3];
  Lane spinning_friction;
};

/// How a pass treats overlap and friction.
struct ContactPass {
  ContactSoftness softness;
  Real inverse_h = Real(0);
  bool friction = false;
};

/// Jacobians, masses and friction of a block whose inputs, line numbers, w, normal, separations, impulses,
/// twist impulse and coefficients stand.
void compute_contact_rows(const ContactInputs& inputs, ContactBlock& block);

/// One pass over blocks of one color.
void solve_contacts(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionLine* motion);

/// Takes the impulses carried over out of the free motion of the bodies.
void warm_start_contacts(std::span<const ContactBlock> blocks, state::FreeLine* free_motion);

// The scalar twins.
void compute_contact_rows_scalar(const ContactInputs& inputs, ContactBlock& block);
void solve_contacts_scalar(std::span<ContactBlock> blocks, const ContactPass& pass,
                           state::MotionLine* motion);
void warm_start_contacts_scalar(std::span<const ContactBlock> blocks, state::FreeLine* free_motion);

}  // namespace hooke::solver::wide
