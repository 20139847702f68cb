#include "text_encoding.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <span>

namespace hooke::importer {

namespace {

constexpr std::uint32_t kReplacement = 0xFFFD;

template <std::size_t N>
bool starts_with(std::span<const std::byte> bytes, const std::array<std::uint8_t, N>& mark) {
  return bytes.size() >= N &&
         std::equal(mark.begin(), mark.end(), bytes.begin(),
                    [](std::uint8_t a, std::byte b) { return a == std::to_integer<std::uint8_t>(b); });
}

void put(std::uint32_t code, std::vector<std::byte>& bytes) {
  const auto put_byte = [&](std::uint32_t byte) { bytes.push_back(static_cast<std::byte>(byte)); };
  if (code < 0x80) return put_byte(code);
  // The first byte says how many others follow with six bits each.
  const int others = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  put_byte((0xF00U >> others & 0xFFU) | code >> (6 * others));
  for (int i = others - 1; i >= 0; --i) put_byte(0x80U | (code >> (6 * i) & 0x3FU));
}

std::vector<std::byte> from_utf16(std::span<const std::byte> bytes, bool big_end_first) {
  const std::size_t count = bytes.size() / 2;
  const auto unit_at = [&](std::size_t i) {
    const auto first = std::to_integer<std::uint32_t>(bytes[2 * i]);
    const auto second = std::to_integer<std::uint32_t>(bytes[2 * i + 1]);
    return big_end_first ? first << 8U | second : second << 8U | first;
  };
  const auto is_half = [&](std::size_t i, std::uint32_t from) {
    return i < count && unit_at(i) >= from && unit_at(i) < from + 0x400;
  };
  std::vector<std::byte> text;
  text.reserve(count);
  for (std::size_t i = 1; i < count; ++i) {  // behind the mark
    if (is_half(i, 0xD800) && is_half(i + 1, 0xDC00)) {
      put(0x10000 + ((unit_at(i) - 0xD800) << 10U) + (unit_at(i + 1) - 0xDC00), text);
      ++i;
    } else {
      put(is_half(i, 0xD800) || is_half(i, 0xDC00) ? kReplacement : unit_at(i), text);
    }
  }
  return text;
}

}  // namespace

bool is_text(std::string_view extension) {
  const auto is = [&](std::string_view other) {
    return std::equal(extension.begin(), extension.end(), other.begin(), other.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
  };
  return is(".obj") || is(".mtl") || is(".gltf");
}

std::vector<std::byte> to_utf8(std::vector<std::byte> bytes) {
  constexpr std::array<std::uint8_t, 3> kUtf8 = {0xEF, 0xBB, 0xBF};
  constexpr std::array<std::uint8_t, 2> kLittle = {0xFF, 0xFE};
  constexpr std::array<std::uint8_t, 2> kBig = {0xFE, 0xFF};
  if (starts_with(bytes, kUtf8)) bytes.erase(bytes.begin(), bytes.begin() + kUtf8.size());
  if (starts_with(bytes, kLittle)) return from_utf16(bytes, false);
  if (starts_with(bytes, kBig)) return from_utf16(bytes, true);
  return bytes;
}

}  // namespace hooke::importer
