#pragma once

#include "state/bodies.h"

#include <cstdint>
#include <span>

namespace hooke::solver {

/// Contacts remove overlaps at 3 m/s each, and relax takes that speed out again. In a dense pile
/// (collision/narrow_phase/dense_piles.h) each body is pushed by many others whose pushes add up. Here pushes
/// make no body faster than that relative to the whole pile, or than it was without them. The momentum of the
/// pile stays: what contacts did to it is their warm start, which acts again in each substep.
void limit_dense_pile(std::span<const std::uint32_t> pile, state::Bodies& bodies);

}  // namespace hooke::solver
