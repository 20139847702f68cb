#pragma once

#include "state/tables.h"

namespace hooke::collision {

/// Cosine of what a normal turns in a substep without losing its force.
inline constexpr Real kRopeSameSide = Real(0.9);

/// Nearest places, normal and gap of one row, see update_rope_contacts. One that does not hold keeps its
/// normal and forces, for its heir.
void update_rope_row(const state::Tables& tables, Real h, state::RopeContact& row);

}  // namespace hooke::collision
