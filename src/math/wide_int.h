#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// \file
/// Integers that are wide enough for exact signs of determinants.

namespace hooke::math {

__extension__ typedef __int128 Int128;  // NOLINT(modernize-use-using): only a typedef takes the prefix
__extension__ typedef unsigned __int128 UInt128;  // NOLINT(modernize-use-using)

/// This is a signed integer of 448 bits in two's complement. Sums and products wrap beyond that; callers must
/// bound the bits of their numbers.
class WideInt {
 public:
  static constexpr std::size_t kWords = 7;

  constexpr WideInt() = default;
  constexpr WideInt(Int128 value) {  // NOLINT(google-explicit-constructor): as among the built-in integers
    const auto bits = static_cast<UInt128>(value);
    words_[0] = static_cast<std::uint64_t>(bits);
    words_[1] = static_cast<std::uint64_t>(bits >> 64);
    for (std::size_t i = 2; i < kWords; ++i) words_[i] = value < 0 ? ~std::uint64_t{0} : 0;
  }

  friend constexpr bool operator==(const WideInt&, const WideInt&) = default;

  friend constexpr WideInt operator+(const WideInt& a, const WideInt& b) {
    WideInt sum;
    UInt128 carry = 0;
    for (std::size_t i = 0; i < kWords; ++i) {
      carry += UInt128{a.words_[i]} + b.words_[i];
      sum.words_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return sum;
  }
  friend constexpr WideInt operator-(const WideInt& a) {
    WideInt negated;
    UInt128 carry = 1;
    for (std::size_t i = 0; i < kWords; ++i) {
      carry += static_cast<std::uint64_t>(~a.words_[i]);
      negated.words_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return negated;
  }
  friend constexpr WideInt operator-(const WideInt& a, const WideInt& b) { return a + -b; }

  friend constexpr WideInt operator*(const WideInt& a, const WideInt& b) {
    // The high words of nonnegative numbers are zero and need no products.
    if (a.is_negative()) return -(-a * b);
    if (b.is_negative()) return -(a * -b);
    WideInt product;
    const std::size_t words_b = b.used_words();
    for (std::size_t i = 0, words_a = a.used_words(); i < words_a; ++i) {
      UInt128 carry = 0;
      for (std::size_t j = 0; i + j < kWords && (j < words_b || carry != 0); ++j) {
        carry += UInt128{a.words_[i]} * b.words_[j] + product.words_[i + j];
        product.words_[i + j] = static_cast<std::uint64_t>(carry);
        carry >>= 64;
      }
    }
    return product;
  }

  /// Returns -1, 0 or 1.
  [[nodiscard]] constexpr int sign() const {
    if (is_negative()) return -1;
    return *this == WideInt{} ? 0 : 1;
  }

  /// Returns a double within two units in the last place of the value.
  [[nodiscard]] constexpr double approximate() const {
    if (is_negative()) return -(-*this).approximate();
    // The highest nonzero word and the two below it hold at least 129 significant bits.
    std::size_t top = kWords - 1;
    while (top > 2 && words_[top] == 0) --top;
    double value = 0;
    for (std::size_t i = top + 1; i-- > top - 2;) value = value * kWordSize + static_cast<double>(words_[i]);
    for (std::size_t i = 2; i < top; ++i) value *= kWordSize;
    return value;
  }

 private:
  [[nodiscard]] constexpr bool is_negative() const { return (words_[kWords - 1] >> 63) != 0; }
  [[nodiscard]] constexpr std::size_t used_words() const {
    std::size_t count = kWords;
    while (count > 0 && words_[count - 1] == 0) --count;
    return count;
  }

  static constexpr double kWordSize = 18446744073709551616.0;

  std::array<std::uint64_t, kWords> words_ = {};  // Lowest first.
};

}  // namespace hooke::math
