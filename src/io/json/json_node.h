#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hooke::io {

/// A JsonNode is one JSON value with its place in the file. The same tree is read, written and printed.
struct JsonNode {
  enum class Kind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };

  Kind kind = Kind::kNull;
  bool boolean = false;
  std::uint32_t offset = 0;             ///< Offset of the value's first byte in the source.
  std::uint32_t key_offset = 0;         ///< Offset of the key's first byte, when the parent is an object.
  double number = 0.0;                  ///< Always finite.
  std::string text = {};                ///< Content of a string; digits of a number to be printed.
  std::string key = {};                 ///< Set when the parent is an object.
  std::vector<JsonNode> children = {};  ///< In the order of the file.

  /// Returns the child of an object with this key, or null.
  [[nodiscard]] const JsonNode* find(std::string_view wanted) const;
  [[nodiscard]] JsonNode* find(std::string_view wanted);
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
/// Makes a number with digits that read back to the same bits. What is not finite becomes 0.
[[nodiscard]] JsonNode make_number(double value);
[[nodiscard]] JsonNode make_number(float value);

/// Returns words for messages, such as "an object" or "a number".
[[nodiscard]] const char* name_of(JsonNode::Kind kind);

/// Returns readable text: two spaces per level, and what fits on a line stays on a line. It ends with a line
/// feed. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string to_text(const JsonNode& root);

/// Returns the text on one line of any length, without a line feed.
[[nodiscard]] std::string to_flat_text(const JsonNode& root);

/// Returns user text for a message of one line: in single quotes, at most 40 bytes, no control characters.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Returns the Levenshtein distance, or 3 if it is larger than 2.
[[nodiscard]] int edit_distance_up_to_2(std::string_view a, std::string_view b);

}  // namespace hooke::io
