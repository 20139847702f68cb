#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hooke::base {

/// A list of items for each key, all in one array: which contacts a body has.
template <class T>
class ListsByKey {
 public:
  /// Forgets all lists.
  void clear() { first_.clear(); }

  /// Whether nothing has been filled in since clear().
  [[nodiscard]] bool empty() const { return first_.empty(); }

  /// Makes the lists of keys below `keys`. `for_each(visit)` calls `visit(key, item)` with all items, twice
  /// in the same order, which the lists keep.
  template <class ForEach>
  void fill(std::size_t keys, ForEach for_each) {
    first_.assign(keys + 2, 0);
    for_each([&](std::size_t key, const T&) { ++first_[key + 2]; });
    for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
    items_.resize(first_.back());
    for_each([&](std::size_t key, const T& item) { items_[first_[key + 1]++] = item; });
  }

  [[nodiscard]] std::span<const T> of(std::size_t key) const {
    return std::span(items_).subspan(first_[key], first_[key + 1] - first_[key]);
  }

 private:
  std::vector<std::uint32_t> first_;  ///< By key: row of `items_`.
  std::vector<T> items_;
};

}  // namespace hooke::base
