#pragma once

#include <vector>

namespace hooke::base {

/// Exchanges the list of this step with that of the step before. Both then have room for the longer one, so
/// that neither allocates again at a length that was reached before.
template <class T>
void take_turns(std::vector<T>& now, std::vector<T>& before) {
  before.reserve(now.capacity());
  now.swap(before);
}

}  // namespace hooke::base
