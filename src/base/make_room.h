#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hooke::base {

/// Reserves memory for `more` elements, so that appending them cannot fail. The capacity at least doubles, so
/// that repeated calls stay cheap.
template <class T>
void make_room(std::vector<T>& column, std::size_t more = 1) {
  const std::size_t needed = column.size() + more;
  if (needed > column.capacity()) column.reserve(std::max(needed, 2 * column.size()));
}

}  // namespace hooke::base
