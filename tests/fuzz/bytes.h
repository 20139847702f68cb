#pragma once

#include "fuzz/random.h"

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace hooke::fuzz {

template <class T>
void patch(std::vector<std::byte>& bytes, std::size_t at, T value) {
  if (at + sizeof(value) <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof(value));
}

inline std::uint32_t bad_count(Random& random) {
  return random.pick<std::uint32_t>({0, 1, 2, 3, 5, 7, 255, 65535, 65536, 1U << 24, (1U << 24) + 1,
                                     0x7FFFFFFF, 0x80000000, 0xFFFFFFFC, 0xFFFFFFFE, 0xFFFFFFFF});
}

/// One change of bytes that are mostly aligned words of four or eight.
inline void change_bytes(Random& random, std::vector<std::byte>& bytes) {
  if (bytes.empty()) return;
  const std::size_t word = random.below(random.chance(0.3) ? 12 : bytes.size() / 4 + 1) * 4;
  switch (random.below(9)) {
    case 0:
      bytes[random.below(bytes.size())] = static_cast<std::byte>(random.bits());
      break;
    case 1:
      patch(bytes, word, bad_count(random));
      break;
    case 2:
      patch(bytes, word, static_cast<float>(bad_number(random)));
      break;
    case 3:
      patch(bytes, word, bad_number(random));
      break;
    case 4:
      patch(bytes, word, static_cast<std::uint32_t>(random.below(64)));
      break;
    case 5:
      bytes.resize(random.below(bytes.size() + 1));
      break;
    case 6:
      bytes.resize(bytes.size() + random.below(64), static_cast<std::byte>(random.bits()));
      break;
    case 7: {  // a piece moves elsewhere
      const std::size_t size = std::min<std::size_t>(4 * (1 + random.below(16)), bytes.size());
      const std::vector<std::byte> piece(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      const std::size_t to = std::min(word, bytes.size() - size);
      std::memcpy(bytes.data() + to, piece.data(), size);
      break;
    }
    default: {
      const std::size_t at = random.below(bytes.size());
      bytes[at] ^= static_cast<std::byte>(1U << random.below(8));
    }
  }
}

}  // namespace hooke::fuzz
