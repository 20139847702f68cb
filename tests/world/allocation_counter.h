#pragma once

#include <cstdint>

namespace hooke::test {

/// Counts the calls of operator new, in any of its forms and on any thread, while it lives. One at a time. A
/// program that uses it has operators new of its own (allocation_counter.cpp).
class AllocationCounter {
 public:
  /// The call after the first `most` fails, and only that one.
  explicit AllocationCounter(std::uint64_t most = ~std::uint64_t{0});
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  [[nodiscard]] std::uint64_t count() const;
};

}  // namespace hooke::test
