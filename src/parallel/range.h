#pragma once

namespace hooke::parallel {

/// This is the half-open range of rows [begin, end).
struct Range {
  int begin = 0;
  int end = 0;

  [[nodiscard]] constexpr int count() const { return end - begin; }
};

}  // namespace hooke::parallel
