#pragma once

#include <cstdint>

namespace hooke::base {

inline constexpr std::uint64_t kSplitmixStep = 0x9E3779B97F4A7C15ULL;

/// The output step of splitmix64 (Steele et al. 2014): spreads a word over all bits, the same on every
/// machine. Of words that are kSplitmixStep apart it makes random numbers.
constexpr std::uint64_t splitmix(std::uint64_t word) {
  word = (word ^ (word >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  word = (word ^ (word >> 27U)) * 0x94D049BB133111EBULL;
  return word ^ (word >> 31U);
}

/// A number uniform in [0, 1) of the upper 53 bits, which are exact in a double.
constexpr double unit_number(std::uint64_t word) {
  return static_cast<double>(word >> 11U) * (1.0 / 9007199254740992.0);  // 2^-53
}

}  // namespace hooke::base
