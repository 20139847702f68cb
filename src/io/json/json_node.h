#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hooke::io {

/// One JSON value with the place where it stands in its file. The same tree is read, written and printed.
struct JsonNode {
  enum class Kind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };

  Kind kind = Kind::kNull;
  bool boolean = false;
  std::uint32_t offset = 0;             ///< Of the value's first byte in the source.
  std::uint32_t key_offset = 0;         ///< Of the key's first byte, when the parent is an object.
  double number = 0.0;                  ///< Finite.
  std::string text = {};                ///< A string's content; of a number to be printed, its digits.
  std::string key = {};                 ///< When the parent is an object.
  std::vector<JsonNode> children = {};  ///< In the order of the file.

  /// The child of an object with this key; null if there is none.
  [[nodiscard]] const JsonNode* find(std::string_view wanted) const;
  /// Appends a child with a key and returns it.
  JsonNode& add(std::string_view new_key, JsonNode value);
  /// Appends an element and returns it.
  JsonNode& add(JsonNode value);
};

[[nodiscard]] JsonNode make_object();
[[nodiscard]] JsonNode make_array();
[[nodiscard]] JsonNode make_string(std::string_view text);
[[nodiscard]] JsonNode make_boolean(bool value);
[[nodiscard]] JsonNode make_integer(std::int64_t value);
/// Digits that read back to the same bits. What is not finite becomes 0.
[[nodiscard]] JsonNode make_number(double value);
[[nodiscard]] JsonNode make_number(float value);

/// "an object", "a number": for messages.
[[nodiscard]] const char* name_of(JsonNode::Kind kind);

/// Readable text: two spaces per level, what fits on a line stays on a line. Ends with a line feed. Bytes
/// that are not UTF-8 are replaced.
[[nodiscard]] std::string to_text(const JsonNode& root);

/// The same on one line of any length, without a line feed.
[[nodiscard]] std::string to_flat_text(const JsonNode& root);

/// User text for a message of one line: in single quotes, at most 40 bytes, no control characters.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Levenshtein distance, or 3 if it is larger than 2.
[[nodiscard]] int edit_distance_up_to_2(std::string_view a, std::string_view b);

}  // namespace hooke::io
