#pragma once

#include "state/tables.h"

namespace hooke::state {

/// What of the tables does not agree, in a few words: columns of unequal length, a row that points to none or
/// to another's, ids that lead elsewhere. Null where all do. Looks at every row.
[[nodiscard]] const char* find_disagreement(const Tables& tables);

/// Asserts that there is none. Does nothing in builds without HOOKE_CHECKS.
void check_tables(const Tables& tables);

}  // namespace hooke::state
