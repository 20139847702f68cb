#pragma once

#include "state/tables.h"

namespace hooke::state {

/// Says in a few words what does not agree in the tables: columns of unequal length, a row that points to
/// none or to another object's, ids that lead elsewhere. Returns null if all agrees. Reads every row.
[[nodiscard]] const char* find_disagreement(const Tables& tables);

/// Asserts that the tables agree. Does nothing in builds without HOOKE_CHECKS.
void check_tables(const Tables& tables);

}  // namespace hooke::state
