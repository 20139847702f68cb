#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

/// \file
/// Makes names of objects fit for a format, and different from each other.

namespace hooke::io {

/// What a name may consist of.
enum class NameStyle : std::uint8_t {
  kText,        ///< Any characters but control characters.
  kIdentifier,  ///< Letters, digits and underscores, not a digit at first: names of prims in USD.
  kFile,        ///< Letters, digits, "-._[]", at most 64 bytes, different in lower case too: names of files.
};

/// A NameBook gives each name once.
class NameBook {
 public:
  explicit NameBook(NameStyle style) : style_(style) {}

  /// Returns the name, changed as far as the style and the names given before demand. An empty one becomes
  /// `usual`.
  std::string take(std::string_view wanted, std::string_view usual);

 private:
  [[nodiscard]] std::string fitting(std::string_view wanted) const;

  NameStyle style_;
  std::unordered_set<std::string> taken_;
};

}  // namespace hooke::io
