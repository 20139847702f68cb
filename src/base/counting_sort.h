#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace hooke::base {

/// Sorts items by key(item), a number below `count`, in time that grows with the number of items and `count`.
/// Items with the same key keep their order. So a sort by several keys is one by each, the last key first.
template <class T, class Key>
void counting_sort(std::vector<T>& items, std::size_t count, Key key) {
  std::vector<std::size_t> next(count + 1, 0);
  for (const T& item : items) ++next[static_cast<std::size_t>(key(item)) + 1];
  for (std::size_t i = 0; i < count; ++i) {
    if (next[i + 1] == items.size()) return;  // All have this key.
    next[i + 1] += next[i];
  }
  std::vector<T> sorted(items.size());
  for (T& item : items) sorted[next[static_cast<std::size_t>(key(item))]++] = std::move(item);
  items.swap(sorted);
}

}  // namespace hooke::base
