#pragma once

#include "hooke/result.h"

#include "io/json/json_node.h"

#include <string>
#include <string_view>
#include <vector>

namespace hooke::io {

/// These bound the source [bytes], the nesting and the number of values of a document that is read.
inline constexpr std::size_t kLargestJson = std::size_t{64} << 20U;
inline constexpr std::size_t kDeepestJson = 64;
inline constexpr std::size_t kMostJsonValues = 2'000'000;
/// This bounds line ends and tabs. The parser spells out those before a mistake one by one, which takes time.
inline constexpr std::size_t kMostJsonBreaks = 8'000'000;
/// At most this many errors of one file are reported.
inline constexpr std::size_t kMostErrors = 100;

/// A JsonDocument is a parsed file: its tree, and what is needed to tell where in the file something stands.
struct JsonDocument {
  std::string name = {};  ///< Name of the file, for messages.
  std::string source = {};
  std::vector<std::uint32_t> line_starts = {};  ///< Offset of the first byte of each line.
  JsonNode root = {};

  /// Returns "name:line:column" of a byte of the source; both count from 1, columns in characters.
  [[nodiscard]] std::string place(std::uint32_t offset) const;
  /// Returns the number at a node as the user wrote it.
  [[nodiscard]] std::string number_text(const JsonNode& node) const;
  /// Returns the node at a path such as "ropes[0].masses", or the closest one above it. Never null.
  [[nodiscard]] const JsonNode& find_closest(std::string_view path) const;
};

/// Returns the child of a node that the first step of a path names, or null, and removes the step from the
/// path. A step is a key or an index in brackets.
[[nodiscard]] const JsonNode* step_down(const JsonNode& node, std::string_view& path);

/// A JsonError is an error at an offset, which callers sort by before they format a message.
struct JsonError {
  std::uint32_t offset = 0;
  Error error = {};
};

/// Reads JSON with comments and an optional byte order mark. After a syntax error the tree is what was read
/// up to there. Errors tell of syntax, nesting, size and repeated keys.
[[nodiscard]] std::vector<JsonError> parse_json(std::string source, std::string name, JsonDocument& document);

}  // namespace hooke::io
