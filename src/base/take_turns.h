#pragma once

#include <vector>

namespace hooke::base {

/// Exchanges a list with the one that it was before. Both then have room for the longer one: where two take
/// turns, neither allocates at a length that was reached before.
template <class T>
void take_turns(std::vector<T>& now, std::vector<T>& before) {
  before.reserve(now.capacity());
  now.swap(before);
}

}  // namespace hooke::base
