#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace hooke::base {

/// This is a 64-bit hash of the bytes fed to it, the same on every little-endian machine; it is not
/// cryptographic. Each round takes eight bytes: xor, multiply, then xor with the high half shifted down
/// (after the mixing step of splitmix64, Steele et al. 2014).
class StateHash {
 public:
  void add_word(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x9E3779B97F4A7C15ULL;
    state_ ^= state_ >> 32;
  }

  /// `T` must have no padding bytes.
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_bytes(&value, sizeof(T));
  }

  /// Adds the length of the column, then every element.
  template <class T>
  void add(const std::vector<T>& column) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_word(column.size());
    add_bytes(column.data(), column.size() * sizeof(T));
  }

  [[nodiscard]] std::uint64_t value() const { return state_ ^ (state_ >> 29); }

 private:
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (; size >= sizeof(std::uint64_t); bytes += sizeof(std::uint64_t), size -= sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, sizeof(word));
      add_word(word);
    }
    if (size > 0) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, size);
      add_word(word);
    }
  }

  std::uint64_t state_ = 0x243F6A8885A308D3ULL;
};

}  // namespace hooke::base
