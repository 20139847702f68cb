#pragma once

#include "state/bodies.h"

#include <cstdint>
#include <span>

namespace hooke::solver {

/// Contacts push overlaps apart by 3 m/s each, and relax takes that out again. In a crowd
/// (collision/narrow_phase/dense_piles.h) each body is pushed by many whose pushes add up: there they make
/// nothing faster than that, against the crowd as a whole, or faster than it was without them. Keeps the
/// momentum of the crowd: what contacts did to it is their warm start, which acts again in each substep.
void limit_dense_pile(std::span<const std::uint32_t> pile, state::Bodies& bodies);

}  // namespace hooke::solver
