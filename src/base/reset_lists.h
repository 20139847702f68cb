#pragma once

#include <cstddef>
#include <vector>

namespace hooke::base {

/// Ensures that there are `count` lists and empties these; none loses its memory.
template <class T>
void reset_lists(std::size_t count, std::vector<std::vector<T>>& lists) {
  if (lists.size() < count) lists.resize(count);
  for (std::size_t i = 0; i < count; ++i) lists[i].clear();
}

}  // namespace hooke::base
