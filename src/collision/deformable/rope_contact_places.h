#pragma once

#include "collision/deformable/deformable_tuning.h"
#include "state/tables.h"

namespace hooke::collision {

/// Finds the nearest points, normal and gap of one row; see update_rope_contacts. A row that does not act
/// keeps its normal and forces for its successor.
void update_rope_row(const state::Tables& tables, Real h, state::RopeContact& row);

}  // namespace hooke::collision
