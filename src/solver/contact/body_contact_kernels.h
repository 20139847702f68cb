#pragma once

#include "solver/contact/body_contacts.h"
#include "state/bodies.h"

#include <span>

/// \file
/// Kernels over blocks of contacts; the formulas stand in solver/contact/body_contacts.h. Every instruction
/// set gives the bits of the scalar twin, and wide::use_target (solver/simd/dispatch.h) chooses the
/// instruction set.

namespace hooke::solver::wide {

/// Where the inputs of a block's rows are. Columns of structs are read in place, four numbers at a time.
struct alignas(64) ContactSource {
  /// -1 where the bodies of the manifold are swapped in the block, 1 elsewhere.
  ContactBlock::Lane sign;
  ContactBlock::Lane points;              ///< Number of points.
  std::uint32_t manifold[kContactLanes];  ///< Where the manifold begins, in numbers.
  const state::Manifold* manifolds = nullptr;
  const math::Symmetric3<Real>* scale = nullptr;  ///< S of each body.
  Real impulse_scale = Real(1);                   ///< Scale of the impulses carried over.
};

/// How a pass treats overlap, gaps and friction.
struct ContactPass {
  ContactSoftness softness;
  Real inverse_h = Real(0);  ///< Points that are apart reach the surface within h, and no farther.
  bool foresees = true;      ///< False: lanes that bounce do nothing about gaps.
  bool friction = false;
};

/// Computes the rows of a block that has only record numbers, w, restitution, number of points and
/// `anchored`.
void compute_contact_rows(const ContactSource& source, ContactBlock& block);

/// Makes one pass over blocks of one color.
void solve_contacts(std::span<ContactBlock> blocks, const ContactPass& pass, state::MotionRecord* motion);

/// Removes the impulses carried over from the free motion of the bodies.
void warm_start_contacts(std::span<const ContactBlock> blocks, state::FreeMotionRecord* free_motion);

// The scalar twins.
void compute_contact_lane_scalar(const ContactSource& source, int lane, ContactBlock& block);
void compute_contact_rows_scalar(const ContactSource& source, ContactBlock& block);
void solve_contacts_scalar(std::span<ContactBlock> blocks, const ContactPass& pass,
                           state::MotionRecord* motion);
void warm_start_contacts_scalar(std::span<const ContactBlock> blocks, state::FreeMotionRecord* free_motion);

}  // namespace hooke::solver::wide
