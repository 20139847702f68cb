#pragma once

#include <algorithm>
#include <vector>

namespace hooke::base {

/// Sorts in ascending order and removes duplicates.
template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace hooke::base
