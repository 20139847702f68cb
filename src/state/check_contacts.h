#pragma once

#include "state/tables.h"

/// \file
/// What holds of contacts and sleepers at certain times of a step, where state/check_tables.h says what
/// always does. Each function says in a few words what is wrong, or returns null. None of them allocates.

namespace hooke::state {

/// After the contacts of bodies were found: manifolds without gaps, unit normals, none of sensors or of
/// bodies that nothing moves; pairs are in one of two tables, and those that sleep are counted.
[[nodiscard]] const char* find_in_body_contacts(const Tables& tables);

/// After the contacts of points, elements and ropes were found: order, and points that are all different.
[[nodiscard]] const char* find_in_point_contacts(const Tables& tables);

/// After a step: who sleeps is still.
[[nodiscard]] const char* find_in_sleepers(const Tables& tables);

}  // namespace hooke::state
