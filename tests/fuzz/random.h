#pragma once

#include "hooke/math.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <vector>

namespace hooke::fuzz {

/// splitmix64: the same numbers on every machine, whatever the standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : seed_(seed), state_(seed) {}

  [[nodiscard]] std::uint64_t seed() const { return seed_; }

  std::uint64_t bits() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t word = state_;
    word = (word ^ (word >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    word = (word ^ (word >> 27U)) * 0x94D049BB133111EBULL;
    return word ^ (word >> 31U);
  }
  /// In [0, count); 0 where count is 0.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(bits() % count); }
  std::uint32_t index(std::size_t count) { return static_cast<std::uint32_t>(below(count)); }
  int integer(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::size_t>(high - low + 1)));
  }
  bool chance(double probability) { return unit() < probability; }
  double unit() { return static_cast<double>(bits() >> 11U) / 9007199254740992.0; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  Real real(double low, double high) { return static_cast<Real>(between(low, high)); }
  Vec3 vector(double reach) { return {real(-reach, reach), real(-reach, reach), real(-reach, reach)}; }
  DVec3 place(double reach) { return vector_cast<double>(vector(reach)); }
  /// Not uniform, which does not matter here.
  Quat turn() {
    if (chance(0.3)) return {};
    return normalize(Quat{real(-1, 1), real(-1, 1), real(-1, 1), real(-1, 1)});
  }
  template <class T>
  T pick(std::initializer_list<T> choices) {
    return choices.begin()[below(choices.size())];
  }
  template <class T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }

 private:
  std::uint64_t seed_;
  std::uint64_t state_;
};

/// Numbers that programs go wrong on.
inline double bad_number(Random& random) {
  using Limits = std::numeric_limits<double>;
  using Small = std::numeric_limits<float>;
  return random.pick<double>({0.0,
                              -0.0,
                              1.0,
                              -1.0,
                              1e-30,
                              -1e-30,
                              1e-6,
                              1e6,
                              1e9,
                              -1e9,
                              1e18,
                              1e30,
                              -1e30,
                              1e300,
                              Limits::infinity(),
                              -Limits::infinity(),
                              Limits::quiet_NaN(),
                              Small::max(),
                              Small::lowest(),
                              Small::min(),
                              Small::denorm_min(),
                              Limits::denorm_min(),
                              2147483648.0,
                              4294967295.0,
                              9007199254740993.0,
                              0.5,
                              63.0,
                              64.0,
                              65.0});
}

}  // namespace hooke::fuzz
