#pragma once

#include "state/tables.h"

namespace hooke::collision {

/// Cosine of the angle that a normal may turn in a substep without losing its force.
inline constexpr Real kRopeSameSide = Real(0.9);

/// Finds the nearest points, normal and gap of one row; see update_rope_contacts. A row that does not act
/// keeps its normal and forces for its successor.
void update_rope_row(const state::Tables& tables, Real h, state::RopeContact& row);

}  // namespace hooke::collision
