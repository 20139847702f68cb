#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hooke::base {

/// Room for `more` elements, so that appending them cannot fail. Grows as push_back does.
template <class T>
void make_room(std::vector<T>& column, std::size_t more = 1) {
  const std::size_t needed = column.size() + more;
  if (needed > column.capacity()) column.reserve(std::max(needed, 2 * column.size()));
}

}  // namespace hooke::base
